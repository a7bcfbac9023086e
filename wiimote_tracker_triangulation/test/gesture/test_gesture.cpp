#include "gesture/examples_file.h"
#include "gesture/recognizer.h"
#include "gesture/segmenter.h"
#include "gesture/spotter.h"
#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/gesture/shape.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <random>

namespace wiimote_tracker::gesture {
namespace {

using Curve = std::function<Eigen::Vector3d(double)>;  // of a share of the way [0..1]

Eigen::Vector3d circle(double s) {
  return {0.2 * std::cos(2 * M_PI * s), 0.0, 0.2 * std::sin(2 * M_PI * s)};
}

Eigen::Vector3d zigzag(double s) {
  const double t = 4.0 * s;
  const double up = std::fmod(t, 2.0) < 1.0 ? std::fmod(t, 1.0) : 1.0 - std::fmod(t, 1.0);
  return {0.1 * t, 0.02 * t, 0.3 * up};
}

Eigen::Vector3d hook(double s) {
  return s < 0.7 ? Eigen::Vector3d(0.0, 0.4 * s, 0.0)
                 : Eigen::Vector3d(0.4 * (s - 0.7), 0.28, 0.3 * (s - 0.7));
}

struct Drawing {
  double start = 0.0;
  double duration = 1.5;
  double rate = 100.0;
  double scale = 1.0;
  double heading = 0.0;                             // about z [rad]
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  // [m]
  std::function<double(double)> pace = [](double s) { return s; };
};

Path draw(const Curve& curve, const Drawing& drawing) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(drawing.heading, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const int steps = static_cast<int>(std::lround(drawing.duration * drawing.rate));
  Path path;
  for (int i = 0; i <= steps; ++i) {
    const double s = static_cast<double>(i) / steps;
    path.push_back({drawing.start + s * drawing.duration,
                    drawing.place + drawing.scale * (turn * curve(drawing.pace(s)))});
  }
  return path;
}

Shape shapeOfDrawing(const Curve& curve, const Drawing& drawing) {
  return shapeOf(draw(curve, drawing), ShapeOptions()).value();
}

/// Time warping over the full cost table.
double distanceByTable(const Shape& a, const Shape& b) {
  constexpr int n = Shape::kPoints;
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

Recognizer threeGestures(const RecognizerOptions& options = {}) {
  Recognizer recognizer(options);
  recognizer.add({"circle", "", draw(circle, {})});
  recognizer.add({"zigzag", "", draw(zigzag, {})});
  recognizer.add({"hook", "", draw(hook, {})});
  return recognizer;
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
  EXPECT_FALSE(shapeOf({}, options));
  Path path = draw(circle, {});
  EXPECT_FALSE(shapeOf(Path(path.begin(), path.begin() + 4), options));
  EXPECT_FALSE(shapeOf(Path(50, PathPoint{0.0, {1.0, 2.0, 3.0}}), options)) << "equal times";
  Path still;
  for (int i = 0; i < 50; ++i)
    still.push_back({0.01 * i, {1.0, 2.0, 3.0}});
  EXPECT_FALSE(shapeOf(still, options));
  ShapeOptions any_length = options;
  any_length.minimum_length = 0.0;
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

std::vector<Path> feed(Segmenter* segmenter, const Path& path) {
  std::vector<Path> found;
  for (const PathPoint& point : path) {
    if (auto gesture = segmenter->add(point))
      found.push_back(*gesture);
  }
  return found;
}

Path stay(double from, double to, const Eigen::Vector3d& place) {
  Path path;
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  for (double t = from; t < to; t += 0.01)
    path.push_back(
        {t, place + 0.002 * Eigen::Vector3d(normal(random), normal(random), normal(random))});
  return path;
}

TEST(Segmenter, CutsAtRests) {
  Segmenter segmenter{SegmenterOptions()};
  EXPECT_TRUE(feed(&segmenter, stay(0.0, 1.0, circle(0.0))).empty());
  Drawing first;
  first.start = 1.0;
  EXPECT_TRUE(feed(&segmenter, draw(circle, first)).empty());
  const auto found = feed(&segmenter, stay(2.51, 3.2, circle(1.0)));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].front().time, 1.0, 0.3);
  EXPECT_NEAR(found[0].back().time, 2.5, 0.1);
  Drawing second;
  second.start = 3.2;
  second.place = circle(1.0) - zigzag(0.0);
  EXPECT_TRUE(feed(&segmenter, draw(zigzag, second)).empty());
  const auto next = feed(&segmenter, stay(4.71, 5.4, second.place + zigzag(1.0)));
  ASSERT_EQ(next.size(), 1u);
  EXPECT_EQ(threeGestures().recognize(next[0])->gesture, "zigzag");
  EXPECT_TRUE(threeGestures().recognize(next[0])->accepted());
}

TEST(Segmenter, CutsWhereTheLightGoesOut) {
  SegmenterOptions options;
  options.boundary = Boundary::kLight;
  Segmenter segmenter(options);
  const Path path = draw(circle, {});
  EXPECT_TRUE(feed(&segmenter, path).empty());
  EXPECT_FALSE(segmenter.advance(1.6));
  const auto found = segmenter.advance(1.7);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->size(), path.size());
  EXPECT_FALSE(segmenter.advance(2.0));
  // Without advance(), the gap before the next point shows that the light was out.
  Drawing later;
  later.start = 10.0;
  EXPECT_TRUE(feed(&segmenter, draw(circle, later)).empty());
  later.start = 20.0;
  EXPECT_EQ(feed(&segmenter, draw(zigzag, later)).size(), 1u);
}

TEST(Segmenter, CutsAtTheButton) {
  SegmenterOptions options;
  options.boundary = Boundary::kButton;
  Segmenter segmenter(options);
  EXPECT_TRUE(feed(&segmenter, stay(-1.0, 0.0, circle(0.0))).empty());
  EXPECT_FALSE(segmenter.button(0.0, true));
  EXPECT_TRUE(feed(&segmenter, draw(circle, {})).empty());
  const auto found = segmenter.button(1.5, false);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->front().time, 0.0);
  EXPECT_EQ(found->back().time, 1.5);
  EXPECT_FALSE(segmenter.button(1.6, false));
}

TEST(Segmenter, ButtonEventsMayComeEarlyOrLate) {
  SegmenterOptions options;
  options.boundary = Boundary::kButton;
  Drawing drawing;
  drawing.duration = 3.0;
  const Path path = draw(circle, drawing);
  // Pressed from 0.995 s to 2.005 s; the button events arrive `delay` after the positions.
  for (const double delay : {-0.4, -0.1, 0.0, 0.1, 0.4}) {
    Segmenter segmenter(options);
    std::vector<Path> found;
    const auto take = [&](std::optional<Path> ended) {
      if (ended)
        found.push_back(*ended);
    };
    for (std::size_t i = 0; i < path.size(); ++i) {
      const auto at = [&](double time) {
        return i == static_cast<std::size_t>(std::lround(100.0 * (time + delay)));
      };
      if (at(1.0))
        take(segmenter.button(0.995, true));
      if (at(2.0))
        take(segmenter.button(2.005, false));
      take(segmenter.add(path[i]));
    }
    ASSERT_EQ(found.size(), 1u) << delay;
    EXPECT_EQ(found[0].front().time, path[100].time) << delay;
    EXPECT_EQ(found[0].back().time, path[200].time) << delay;
    EXPECT_EQ(found[0].size(), 101u) << delay;
  }
}

TEST(Segmenter, PredictedPointsAfterTheLightWentOutAreDropped) {
  SegmenterOptions options;
  options.boundary = Boundary::kLight;
  Segmenter segmenter(options);
  const Path path = draw(circle, {});
  for (const PathPoint& point : path)
    segmenter.add(point, std::min(point.time, 1.42));
  const auto found = segmenter.advance(1.7);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->back().time, path[142].time);
}

TEST(Segmenter, APathWithAGapIsNoGesture) {
  Segmenter segmenter{SegmenterOptions()};
  feed(&segmenter, stay(0.0, 1.0, circle(0.0)));
  Drawing drawing;
  drawing.start = 1.0;
  Path path = draw(circle, drawing);
  path.erase(path.begin() + 60, path.begin() + 90);
  EXPECT_TRUE(feed(&segmenter, path).empty());
  const auto found = feed(&segmenter, stay(2.51, 3.2, circle(1.0)));
  for (const Path& part : found)
    EXPECT_GE(part.front().time, path[60].time);
}

TEST(Segmenter, OldTimesAreIgnored) {
  Segmenter segmenter{SegmenterOptions()};
  feed(&segmenter, stay(5.0, 6.0, circle(0.0)));
  EXPECT_TRUE(feed(&segmenter, stay(1.0, 2.0, circle(0.5))).empty());
  segmenter.reset();
  feed(&segmenter, stay(1.0, 2.0, circle(0.0)));
  Drawing drawing;
  drawing.start = 2.0;
  feed(&segmenter, draw(circle, drawing));
  EXPECT_EQ(feed(&segmenter, stay(3.51, 4.0, circle(1.0))).size(), 1u);
}

TEST(Spotter, FindsAGestureInContinuousMotion) {
  const Recognizer recognizer = threeGestures();
  Spotter spotter{SpotterOptions()};
  // To and fro, then a zigzag, then to and fro again.
  const auto idle = [](double t) {
    return Eigen::Vector3d(0.15 * std::sin(3.0 * t), 0.1 * std::sin(4.1 * t), 0.0);
  };
  Path motion;
  for (double t = 0.0; t < 3.0; t += 0.01)
    motion.push_back({t, idle(t)});
  Drawing drawing;
  drawing.start = 3.0;
  drawing.duration = 1.6;
  drawing.place = idle(3.0) - zigzag(0.0);
  const Path gesture = draw(zigzag, drawing);
  motion.insert(motion.end(), gesture.begin(), gesture.end());
  const Eigen::Vector3d jump = gesture.back().position - idle(4.61);
  for (double t = 4.61; t < 9.0; t += 0.01)
    motion.push_back({t, jump + idle(t)});

  std::vector<Spotted> found;
  for (const PathPoint& point : motion) {
    if (auto spotted = spotter.add(point, recognizer)) {
      EXPECT_LT(point.time - spotted->path.back().time, 1.5);
      found.push_back(*spotted);
    }
  }
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].recognition.gesture, "zigzag");
  EXPECT_NEAR(found[0].path.front().time, 3.0, 0.3);
  EXPECT_NEAR(found[0].path.back().time, 4.6, 0.2);
}

TEST(Spotter, AStraightStrokeIsAGestureOnlyAfterARest) {
  const Curve swipe = [](double s) { return Eigen::Vector3d(0.4 * s, 0.0, 0.02 * s * (1.0 - s)); };
  Recognizer recognizer{RecognizerOptions()};
  recognizer.add({"swipe", "", draw(swipe, {})});
  // Up, then to the right.
  const auto reports = [&](double pause) {
    Spotter spotter{SpotterOptions()};
    int found = 0;
    const auto feed = [&](const Path& path) {
      for (const PathPoint& point : path)
        found += spotter.add(point, recognizer) ? 1 : 0;
    };
    Drawing drawing;
    drawing.duration = 1.0;
    feed(draw([](double s) { return Eigen::Vector3d(0.0, 0.0, 0.4 * s - 0.4); }, drawing));
    if (pause > 0.0)
      feed(stay(1.01, 1.0 + pause, Eigen::Vector3d::Zero()));
    drawing.start = 1.01 + pause;
    feed(draw(swipe, drawing));
    return found + (spotter.advance(10.0) ? 1 : 0);
  };
  EXPECT_EQ(reports(0.0), 0);
  EXPECT_EQ(reports(0.6), 1);
}

TEST(ExamplesFile, ComesBackBitForBit) {
  const std::string file = testing::TempDir() + "gestures.yaml";
  Drawing odd;
  odd.start = 1.7637e9;
  odd.scale = 1.0 / 3.0;
  const std::vector<Example> examples = {{"circle", "", draw(circle, odd)},
                                         {"a: \"b\"", "room 1", draw(zigzag, {})}};
  writeExamples(file, examples);
  const std::vector<Example> back = readExamples(file);
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
  const std::string file = testing::TempDir() + "damaged.yaml";
  const auto messageFor = [&](const std::string& content) {
    std::ofstream(file) << content;
    try {
      readExamples(file);
    } catch (const geometry::Error& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
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
  EXPECT_EQ(messageFor(head + "examples: []\n"), "accepted");
  std::remove(file.c_str());
  EXPECT_THROW(readExamples(file), geometry::Error);
}

}  // namespace
}  // namespace wiimote_tracker::gesture
