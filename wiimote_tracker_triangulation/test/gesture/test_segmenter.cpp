// Where gestures begin and end in the motion of an LED.
#include "gesture/drawings.h"
#include "gesture/recognizer.h"
#include "gesture/segmenter.h"
#include "gesture/spotter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace wiimote_tracker::gesture {
namespace {

using test::circle;
using test::Curve;
using test::draw;
using test::Drawing;
using test::threeGestures;
using test::zigzag;

std::vector<Path> feed(Segmenter* segmenter, const Path& path) {
  std::vector<Path> found;
  for (const PathPoint& point : path) {
    if (auto gesture = segmenter->add(point, point.time))
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
      take(segmenter.add(path[i], path[i].time));
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
  ASSERT_EQ(found.size(), 1u) << "what follows the gap";
  EXPECT_EQ(found[0].front().time, path[60].time);
}

TEST(Segmenter, OldTimesAreIgnored) {
  Segmenter segmenter{SegmenterOptions()};
  feed(&segmenter, stay(5.0, 6.0, circle(0.0)));
  EXPECT_TRUE(feed(&segmenter, stay(1.0, 2.0, circle(0.5))).empty());
  Drawing drawing;
  drawing.start = 6.0;
  const Path path = draw(circle, drawing);
  const auto middle = path.begin() + 75;
  feed(&segmenter, Path(path.begin(), middle));
  EXPECT_TRUE(feed(&segmenter, stay(1.0, 2.0, circle(0.5))).empty());
  feed(&segmenter, Path(middle, path.end()));
  const auto found = feed(&segmenter, stay(7.51, 8.0, circle(1.0)));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].front().time, 6.0, 0.3) << "not cut in the middle";
}

TEST(Segmenter, ShortOnesAreIgnoredAndLongOnesLoseTheirStart) {
  SegmenterOptions options;
  options.boundary = Boundary::kButton;
  options.maximum_duration = 2.0;
  Segmenter segmenter(options);
  Drawing drawing;
  drawing.duration = 4.0;
  const Path path = draw(circle, drawing);
  EXPECT_FALSE(segmenter.button(0.0, true));
  feed(&segmenter, Path(path.begin(), path.begin() + 11));
  EXPECT_FALSE(segmenter.button(0.1, false)) << "a click";
  EXPECT_FALSE(segmenter.button(0.1, true));
  feed(&segmenter, Path(path.begin() + 11, path.end()));
  const auto found = segmenter.button(4.0, false);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->front().time, 2.0, 0.011);
  EXPECT_EQ(found->back().time, 4.0);
}

Spotter::Recognize with(const Recognizer& recognizer) {
  return [recognizer](const Path& path) { return recognizer.recognize(path); };
}

TEST(Spotter, FindsAGestureInContinuousMotion) {
  const Spotter::Recognize recognize = with(threeGestures());
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
    if (auto spotted = spotter.add(point, recognize)) {
      EXPECT_LT(point.time - spotted->path.back().time, 1.5);
      found.push_back(*spotted);
    }
  }
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].recognition.gesture, "zigzag");
  EXPECT_NEAR(found[0].path.front().time, 3.0, 0.3);
  EXPECT_NEAR(found[0].path.back().time, 4.6, 0.2);
}

TEST(Spotter, AGestureIsNotLostToTheNextOne) {
  // The second one is drawn better, sooner than half of the first one's duration after it.
  const Spotter::Recognize recognize = [](const Path& path) {
    const auto score = [&](double begin, double end) {
      return 1.0 - std::abs(path.front().time - begin) - std::abs(path.back().time - end);
    };
    const double first = 0.9 * score(1.0, 3.0);
    const double second = score(3.1, 3.7);
    return first > second ? Recognition{"first", first, ""} : Recognition{"second", second, ""};
  };
  Spotter spotter{SpotterOptions()};
  std::vector<std::string> found;
  for (double t = 0.0; t < 5.0; t += 0.01) {
    const Eigen::Vector3d place(0.2 * std::cos(12.0 * t), 0.2 * std::sin(12.0 * t), 0.0);
    if (const auto spotted = spotter.add({t, place}, recognize))
      found.push_back(spotted->recognition.gesture);
  }
  EXPECT_EQ(found, (std::vector<std::string>{"first", "second"}));
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
        found += spotter.add(point, with(recognizer)) ? 1 : 0;
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

}  // namespace
}  // namespace wiimote_tracker::gesture
