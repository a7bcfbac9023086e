#include "gesture/drawings.h"
#include "gesture/examples_file.h"
#include "gesture/recognizer.h"
#include "refusal_of.h"
#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/gesture/shape.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <random>
#include <string>
#include <vector>

namespace wiimote_tracker::gesture {
namespace {

using test::circle;
using test::Curve;
using test::draw;
using test::Drawing;
using test::hook;
using test::threeGestures;
using test::zigzag;

Shape shapeOfDrawing(const Curve& curve, const Drawing& drawing) {
  return shapeOf(draw(curve, drawing), ShapeOptions()).value();
}

/// Time warping over the full cost table.
double distanceByTable(const Shape& a, const Shape& b) {
  const int n = Shape::kPoints;
  std::vector<std::vector<double>> table(n + 1, std::vector<double>(n + 1, INFINITY));
  table[0][0] = 0.0;
  for (int i = 1; i <= n; ++i) {
    for (int j = std::max(1, i - kBand); j <= std::min(n, i + kBand); ++j) {
      double cost = 0.0;
      for (int k = 0; k < 3; ++k) {
        cost += std::pow(a.positions(k, i - 1) - b.positions(k, j - 1), 2) +
                std::pow(a.directions(k, i - 1) - b.directions(k, j - 1), 2);
      }
      table[i][j] = cost + std::min({table[i - 1][j - 1], table[i - 1][j], table[i][j - 1]});
    }
  }
  return table[n][n] / n;
}

TEST(Shape, HasNoPlaceSizeOrSpeed) {
  const Shape plain = shapeOfDrawing(hook, {});
  Drawing other;
  other.start = 1.76e9;
  other.duration = 3.0;
  other.scale = 2.5;
  other.place = {3.0, -1.0, 2.0};
  other.pace = [](double s) { return s * s * (3.0 - 2.0 * s); };
  const Shape same = shapeOfDrawing(hook, other);
  EXPECT_LT((plain.positions - same.positions).norm() / std::sqrt(Shape::kPoints), 0.02);
  EXPECT_LT(distance(plain, same), 0.01);
  EXPECT_NEAR(plain.positions.squaredNorm() / Shape::kPoints, 1.0, 1e-12);
  EXPECT_LT(plain.positions.rowwise().mean().norm(), 1e-12);
}

TEST(Shape, PointsOfACircleAreEvenlySpread) {
  ShapeOptions unsmoothed;
  unsmoothed.smoothing = 1e-6;
  Drawing fine;
  fine.rate = 2000.0;
  const auto shape = shapeOf(draw(circle, fine), unsmoothed);
  ASSERT_TRUE(shape);
  for (int i = 0; i < Shape::kPoints; ++i) {
    const double angle = 2.0 * M_PI * i / (Shape::kPoints - 1);
    // The mean of the points is off the centre, since the first and the last coincide.
    const Eigen::Vector3d radius =
        shape->positions.col(i) -
        0.5 * (shape->positions.col(0) + (shape->positions.col(15) + shape->positions.col(16)) / 2);
    EXPECT_NEAR(std::remainder(std::atan2(radius.z(), radius.x()) - angle, 2.0 * M_PI), 0.0, 0.01);
  }
}

TEST(Shape, RefusesPathsThatAreNoGesture) {
  const ShapeOptions options;
  ShapeOptions any_length = options;
  any_length.minimum_length = 0.0;
  EXPECT_FALSE(shapeOf({}, options));
  Path path = draw(circle, {});
  EXPECT_TRUE(shapeOf(Path(path.begin(), path.begin() + 5), any_length));
  EXPECT_FALSE(shapeOf(Path(path.begin(), path.begin() + 4), any_length)) << "too few points";
  EXPECT_FALSE(shapeOf(Path(50, PathPoint{0.0, {1.0, 2.0, 3.0}}), options));
  Path repeated = path;
  repeated[8].time = repeated[7].time;
  EXPECT_FALSE(shapeOf(repeated, options)) << "equal times";
  Path still;
  for (int i = 0; i < 50; ++i)
    still.push_back({0.01 * i, {1.0, 2.0, 3.0}});
  EXPECT_FALSE(shapeOf(still, options));
  EXPECT_FALSE(shapeOf(still, any_length));
  path[7].position.x() = NAN;
  EXPECT_FALSE(shapeOf(path, options));
  Drawing small;
  small.scale = 0.05;
  EXPECT_FALSE(shapeOf(draw(circle, small), options));
}

TEST(Shape, StaysFiniteWhereAPathTurnsBack) {
  const auto shape = shapeOf(
      draw([](double s) { return Eigen::Vector3d(0.4 * (0.5 - std::abs(s - 0.5)), 0, 0); }, {}),
      ShapeOptions());
  ASSERT_TRUE(shape);
  EXPECT_TRUE(shape->positions.allFinite());
  EXPECT_TRUE(shape->directions.allFinite());
  // Back exactly at one of the shape's points, whose neighbours then coincide.
  Path straight;
  for (int i = 0; i < Shape::kPoints; ++i)
    straight.push_back({0.01 * i, {0.01 * (i <= 15 ? i : 30 - i), 0.0, 0.0}});
  ShapeOptions unsmoothed;
  unsmoothed.smoothing = 1e-6;
  const auto turned = shapeOf(straight, unsmoothed);
  ASSERT_TRUE(turned);
  EXPECT_LT(turned->directions.col(15).norm(), 1e-12) << "it has no direction there";
  EXPECT_NEAR(turned->directions(0, 14), 1.0, 1e-12);
  EXPECT_NEAR(turned->directions(0, 16), -1.0, 1e-12);
}

TEST(Distance, MatchesTheFullTable) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 200; ++trial) {
    Shape a;
    Shape b;
    for (int i = 0; i < Shape::kPoints; ++i) {
      for (int k = 0; k < 3; ++k) {
        a.positions(k, i) = normal(random);
        b.positions(k, i) = normal(random);
        a.directions(k, i) = normal(random);
        b.directions(k, i) = normal(random);
      }
    }
    const double expected = distanceByTable(a, b);
    EXPECT_NEAR(distance(a, b), expected, 1e-9 * expected);
    EXPECT_NEAR(distance(a, b, 1.001 * expected), expected, 1e-9 * expected);
    EXPECT_TRUE(std::isinf(distance(a, b, 0.999 * expected)));
    EXPECT_EQ(distance(a, a), 0.0);
  }
}

TEST(Distance, RotationFindsTheHeading) {
  Drawing turned;
  turned.heading = 2.1;
  const Shape plain = shapeOfDrawing(zigzag, {});
  const Shape other = shapeOfDrawing(zigzag, turned);
  EXPECT_GT(distance(plain, other), 0.5);
  EXPECT_LT(distance(plain, turnedTowards(other, plain)), 1e-12);
}

TEST(Recognizer, RecognisesGesturesWhereverTheyAreDrawn) {
  const Recognizer recognizer = threeGestures();
  const std::vector<std::pair<std::string, Curve>> gestures = {
      {"circle", circle}, {"zigzag", zigzag}, {"hook", hook}};
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (const auto& [name, curve] : gestures) {
    for (int trial = 0; trial < 30; ++trial) {
      Drawing drawing;
      drawing.duration = std::uniform_real_distribution<double>(0.6, 4.0)(random);
      drawing.scale = std::uniform_real_distribution<double>(0.8, 4.0)(random);
      drawing.heading = 0.15 * normal(random);
      drawing.place = Eigen::Vector3d(normal(random), normal(random), normal(random));
      Path path = draw(curve, drawing);
      for (PathPoint& point : path)
        point.position += 0.003 * Eigen::Vector3d(normal(random), normal(random), normal(random));
      const auto recognition = recognizer.recognize(path);
      ASSERT_TRUE(recognition);
      EXPECT_EQ(recognition->gesture, name);
      EXPECT_TRUE(recognition->accepted()) << name << " " << recognition->score;
      EXPECT_FALSE(recognition->runner_up.empty());
      EXPECT_NE(recognition->runner_up, name);
      EXPECT_LT(recognition->runner_up_score, recognition->score);
    }
  }
}

TEST(Recognizer, HeadingMattersUnlessAnyIsAllowed) {
  Drawing turned;
  turned.heading = -1.8;
  RecognizerOptions any_heading;
  any_heading.any_heading = true;
  EXPECT_FALSE(threeGestures().recognize(draw(zigzag, turned))->accepted());
  const auto found = threeGestures(any_heading).recognize(draw(zigzag, turned));
  EXPECT_EQ(found->gesture, "zigzag");
  EXPECT_GT(found->score, 0.99);
}

TEST(Recognizer, AMirroredOrReversedGestureIsAnother) {
  const Recognizer recognizer = threeGestures();
  const auto reversed = recognizer.recognize(draw([](double s) { return hook(1.0 - s); }, {}));
  EXPECT_FALSE(reversed->accepted());
  const auto mirrored = recognizer.recognize(draw(
      [](double s) { return Eigen::Vector3d(hook(s).cwiseProduct(Eigen::Vector3d(-1, -1, 1))); },
      {}));
  EXPECT_FALSE(mirrored->accepted());
}

TEST(Recognizer, RejectsOtherMotion) {
  const Recognizer recognizer = threeGestures();
  std::mt19937 random(9);
  std::normal_distribution<double> normal;
  int accepted = 0;
  for (int trial = 0; trial < 200; ++trial) {
    // A smooth random walk.
    Path path;
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    for (int i = 0; i < 150; ++i) {
      velocity +=
          0.15 * Eigen::Vector3d(normal(random), normal(random), normal(random)) - 0.05 * velocity;
      position += 0.01 * velocity;
      path.push_back({0.01 * i, position});
    }
    accepted += recognizer.recognize(path)->accepted() ? 1 : 0;
  }
  // A walk that goes nearly straight resembles the hook.
  EXPECT_LE(accepted, 10);
}

TEST(Recognizer, TheLimitGrowsWithTheSpreadOfTheExamples) {
  // A circle ever more drawn out upwards.
  const auto oval = [](double stretch) {
    return draw(
        [=](double s) {
          return Eigen::Vector3d(circle(s).cwiseProduct(Eigen::Vector3d(1, 1, stretch)));
        },
        {});
  };
  const auto between = [](const Path& a, const Path& b) {
    return distance(shapeOf(a, {}).value(), shapeOf(b, {}).value());
  };
  const double whole = RecognizerOptions().rejection_distance;
  const Path drawn = oval(2.0);
  const double to_circle = between(drawn, oval(1.0));
  const double to_oval = between(drawn, oval(1.5));
  const double spread = between(oval(1.0), oval(1.5));
  ASSERT_GT(spread, 0.01);
  ASSERT_LT(spread, 0.9 * whole);

  Recognizer recognizer({});
  const auto expectLimit = [&](double distance, double limit) {
    EXPECT_NEAR(recognizer.recognize(drawn)->score, std::exp2(-distance / limit), 1e-9);
  };
  recognizer.add({"o", "", oval(1.0)});
  expectLimit(to_circle, whole);
  recognizer.add({"o", "", oval(1.5)});
  expectLimit(0.5 * (to_circle + to_oval), 0.5 * whole + spread);
  recognizer.add({"o", "", oval(1.5)});
  expectLimit(to_oval, 0.5 * whole + spread / 3.0);  // each oval is the other's nearest
  recognizer.add({"o", "studio", oval(1.0)});        // it is known there only
  expectLimit(to_oval, 0.5 * whole + spread / 3.0);
}

TEST(Recognizer, AMistakeAmongTheExamplesWidensTheLimitLittle) {
  Recognizer recognizer({});
  recognizer.add({"circle", "", draw(circle, {})});
  recognizer.add({"circle", "", draw(zigzag, {})});
  const double whole = RecognizerOptions().rejection_distance;
  const Shape drawn = shapeOfDrawing(hook, {});
  const double distance_to_both = 0.5 * (distance(drawn, shapeOfDrawing(circle, {})) +
                                         distance(drawn, shapeOfDrawing(zigzag, {})));
  const auto recognition = recognizer.recognize(draw(hook, {}));
  EXPECT_FALSE(recognition->accepted());
  EXPECT_NEAR(recognition->score, std::exp2(-distance_to_both / (1.5 * whole)), 1e-9);
}

TEST(Recognizer, RecognisesNothingWithoutExamples) {
  EXPECT_FALSE(Recognizer({}).recognize(draw(circle, {})));
  Recognizer recognizer = threeGestures();
  EXPECT_FALSE(recognizer.recognize({}));
  EXPECT_THROW(recognizer.add({"", "", draw(circle, {})}), Error);
  EXPECT_THROW(recognizer.add({"dot", "", {}}), Error);
  EXPECT_EQ(recognizer.examples().size(), 3u);
}

TEST(Recognizer, RemovedGesturesAreForgotten) {
  Recognizer recognizer = threeGestures();
  recognizer.add({"circle", "", draw(circle, {})});
  EXPECT_EQ(recognizer.remove("circle"), 2u);
  EXPECT_EQ(recognizer.remove("circle"), 0u);
  EXPECT_NE(recognizer.recognize(draw(circle, {}))->gesture, "circle");
}

TEST(Recognizer, ZonesHaveTheirOwnGestures) {
  Recognizer recognizer({});
  recognizer.add({"lights", "kitchen", draw(circle, {})});
  recognizer.add({"music", "studio", draw(circle, {})});
  EXPECT_EQ(recognizer.recognize(draw(circle, {}), "kitchen")->gesture, "lights");
  EXPECT_EQ(recognizer.recognize(draw(circle, {}), "studio")->gesture, "music");
  EXPECT_FALSE(recognizer.recognize(draw(circle, {}), "hall"));
  recognizer.add({"help", "", draw(zigzag, {})});
  EXPECT_EQ(recognizer.recognize(draw(zigzag, {}), "hall")->gesture, "help");
}

TEST(Recognizer, OneOddExampleDoesLittleHarm) {
  Recognizer recognizer = threeGestures();
  recognizer.add({"zigzag", "", draw(zigzag, {})});
  recognizer.add({"circle", "", draw(circle, {})});
  recognizer.add({"circle", "", draw(zigzag, {})});  // a mistake of whoever recorded it
  EXPECT_EQ(recognizer.recognize(draw(zigzag, {}))->gesture, "zigzag");
}

std::string fileOfThisProcess() {
  return testing::TempDir() + "gestures_" + std::to_string(::getpid()) + ".yaml";
}

TEST(ExamplesFile, ComesBackBitForBit) {
  const std::string file = fileOfThisProcess();
  Drawing odd;
  odd.start = 1.7637e9;
  odd.scale = 1.0 / 3.0;
  const std::vector<Example> examples = {{"circle", "", draw(circle, odd)},
                                         {"a: \"b\"", "room 1", draw(zigzag, {})}};
  writeExamples(file, examples);
  const std::vector<Example> back = readExamples(file);
  std::remove(file.c_str());
  ASSERT_EQ(back.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(back[i].gesture, examples[i].gesture);
    EXPECT_EQ(back[i].zone, examples[i].zone);
    ASSERT_EQ(back[i].path.size(), examples[i].path.size());
    for (std::size_t k = 0; k < back[i].path.size(); ++k) {
      EXPECT_EQ(back[i].path[k].time, examples[i].path[k].time);
      EXPECT_EQ(back[i].path[k].position, examples[i].path[k].position);
    }
  }
}

TEST(ExamplesFile, DamagedOnesAreRefusedByName) {
  const std::string file = fileOfThisProcess();
  const auto messageFor = [&](const std::string& content) {
    std::ofstream(file) << content;
    return refusalOf([&] { readExamples(file); });
  };
  const auto contains = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  const std::string head = "format: wiimote_tracker_gestures\nversion: 1\n";
  EXPECT_TRUE(contains(messageFor("a: [1"), "not YAML"));
  EXPECT_TRUE(contains(messageFor("format: other\nversion: 1\nexamples: []\n"), "format"));
  EXPECT_TRUE(contains(messageFor("format: wiimote_tracker_gestures\nversion: 2\nexamples: []\n"),
                       "update"));
  EXPECT_TRUE(contains(messageFor(head), "examples is missing"));
  EXPECT_TRUE(contains(messageFor(head + "examples: []\nmore: 1\n"), "more is an unknown key"));
  EXPECT_TRUE(contains(messageFor(head + "examples: [{gesture: a, zone: '', path: [[1, 2]]}]\n"),
                       "t, x, y, z"));
  EXPECT_TRUE(contains(messageFor(head + "examples: [{gesture: a, zone: ''}]\n"),
                       "examples[0]/path is missing; restore the file from its backup or record"));
  EXPECT_EQ(messageFor(head + "examples: []\n"), "not refused");
  std::remove(file.c_str());
  EXPECT_THROW(readExamples(file), geometry::Error);
}

}  // namespace
}  // namespace wiimote_tracker::gesture
