#include "board_table.h"
#include "expect_says.h"
#include "intrinsics/board_decoder.h"
#include "intrinsics/board_sequence.h"

#include <wiimote_tracker_msgs/error.h>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <string>

namespace wiimote_tracker::intrinsics {
namespace {

/// A camera that looks at a board: where the LEDs are in its image, and what it gets wrong.
struct Scene {
  double turn = 0.0;      // of the board about the camera's axis [rad]
  double spacing = 60.0;  // of the LEDs [px]
  Eigen::Vector2d center{512.0, 384.0};
  Eigen::Vector2d speed = Eigen::Vector2d::Zero();  // of the board [px/s]
  double noise = 0.5;                               // before rounding [px]
  double loss = 0.05;                               // share of images that get lost
  double board_rate = 1.0;                          // of the board's clock
  double stamp_noise = 0.001;                       // [s]
  double period = 0.01;                             // of the camera [s]
  std::optional<Eigen::Vector2d> lamp;              // always lit
  double sway = 0.0;                                // of the lamp, as in a hand [px]

  Eigen::Vector2d place(int led, double time) const {
    const int column = led % 4, row = led / 4;
    const Eigen::Vector2d p(spacing * (column - 1.5), spacing * (row - 1.5));
    // Seen at a slant: rows converge.
    const Eigen::Vector2d slanted = p / (1.0 + 0.0008 * p.y());
    return center + speed * time + Eigen::Rotation2Dd(turn) * slanted;
  }

  static bool isInImage(const Eigen::Vector2d& p) {
    return p.x() >= 0.0 && p.x() <= 1023.0 && p.y() >= 0.0 && p.y() <= 767.0;
  }

  BoardReading read(unsigned seed, int minimum_leds = 8) const {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    BoardDecoder decoder(minimum_leds);
    const double phase = uniform(random) * 1e-3 * kCycleMs;
    for (double time = uniform(random) * period; time < 2.2; time += period) {
      if (uniform(random) < loss)
        continue;
      std::vector<Eigen::Vector2d> spots;
      if (lamp)
        spots.emplace_back(*lamp + sway * Eigen::Vector2d(std::sin(time + 10.0 * phase) +
                                                              0.4 * std::sin(1.7 * time),
                                                          0.6 * std::sin(1.3 * time)));
      for (const int led : litAt(board_rate * (time + phase))) {
        const Eigen::Vector2d p = place(led, time);
        const Eigen::Vector2d seen(std::round(p.x() + noise * normal(random)),
                                   std::round(p.y() + noise * normal(random)));
        if (isInImage(p) && spots.size() < 4)
          spots.push_back(seen);
      }
      std::shuffle(spots.begin(), spots.end(), random);
      decoder.add(100.0 + time + stamp_noise * normal(random), spots);
    }
    return decoder.read();
  }
};

/// Every LED that was read is where it is; returns how many.
int correctLeds(const Scene& scene, const BoardReading& reading) {
  if (!reading.view)
    return 0;
  int count = 0;
  for (int led = 0; led < kBoardLeds; ++led) {
    const auto& pixel = reading.view->pixels[static_cast<std::size_t>(led)];
    if (!pixel)
      continue;
    EXPECT_LT((*pixel - scene.place(led, 0.0)).norm(), 2.0) << "LED " << led;
    ++count;
  }
  return count;
}

TEST(BoardSequence, IsThatOfTheTable) {
  const int step = static_cast<int>(std::lround(1e3 * sequence::kStep));  // [ms]
  EXPECT_EQ(step * sequence::kSteps, kCycleMs);
  for (int led = 0; led < kBoardLeds; ++led) {
    std::vector<int> flashes;
    for (const TableLine& line : kTable) {
      if (std::count(line.leds.begin(), line.leds.end(), led) == 1)
        flashes.push_back(line.start);
    }
    EXPECT_EQ(flashes, (std::vector<int>{step * sequence::rowStep(led / kBoardColumns),
                                         step * sequence::columnStep(led % kBoardColumns)}))
        << "LED " << led;
  }
}

TEST(BoardSequence, EachTimeBetweenTwoFlashesOccursOnce) {
  std::set<int> delays;
  for (int led = 0; led < kBoardLeds; ++led) {
    std::vector<int> starts;
    for (const TableLine& line : kTable) {
      if (std::count(line.leds.begin(), line.leds.end(), led) > 0)
        starts.push_back(line.start);
    }
    ASSERT_EQ(starts.size(), 2u);
    EXPECT_TRUE(delays.insert(starts[1] - starts[0]).second);
    EXPECT_TRUE(delays.insert(kCycleMs - (starts[1] - starts[0])).second);
  }
}

TEST(BoardDecoder, ReadsTheBoardTurnedInAnyWay) {
  int found = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    Scene scene;
    scene.turn = 2.0 * M_PI * seed / 200.0;
    const BoardReading reading = scene.read(seed);
    ASSERT_TRUE(reading.view) << seed << ": " << reading.message;
    found += correctLeds(scene, reading);
  }
  // An LED is missed when of about four images of a flash three are lost.
  EXPECT_GT(found, 200 * 16 * 0.995);
}

TEST(BoardDecoder, ReadsTheLedsThatAreInTheImage) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    for (const Eigen::Vector2d& center :
         {Eigen::Vector2d(60.0, 384.0), Eigen::Vector2d(512.0, 740.0),
          Eigen::Vector2d(1000.0, 9.0)}) {
      Scene scene;
      scene.center = center;
      scene.turn = 0.1 * seed;
      int visible = 0;
      for (int led = 0; led < kBoardLeds; ++led)
        visible += Scene::isInImage(scene.place(led, 0.0)) ? 1 : 0;
      const BoardReading reading = scene.read(seed, 4);
      if (visible >= 5) {
        ASSERT_TRUE(reading.view) << reading.message;
        EXPECT_GE(correctLeds(scene, reading), visible - 3);
      }
    }
  }
}

TEST(BoardDecoder, ToleratesTheBoardsClockAndTheCamerasStamps) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    Scene scene;
    scene.board_rate = seed % 2 ? 1.003 : 0.997;
    scene.stamp_noise = 0.002;
    const BoardReading reading = scene.read(seed);
    ASSERT_TRUE(reading.view) << reading.message;
    EXPECT_GE(correctLeds(scene, reading), 14);
  }
}

TEST(BoardDecoder, LeavesOutALamp) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    Scene scene;
    scene.lamp = Eigen::Vector2d(100.0, 100.0);
    const BoardReading reading = scene.read(seed, 6);
    ASSERT_TRUE(reading.view) << reading.message;
    // The camera reports four lights, so that the lamp hides one LED of each row and column, and
    // so 7 of the 16; lost images cost a few more.
    EXPECT_GE(correctLeds(scene, reading), 6);
  }
}

/// Where it moves little, its spots look like those of an LED: in one place, in two flashes.
TEST(BoardDecoder, TakesALightThatMovesForAnLedHardlyEver) {
  int right = 0;
  int wrong = 0;
  for (unsigned seed = 0; seed < 600; ++seed) {
    Scene scene;
    scene.lamp = Eigen::Vector2d(512.0, 384.0);
    scene.sway = 20.0;
    const BoardReading reading = scene.read(seed, 6);
    for (int led = 0; led < kBoardLeds && reading.view; ++led) {
      const auto& pixel = reading.view->pixels[static_cast<std::size_t>(led)];
      if (pixel)
        ++((*pixel - scene.place(led, 0.0)).norm() < 2.0 ? right : wrong);
    }
  }
  EXPECT_GT(right, 0);
  EXPECT_LT(wrong, 0.005 * right) << right;  // of LED 12 the flashes follow one another
}

TEST(BoardDecoder, RefusesABoardThatMoves) {
  for (const double speed : {4.0, 10.0, 30.0, 100.0}) {
    for (unsigned seed = 0; seed < 20; ++seed) {
      Scene scene;
      scene.speed = {speed, 0.5 * speed};
      const BoardReading reading = scene.read(seed);
      EXPECT_FALSE(reading.view) << speed;
      EXPECT_SAYS(reading.message, "hold ");
    }
  }
}

TEST(BoardDecoder, DoesNotReadOtherLights) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform;
  for (int run = 0; run < 20; ++run) {
    BoardDecoder decoder;
    for (double time = 0.0; time < 2.5; time += 0.01) {
      std::vector<Eigen::Vector2d> spots;
      for (int i = 0; i < 4; ++i)
        spots.emplace_back(1023.0 * uniform(random), 767.0 * uniform(random));
      decoder.add(time, spots);
    }
    EXPECT_FALSE(decoder.read().view);
  }
}

TEST(BoardDecoder, SaysWhatItWaitsFor) {
  BoardDecoder decoder;
  EXPECT_SAYS(decoder.read().message, "no images");
  decoder.add(0.0, {});
  decoder.add(0.05, {});
  EXPECT_SAYS(decoder.read().message, "of 2.0 s");
  for (double time = 0.1; time < 3.0; time += 0.01)
    decoder.add(time, {});
  EXPECT_SAYS(decoder.read().message, "no light");
  for (double time = 3.0; time < 6.0; time += 0.01)
    decoder.add(time, {{5.0, 5.0}, {std::numeric_limits<double>::quiet_NaN(), 1.0}});
  EXPECT_SAYS(decoder.read().message, "do not blink");
  decoder.add(6.5, {});
  EXPECT_SAYS(decoder.read().message, "no image came");
  decoder.add(1.0, {});  // a recording that starts again
  EXPECT_SAYS(decoder.read().message, "of 2.0 s");

  Scene far;
  far.spacing = 9.0;
  EXPECT_SAYS(far.read(1).message, "nearer");
  Scene edge;
  edge.center = {0.0, 384.0};
  EXPECT_SAYS(edge.read(1, 12).message, "of 16 LEDs");
}

}  // namespace
}  // namespace wiimote_tracker::intrinsics
