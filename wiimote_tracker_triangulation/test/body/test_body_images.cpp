// The tracker of bodies takes their spots out of the images; the rest is for free LEDs.
#include "body/body_scene.h"
#include "body/body_tracker.h"
#include "wiimote_tracker_triangulation/tracking/tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace wiimote_tracker::body {
namespace {

std::ptrdiff_t countLost(const BodySnapshot& snapshot) {
  return std::count_if(snapshot.bodies.begin(), snapshot.bodies.end(),
                       [](const auto& body) { return body && body->lost; });
}

using Eigen::Isometry3d;
using Eigen::Vector3d;

tracking::CameraImage exactImage(const geometry::Camera& camera,
                                 const std::vector<Vector3d>& points,
                                 double time) {
  tracking::CameraImage image;
  image.stamp = time;
  image.arrival = time + 0.01;
  for (const Vector3d& point : points) {
    image.spots.emplace_back();
    image.spots.back().pixel = *camera.project(point);
  }
  return image;
}

TEST(BodyTracker, RemovesTheSpotsOfBodiesFromImages) {
  const geometry::Rig rig = tracking::test::paperRig();
  BodyTracker body_tracker((BodyTrackerOptions()));
  const Constellation three{"three", {{0.1, 0.0, 0.0}, {-0.08, 0.02, 0.0}, {0.0, 0.07, 0.05}}};
  body_tracker.setBodies({three});
  body_tracker.setRig(rig);
  const Vector3d free(1.6, 1.0, 0.8);
  const Isometry3d pose(Eigen::Translation3d(1.0, 1.4, 1.2));
  std::vector<Vector3d> points;
  for (const Vector3d& led : three.leds)
    points.push_back(pose * led);
  points.push_back(free);
  double last = 0.0;
  for (int i = 0; i < 200; ++i) {
    const std::size_t camera = static_cast<std::size_t>(i) % 4;
    tracking::CameraImage image =
        exactImage(rig.cameras[camera].camera, points, 1000.0 + 0.0025 * i);
    body_tracker.take(camera, {}, &image);
    const BodySnapshot* snapshot = body_tracker.next();
    ASSERT_TRUE(snapshot);
    EXPECT_GT(snapshot->time, last);
    last = snapshot->time;
    EXPECT_FALSE(body_tracker.next()) << "once only";
    if (i < 20)
      continue;
    ASSERT_TRUE(snapshot->bodies[0]);
    EXPECT_LT((snapshot->bodies[0]->world_from_body.translation() - pose.translation()).norm(),
              0.001);
    ASSERT_EQ(image.spots.size(), 1u);
    EXPECT_LT((image.spots[0].pixel - *rig.cameras[camera].camera.project(free)).norm(), 1e-9);
    EXPECT_EQ(image.maximum_spots, 1u) << "all places are still taken";
  }
  // Dark: it is predicted, lost once, and then gone.
  int lost = 0;
  for (int i = 0; i < 400; ++i) {
    tracking::CameraImage image = exactImage(rig.cameras[0].camera, {}, 1000.5 + 0.0025 * i);
    body_tracker.take(0, {}, &image);
    const BodySnapshot* snapshot = body_tracker.next();
    ASSERT_TRUE(snapshot);
    lost += static_cast<int>(countLost(*snapshot));
    if (snapshot->time > 1001.2) {
      EXPECT_FALSE(snapshot->bodies[0]);
    }
  }
  EXPECT_EQ(lost, 1);
  // Time jumps back, as a bag that starts over.
  for (int i = 0; i < 40; ++i) {
    const std::size_t camera = static_cast<std::size_t>(i) % 4;
    tracking::CameraImage image =
        exactImage(rig.cameras[camera].camera, points, 900.0 + 0.0025 * i);
    body_tracker.take(camera, {}, &image);
  }
  const BodySnapshot* snapshot = body_tracker.next();
  ASSERT_TRUE(snapshot);
  EXPECT_LT(snapshot->time, 901.0);
  EXPECT_TRUE(snapshot->bodies[0]);
}

/// Three LEDs at rest before the paper's cameras, one image each 2.5 ms.
class AtRest : public testing::Test {
 protected:
  AtRest() {
    for (const Vector3d& led : three_.leds)
      points_.push_back(Eigen::Translation3d(1.0, 1.4, 1.2) * led);
    body_tracker_.setBodies({three_});
  }

  /// @returns what is left of the last image.
  tracking::CameraImage show(int images) {
    tracking::CameraImage image;
    for (int i = 0; i < images; ++i, ++shown_) {
      const std::size_t camera = static_cast<std::size_t>(shown_) % 4;
      image = exactImage(rig_.cameras[camera].camera, points_, 1000.0 + 0.0025 * shown_);
      body_tracker_.take(camera, clock_error_, &image);
    }
    return image;
  }

  const Constellation three_{"three", {{0.1, 0.0, 0.0}, {-0.08, 0.02, 0.0}, {0.0, 0.07, 0.05}}};
  geometry::Rig rig_ = tracking::test::paperRig();
  BodyTracker body_tracker_{BodyTrackerOptions()};
  std::vector<Vector3d> points_;
  tracking::ClockError clock_error_;  // of all cameras
  int shown_ = 0;
};

TEST_F(AtRest, MaskedSpotsAreNoBodys) {
  geometry::RigCamera& camera = rig_.cameras[3];
  const Eigen::Vector2d lamp = *camera.camera.project(points_[1]);
  camera.masks.push_back({lamp, 1.0});
  body_tracker_.setRig(rig_);
  const tracking::CameraImage left = show(40);
  ASSERT_TRUE(body_tracker_.next()->bodies[0]);
  ASSERT_EQ(left.spots.size(), 1u);
  EXPECT_EQ(left.spots[0].pixel, lamp);
}

TEST_F(AtRest, IsFollowedOnInANewRig) {
  body_tracker_.setRig(rig_);
  show(40);
  const double first_seen = body_tracker_.next()->bodies[0]->first_seen;
  std::swap(rig_.cameras[0], rig_.cameras[3]);
  rig_.cameras[1].camera.world_from_camera.translate(Vector3d(0.002, 0.0, 0.0));
  body_tracker_.setRig(rig_);
  show(1);
  const BodySnapshot* snapshot = body_tracker_.next();
  ASSERT_TRUE(snapshot->bodies[0]);
  EXPECT_EQ(countLost(*snapshot), 0);
  EXPECT_TRUE(snapshot->bodies[0]->tracked);
  EXPECT_EQ(snapshot->bodies[0]->first_seen, first_seen);
}

TEST_F(AtRest, IsInTheWorldOfANewRigAtOnce) {
  body_tracker_.setRig(rig_);
  show(60);
  const Vector3d before = body_tracker_.next()->bodies[0]->world_from_body.translation();
  const Vector3d shift(1.0, 0.2, -0.3);
  for (geometry::RigCamera& camera : rig_.cameras)
    camera.camera.world_from_camera.pretranslate(shift);
  for (Vector3d& point : points_)
    point += shift;
  body_tracker_.setRig(rig_);
  show(1);
  const BodySnapshot* snapshot = body_tracker_.next();
  ASSERT_TRUE(snapshot->bodies[0]);
  EXPECT_TRUE(snapshot->bodies[0]->tracked);
  EXPECT_LT((snapshot->bodies[0]->world_from_body.translation() - before - shift).norm(), 0.001);
}

TEST_F(AtRest, IsFoundAnewWhenANewRigSetsTimeBack) {
  body_tracker_.setRig(rig_);
  show(60);
  for (geometry::RigCamera& camera : rig_.cameras) {
    camera.time_offset = -5.0;
    camera.time_offset_rule = geometry::TimeOffsetRule::kAlways;
  }
  body_tracker_.setRig(rig_);
  EXPECT_TRUE(show(40).spots.empty());
  const BodySnapshot* snapshot = body_tracker_.next();
  ASSERT_TRUE(snapshot) << "its time is before that of the last one";
  EXPECT_LT(snapshot->time, 996.0);
  EXPECT_TRUE(snapshot->bodies[0]);
}

TEST_F(AtRest, IsLostInANewRigWhileItIsHidden) {
  body_tracker_.setRig(rig_);
  show(60);
  points_.clear();
  show(100);
  ASSERT_TRUE(body_tracker_.next()->bodies[0]);
  body_tracker_.setRig(rig_);
  show(1);
  EXPECT_EQ(countLost(*body_tracker_.next()), 1);
}

TEST_F(AtRest, IsFollowedOnWhenTheSameBodiesAreSet) {
  body_tracker_.setRig(rig_);
  show(60);
  const double first_seen = body_tracker_.next()->bodies[0]->first_seen;
  EXPECT_EQ(countLost(body_tracker_.setBodies({three_})), 0);
  show(1);
  const BodySnapshot* snapshot = body_tracker_.next();
  ASSERT_TRUE(snapshot->bodies[0]);
  EXPECT_TRUE(snapshot->bodies[0]->tracked);
  EXPECT_EQ(snapshot->bodies[0]->first_seen, first_seen);
}

/// As when learn_body has learnt another one.
TEST_F(AtRest, IsFollowedOnWhenAnotherBodyComesFirstAndGoes) {
  body_tracker_.setRig(rig_);
  show(60);
  const double first_seen = body_tracker_.next()->bodies[0]->first_seen;
  const Constellation other{"other", {{0.0, 0.0, 0.0}, {0.3, 0.0, 0.0}, {0.0, 0.4, 0.1}}};
  using Bodies = std::vector<Constellation>;
  for (const Bodies& bodies : {Bodies{other, three_}, Bodies{three_}}) {
    body_tracker_.setBodies(bodies);
    for (int i = 0; i < 40; ++i) {
      EXPECT_TRUE(show(1).spots.empty()) << i;
      const BodySnapshot* snapshot = body_tracker_.next();
      ASSERT_EQ(snapshot->bodies.size(), bodies.size());
      EXPECT_EQ(countLost(*snapshot), 0);
      EXPECT_EQ(snapshot->bodies.front().has_value(), bodies.size() == 1);
      const std::optional<BodyEstimate>& three = snapshot->bodies.back();
      ASSERT_TRUE(three) << i;
      EXPECT_TRUE(three->tracked);
      EXPECT_EQ(three->first_seen, first_seen);
    }
  }
}

/// As when a late image comes just after learn_body: the steps before it are repeated.
TEST_F(AtRest, IsFollowedOnThroughALateImageAfterAnotherBodyCame) {
  body_tracker_.setRig(rig_);
  show(60);
  const double first_seen = body_tracker_.next()->bodies[0]->first_seen;
  body_tracker_.setBodies({{"other", {{0.0, 0.0, 0.0}, {0.3, 0.0, 0.0}, {0.0, 0.4, 0.1}}}, three_});
  tracking::CameraImage late = exactImage(rig_.cameras[1].camera, points_, 1000.1);
  body_tracker_.take(1, {}, &late);
  EXPECT_TRUE(late.spots.empty());
  show(1);
  const BodySnapshot* snapshot = body_tracker_.next();
  ASSERT_TRUE(snapshot->bodies[1]);
  EXPECT_TRUE(snapshot->bodies[1]->tracked);
  EXPECT_EQ(snapshot->bodies[1]->first_seen, first_seen);
}

/// As when its file was edited.
TEST_F(AtRest, IsSearchedAnewWhenItsLedsChange) {
  body_tracker_.setRig(rig_);
  show(60);
  const double first_seen = body_tracker_.next()->bodies[0]->first_seen;
  Constellation edited = three_;
  edited.leds[0].x() += 0.001;
  const BodySnapshot lost = body_tracker_.setBodies({edited});
  EXPECT_EQ(countLost(lost), 1);
  EXPECT_EQ(countLost(body_tracker_.setBodies({edited})), 0) << "it was told already";
  show(1);
  EXPECT_FALSE(body_tracker_.next()->bodies[0]);
  show(40);
  const BodySnapshot* snapshot = body_tracker_.next();
  ASSERT_TRUE(snapshot->bodies[0]);
  EXPECT_GT(snapshot->bodies[0]->first_seen, first_seen);
}

TEST_F(AtRest, StampsAreCorrectedByTheRigsOffsets) {
  for (geometry::RigCamera& camera : rig_.cameras) {
    camera.time_offset = 0.25;
    camera.time_offset_rule = geometry::TimeOffsetRule::kAlways;
  }
  body_tracker_.setRig(rig_);
  show(9);
  EXPECT_EQ(body_tracker_.next()->time, 1000.0 + 0.0025 * 8 + 0.25);
}

TEST_F(AtRest, TheErrorOfAClockIsTakenFromItsStamps) {
  body_tracker_.setRig(rig_);
  clock_error_.offset = 0.003;
  show(9);
  EXPECT_EQ(body_tracker_.next()->time, 1000.0 + 0.0025 * 8 - 0.003);
}

TEST_F(AtRest, EveryLedThatIsSeenHasAResidual) {
  body_tracker_.setRig(rig_);
  show(40);
  // The camera that saw an LED last misses it, or an image of another one comes without any.
  for (const std::size_t missed : {1, 3}) {
    std::vector<Vector3d> seen = points_;
    seen.resize(points_.size() - missed);
    for (int i = 0; i < 4; ++i, ++shown_) {
      const std::size_t camera = static_cast<std::size_t>(shown_ + 3) % 4;
      tracking::CameraImage image =
          exactImage(rig_.cameras[camera].camera, seen, 1000.0 + 0.0025 * shown_);
      body_tracker_.take(camera, {}, &image);
      const BodySnapshot* snapshot = body_tracker_.next();
      ASSERT_TRUE(snapshot);
      ASSERT_TRUE(snapshot->bodies[0]);
      for (const LedEstimate& led : snapshot->bodies[0]->leds) {
        EXPECT_EQ(led.cameras.empty(), std::isnan(led.residual)) << missed << " " << i;
        EXPECT_EQ(led.cameras.empty(), std::isnan(led.deviation)) << missed << " " << i;
      }
    }
    show(40);
  }
}

TEST_F(AtRest, TheLatestArrivalIsThatOfAllImages) {
  body_tracker_.setRig(rig_);
  show(8);
  tracking::CameraImage early = exactImage(rig_.cameras[0].camera, points_, 1000.02);
  early.arrival = 1000.021;  // the one before took 10 ms
  body_tracker_.take(0, {}, &early);
  EXPECT_EQ(body_tracker_.next()->latest_arrival, 1000.0 + 0.0025 * 7 + 0.01);
}

TEST_F(AtRest, AnImageWithoutATimeIsLeftAlone) {
  body_tracker_.setRig(rig_);
  show(40);
  ASSERT_TRUE(body_tracker_.next());
  for (const bool of_exposure : {false, true}) {
    tracking::CameraImage image = exactImage(rig_.cameras[0].camera, points_, 1000.1);
    (of_exposure ? image.stamp : image.arrival) = std::numeric_limits<double>::quiet_NaN();
    body_tracker_.take(0, {}, &image);
    EXPECT_EQ(image.spots.size(), 3u);
    EXPECT_FALSE(body_tracker_.next());
  }
}

}  // namespace
}  // namespace wiimote_tracker::body
