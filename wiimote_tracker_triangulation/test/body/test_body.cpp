#include "allocation_counter.h"
#include "geometry/random_rigs.h"
#include "tracking/scene.h"
#include "wiimote_tracker_triangulation/body/align.h"
#include "wiimote_tracker_triangulation/body/bodies_file.h"
#include "wiimote_tracker_triangulation/body/body_follower.h"
#include "wiimote_tracker_triangulation/body/body_tracker.h"
#include "wiimote_tracker_triangulation/body/constellation.h"
#include "wiimote_tracker_triangulation/body/error.h"
#include "wiimote_tracker_triangulation/body/learn_constellation.h"
#include "wiimote_tracker_triangulation/body/match_points.h"
#include "wiimote_tracker_triangulation/body/pose_filter.h"
#include "wiimote_tracker_triangulation/body/solve_pose.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>
#include <string>

namespace wiimote_tracker::body {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using geometry::test::Random;

/// Four LEDs about 100 mm from their middle.
Constellation plane() {
  return {"plane",
          {{0.09, 0.0, 0.03}, {-0.05, 0.085, 0.0}, {-0.06, -0.07, 0.04}, {0.02, 0.03, -0.09}}};
}

Isometry3d randomPose(Random& random, const Vector3d& center) {
  Isometry3d pose = Isometry3d::Identity();
  Vector3d axis = random.inBox(1.0).normalized();
  pose.linear() = Eigen::AngleAxisd(random.uniform(-M_PI, M_PI), axis).toRotationMatrix();
  pose.translation() = center + random.inBox(0.5);
  return pose;
}

Vector3d noise(Random& random, double stddev) {
  const double x = random.gaussian();
  const double y = random.gaussian();
  return stddev * Vector3d(x, y, random.gaussian());
}

/// Small rotation from one orientation to another, about the world axes [rad].
Vector3d rotationError(const Isometry3d& from, const Isometry3d& to) {
  const Eigen::AngleAxisd difference(Eigen::Matrix3d(to.linear() * from.linear().transpose()));
  return difference.angle() * difference.axis();
}

double squaredError(const Isometry3d& truth,
                    const Isometry3d& found,
                    const PoseCovariance& covariance) {
  Eigen::Matrix<double, 6, 1> error;
  error.head<3>() = found.translation() - truth.translation();
  error.tail<3>() = rotationError(truth, found);
  return error.dot(covariance.ldlt().solve(error));
}

/// Cramer-Rao bound of a pose seen once by each camera that has an LED in view, by differences of
/// Camera::project.
PoseCovariance bound(const geometry::Rig& rig,
                     const Constellation& body,
                     const Isometry3d& pose,
                     double pixel_stddev) {
  PoseCovariance information = PoseCovariance::Zero();
  for (const geometry::RigCamera& camera : rig.cameras) {
    for (const Vector3d& led : body.leds) {
      if (!camera.camera.sees(pose * led))
        continue;
      Eigen::Matrix<double, 2, 6> jacobian;
      for (int k = 0; k < 6; ++k) {
        const double h = 1e-5;
        const auto at = [&](double step) {
          Isometry3d moved = pose;
          if (k < 3)
            moved.translation()(k) += step;
          else
            moved.linear() =
                Eigen::AngleAxisd(step, Vector3d::Unit(k - 3)).toRotationMatrix() * pose.linear();
          return *camera.camera.project(moved * led);
        };
        jacobian.col(k) = (at(h) - at(-h)) / (2.0 * h);
      }
      information += jacobian.transpose() * jacobian / (pixel_stddev * pixel_stddev);
    }
  }
  return information.inverse();
}

std::string messageOf(const Constellation& body) {
  try {
    body.check();
  } catch (const BodyError& e) {
    return e.what();
  }
  return "good";
}

TEST(Constellation, SaysWhatIsWrong) {
  EXPECT_EQ(messageOf(plane()), "good");
  EXPECT_NE(messageOf({"", plane().leds}).find("no name"), std::string::npos);
  EXPECT_NE(messageOf({"a", {{0, 0, 0}, {0.1, 0, 0}}}).find("2 LEDs"), std::string::npos);
  EXPECT_NE(messageOf({"a", {{0, 0, 0}, {0.1, 0, 0}, {0.3, 0, 0}}}).find("one line"),
            std::string::npos);
  EXPECT_NE(messageOf({"a", {{0, 0, 0}, {0.1, 0, 0}, {0.1, 0, 0}}}).find("one place"),
            std::string::npos);
  EXPECT_NE(messageOf({"a", {{0, 0, 0}, {0.1, 0, 0}, {0.1, NAN, 0}}}).find("finite"),
            std::string::npos);
}

TEST(Constellation, SymmetriesAreFound) {
  const Symmetry isosceles = nearestSymmetry({"a", {{-0.05, 0, 0}, {0.05, 0, 0}, {0, 0.2, 0}}});
  EXPECT_NEAR(isosceles.residual, 0.0, 1e-9);
  EXPECT_EQ(isosceles.permutation, (std::vector<std::size_t>{1, 0, 2}));
  EXPECT_NE(describe({"a", {}}, isosceles).find("LED 0 for 1, 1 for 0"), std::string::npos);
  const Symmetry square =
      nearestSymmetry({"b", {{0, 0, 0}, {0.1, 0, 0}, {0.1, 0.1, 0}, {0, 0.1, 0}}});
  EXPECT_NEAR(square.residual, 0.0, 1e-9);
  const Symmetry near = nearestSymmetry(plane());
  EXPECT_GT(near.residual, kSymmetric);
  EXPECT_LT(near.residual, kNearlySymmetric);
  EXPECT_NE(describe(plane(), near).find("11.5 mm"), std::string::npos);
  EXPECT_GT(nearestSymmetry({"c", {{0, 0, 0}, {0.1, 0, 0}, {0, 0.2, 0}, {0, 0, 0.15}}}).residual,
            kNearlySymmetric);
}

TEST(Constellation, TheNearestSymmetryIsTheLeastOfAllPermutations) {
  Random random(11);
  for (int trial = 0; trial < 60; ++trial) {
    Constellation body{"random", {}};
    for (int i = 0; i < 3 + trial % 3; ++i)
      body.leds.push_back(random.inBox(0.1));
    std::vector<std::size_t> order(body.leds.size());
    std::iota(order.begin(), order.end(), 0u);
    double least = INFINITY;
    while (std::next_permutation(order.begin(), order.end())) {
      Eigen::Matrix3Xd from(3, static_cast<Eigen::Index>(order.size()));
      Eigen::Matrix3Xd to = from;
      for (std::size_t i = 0; i < order.size(); ++i) {
        from.col(static_cast<Eigen::Index>(i)) = body.leds[i];
        to.col(static_cast<Eigen::Index>(i)) = body.leds[order[i]];
      }
      const Eigen::Matrix4d fit = Eigen::umeyama(from, to, false);
      const Eigen::Matrix3Xd left =
          to - ((fit.topLeftCorner<3, 3>() * from).colwise() + fit.topRightCorner<3, 1>());
      least = std::min(least, std::sqrt(left.squaredNorm() / static_cast<double>(order.size())));
    }
    EXPECT_NEAR(nearestSymmetry(body).residual, least, 1e-9);
  }
}

TEST(Constellation, SymmetricOnesNeedLabels) {
  Constellation square{"square", {{0, 0, 0}, {0.1, 0, 0}, {0.1, 0.1, 0}, {0, 0.1, 0}}};
  EXPECT_NE(messageOf(square).find("looks the same within 0.0 mm"), std::string::npos);
  square.labels = {"a", "b", "c", "d"};
  EXPECT_EQ(messageOf(square), "good");
  EXPECT_EQ(square.labelOf(2), "c");
  square.labels[3] = "a";
  EXPECT_NE(messageOf(square).find("labels"), std::string::npos);
  EXPECT_NE(messageOf({"two words", plane().leds}).find("letter"), std::string::npos);
}

/// A body that is turned while it is looked at, with Gaussian errors of its points.
std::vector<LedsInstant> lookAt(const Constellation& body, double stddev, Random& random) {
  std::vector<LedsInstant> instants;
  for (int i = 0; i < 300; ++i) {
    const double t = 0.01 * i;
    Isometry3d pose = Isometry3d::Identity();
    pose.translation() = Vector3d(1.0 + 0.1 * t, 1.0, 1.0);
    pose.linear() = Eigen::AngleAxisd(0.5 * t, Vector3d(0.6, 0.0, 0.8)).toRotationMatrix();
    instants.push_back({t, {}});
    for (std::size_t led = 0; led < body.leds.size(); ++led)
      instants.back().leds.push_back({static_cast<std::uint32_t>(10 + led),
                                      pose * body.leds[led] + noise(random, stddev), 0.002});
  }
  return instants;
}

TEST(LearnConstellation, KnowsHowWellItKnowsTheShape) {
  Random random(41);
  double errors = 0.0;
  double expected = 0.0;
  constexpr int kTrials = 60;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<LedsInstant> instants = lookAt(plane(), 0.003, random);
    // An LED is hidden for a while and comes back as another track.
    for (std::size_t i = 100; i < instants.size(); ++i) {
      if (i < 130)
        instants[i].leds.erase(instants[i].leds.begin() + 1);
      else
        instants[i].leds[1].id = 99;
    }
    const LearnedConstellation learned = learnConstellation("thing", instants);
    ASSERT_EQ(learned.constellation.leds.size(), 4u);
    EXPECT_EQ(learned.ids[1], 11u);
    std::vector<PointPair> pairs;
    for (std::size_t led = 0; led < 4; ++led)
      pairs.push_back({plane().leds[led], learned.constellation.leds[led], 1.0});
    // Six of the twelve coordinates are free: where the body's axes lie.
    errors += align(pairs.data(), pairs.size()).cost;
    for (const double stddev : learned.stddev)
      expected += 6.0 / 4.0 * stddev * stddev;
  }
  // Variances of six and of eight parts' degrees of freedom, for each trial.
  EXPECT_NEAR(errors / expected, 1.0, 4.0 * std::sqrt((2.0 / 6.0 + 2.0 / (7.0 * 6.0)) / kTrials));
  EXPECT_NEAR(std::sqrt(errors / (6.0 * kTrials)), 0.003 / std::sqrt(297.0), 2e-5);
}

TEST(LearnConstellation, SaysWhatIsWrong) {
  Random random(42);
  const auto messageFor = [](const std::vector<LedsInstant>& instants) {
    try {
      learnConstellation("thing", instants);
    } catch (const BodyError& e) {
      return std::string(e.what());
    }
    return std::string("learned");
  };
  std::vector<LedsInstant> good = lookAt(plane(), 0.001, random);
  EXPECT_EQ(messageFor(good), "learned");
  EXPECT_NE(messageFor({good.begin(), good.begin() + 20}).find("20 instants"), std::string::npos);
  EXPECT_NE(messageFor({}).find("0 LEDs"), std::string::npos);
  std::vector<LedsInstant> two = good;
  for (LedsInstant& instant : two)
    instant.leds.resize(2);
  EXPECT_NE(messageFor(two).find("2 LEDs were seen"), std::string::npos);
  std::vector<LedsInstant> loose = good;
  for (LedsInstant& instant : loose)
    instant.leds[2].position.z() += 0.1 * std::sin(5.0 * instant.time);
  EXPECT_NE(messageFor(loose).find("against the others"), std::string::npos);
  EXPECT_NE(messageFor(lookAt({"a", {{-0.05, 0, 0}, {0.05, 0, 0}, {0, 0.2, 0}}}, 1e-4, random))
                .find("looks the same"),
            std::string::npos);
}

TEST(BodiesFile, ComesBackBitForBit) {
  const std::string file = testing::TempDir() + "bodies.yaml";
  Constellation other = plane();
  other.name = "other";
  other.leds[0].x() = 1.0 / 3.0;
  writeBodies(file, {plane(), other});
  const std::vector<Constellation> back = readBodies(file);
  ASSERT_EQ(back.size(), 2u);
  EXPECT_EQ(back[0].name, "plane");
  EXPECT_EQ(back[1].leds, other.leds);
  EXPECT_NO_THROW(writeBodies(file, {plane(), plane()}));
  EXPECT_THROW(readBodies(file), BodyError) << "two of one name";
}

TEST(BodiesFile, ReadsMarkerPositions) {
  const std::string file = testing::TempDir() + "drone.yaml";
  std::ofstream(file) << "# in metres\nmarker_positions:\n  - x: 0.1\n    y: 0.0\n    z: 0.02\n"
                         "  - {x: 0.0, y: 0.05, z: 0}\n  - {x: -0.03, y: -0.1, z: 0}\n";
  const std::vector<Constellation> bodies = readBodies(file);
  ASSERT_EQ(bodies.size(), 1u);
  EXPECT_EQ(bodies[0].name, "drone");
  EXPECT_EQ(bodies[0].leds[1], Vector3d(0.0, 0.05, 0.0));
}

TEST(BodiesFile, DamagedOnesAreRefusedByName) {
  const std::string file = testing::TempDir() + "damaged.yaml";
  const auto messageFor = [&](const std::string& content) {
    std::ofstream(file) << content;
    try {
      readBodies(file);
    } catch (const geometry::Error& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  const std::string head = "format: wiimote_tracker_bodies\nversion: 1\nbodies:\n";
  EXPECT_NE(messageFor("a: [1").find("not YAML"), std::string::npos);
  EXPECT_NE(messageFor("format: x\nversion: 1\nbodies: []\n").find("format"), std::string::npos);
  EXPECT_NE(messageFor(head + "  - {name: a, leds: [[1, 2]]}\n").find("[x, y, z]"),
            std::string::npos);
  EXPECT_NE(messageFor(head + "  - {name: a, leds: [[1, 2, 3]], colour: red}\n").find("colour"),
            std::string::npos);
  EXPECT_NE(messageFor(head + "  - {name: a, leds: [[1, 2, 3]]}\n").find("3 to 8"),
            std::string::npos);
}

TEST(Align, IsThatOfUmeyama) {
  Random random(3);
  for (int trial = 0; trial < 100; ++trial) {
    const Isometry3d pose = randomPose(random, Vector3d::Zero());
    std::vector<PointPair> pairs;
    Eigen::Matrix3Xd from(3, 5);
    Eigen::Matrix3Xd to(3, 5);
    for (int i = 0; i < 5; ++i) {
      from.col(i) = random.inBox(0.2);
      to.col(i) = pose * Vector3d(from.col(i)) + noise(random, 0.02);
      pairs.push_back({from.col(i), to.col(i), 2.0});
    }
    const Eigen::Matrix4d expected = Eigen::umeyama(from, to, false);
    const Alignment alignment = align(pairs.data(), pairs.size());
    EXPECT_LT((alignment.world_from_body.matrix() - expected).norm(), 1e-9);
    EXPECT_NEAR(alignment.world_from_body.linear().determinant(), 1.0, 1e-9);
    EXPECT_NEAR(alignment.cost,
                2.0 * (to - ((expected.topLeftCorner<3, 3>() * from).colwise() +
                             expected.topRightCorner<3, 1>()))
                          .squaredNorm(),
                1e-9);
  }
}

TEST(MatchPoints, FindsTheBodyAmongOtherPoints) {
  Random random(5);
  int right = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Isometry3d pose = randomPose(random, {1.0, 1.0, 1.0});
    const bool one_hidden = trial % 2 == 1;
    std::vector<MeasuredPoint> points;
    std::vector<int> led_of_point;
    for (int i = 3; i >= (one_hidden ? 1 : 0); --i) {
      points.push_back(
          {pose * plane().leds[static_cast<std::size_t>(i)] + noise(random, 0.001), 0.002, false});
      led_of_point.push_back(i);
    }
    for (int i = 0; i < 3; ++i) {
      points.push_back({pose.translation() + random.inBox(0.5), 0.002, false});
      led_of_point.push_back(-1);
    }
    const auto match = matchPoints(plane(), points, MatchOptions());
    ASSERT_TRUE(match);
    bool good = match->seen == (one_hidden ? 3u : 4u);
    for (int led = 0; led < 4; ++led) {
      const int p = match->point_of_led[static_cast<std::size_t>(led)];
      if (p != kUnseen)
        good = good && led_of_point[static_cast<std::size_t>(p)] == led;
    }
    right += good ? 1 : 0;
    if (good) {
      EXPECT_LT((match->world_from_body.translation() - pose.translation()).norm(), 0.02);
    }
  }
  // A stranger may fit better than an LED with its noise.
  EXPECT_GE(right, 297);
}

TEST(MatchPoints, KnowsWhenItCannotTell) {
  const Constellation isosceles{"a", {{-0.05, 0, 0}, {0.05, 0, 0}, {0, 0.2, 0}}};
  std::vector<MeasuredPoint> points;
  for (const Vector3d& led : isosceles.leds)
    points.push_back({led, 0.002, false});
  const auto match = matchPoints(isosceles, points, MatchOptions());
  ASSERT_TRUE(match);
  EXPECT_NEAR(match->margin, 0.0, 1e-6);
  points[1].taken = true;
  EXPECT_FALSE(matchPoints(isosceles, points, MatchOptions()));
  EXPECT_FALSE(matchPoints(isosceles, {}, MatchOptions()));
}

TEST(MatchPoints, AMirroredBodyIsAnother) {
  std::vector<MeasuredPoint> points;
  for (const Vector3d& led : plane().leds)
    points.push_back({led.cwiseProduct(Vector3d(1, 1, -1)), 0.002, false});
  const auto match = matchPoints(plane(), points, MatchOptions());
  EXPECT_TRUE(!match || match->seen < 4);
}

TEST(SolvePose, ReachesTheBoundAndKnowsItsError) {
  Random random(7);
  const geometry::Rig rig = tracking::test::paperRig();
  double squared = 0.0;
  double position = 0.0;
  double position_bound = 0.0;
  double rotation = 0.0;
  double rotation_bound = 0.0;
  double position_variance = 0.0;  // of the sums of squares
  double rotation_variance = 0.0;
  constexpr int kTrials = 1500;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Isometry3d truth = randomPose(random, {1.25, 1.25, 1.1});
    std::vector<LedObservation> observations;
    for (const geometry::RigCamera& camera : rig.cameras) {
      for (const Vector3d& led : plane().leds) {
        const double u = 0.5 * random.gaussian();
        const double v = 0.5 * random.gaussian();
        if (camera.camera.sees(truth * led))
          observations.push_back(
              {&camera.camera, led, *camera.camera.project(truth * led) + Eigen::Vector2d(u, v)});
      }
    }
    Isometry3d start = truth;
    start.translation() += noise(random, 0.03);
    start.linear() =
        Eigen::AngleAxisd(0.3, random.inBox(1.0).normalized()).toRotationMatrix() * truth.linear();
    const auto solved = solvePose(observations.data(), observations.size(), start, 0.5);
    ASSERT_TRUE(solved);
    const PoseCovariance least = bound(rig, plane(), truth, 0.5);
    EXPECT_LT((solved->covariance - least).norm(), 0.1 * least.norm());
    squared += squaredError(truth, solved->world_from_body, solved->covariance);
    position += (solved->world_from_body.translation() - truth.translation()).squaredNorm();
    position_bound += least.topLeftCorner<3, 3>().trace();
    rotation += rotationError(truth, solved->world_from_body).squaredNorm();
    rotation_bound += least.bottomRightCorner<3, 3>().trace();
    position_variance += 2.0 * least.topLeftCorner<3, 3>().squaredNorm();
    rotation_variance += 2.0 * least.bottomRightCorner<3, 3>().squaredNorm();
  }
  EXPECT_NEAR(squared / (6.0 * kTrials), 1.0, 4.0 * std::sqrt(2.0 / (6.0 * kTrials)));
  EXPECT_NEAR(position / position_bound, 1.0, 4.0 * std::sqrt(position_variance) / position_bound);
  EXPECT_NEAR(rotation / rotation_bound, 1.0, 4.0 * std::sqrt(rotation_variance) / rotation_bound);
  RecordProperty("position_mm", std::to_string(1e3 * std::sqrt(position / kTrials)));
  RecordProperty("rotation_deg", std::to_string(std::sqrt(rotation / kTrials) * 180.0 / M_PI));
}

TEST(SolvePose, RefusesWhatDoesNotDetermineIt) {
  const geometry::Rig rig = tracking::test::paperRig();
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = Vector3d(1.25, 1.25, 1.0);
  std::vector<LedObservation> observations;
  for (const geometry::RigCamera& camera : rig.cameras)
    observations.push_back(
        {&camera.camera, plane().leds[0], *camera.camera.project(pose * plane().leds[0])});
  EXPECT_FALSE(solvePose(observations.data(), 4, pose, 0.5)) << "one LED only";
  EXPECT_FALSE(solvePose(observations.data(), 2, pose, 0.5));
}

/// A body that moves and turns before the paper's cameras, and a tracker that follows it.
class Follow {
 public:
  Follow(const Constellation& body,
         const std::function<Isometry3d(double)>& pose,
         const tracking::test::SceneOptions& options,
         unsigned seed)
      : body_(body), pose_(pose), scene_(rig(), pathsOf(body, pose), options, seed) {
    tracker_ = std::make_unique<BodyTracker>(rig(), std::vector<Constellation>{body},
                                             BodyTrackerOptions());
  }

  static geometry::Rig rig() { return tracking::test::paperRig(); }

  static std::vector<tracking::test::Path> pathsOf(const Constellation& body,
                                                   const std::function<Isometry3d(double)>& pose) {
    std::vector<tracking::test::Path> paths;
    for (const Vector3d& led : body.leds)
      paths.push_back([led, pose](double t) { return Vector3d(pose(t) * led); });
    return paths;
  }

  void step() {
    const tracking::test::SceneImage& image = scene_.next();
    std::vector<Eigen::Vector2d> pixels;
    for (const tracking::Spot& spot : image.image.spots)
      pixels.push_back(spot.pixel);
    tracker_->add(image.camera, image.image.stamp, pixels);
    time_ = tracker_->time();
  }

  const std::optional<BodyEstimate>& estimate() const { return tracker_->bodies()[0]; }
  Isometry3d truth() const { return pose_(time_); }

  Constellation body_;
  std::function<Isometry3d(double)> pose_;
  tracking::test::Scene scene_;
  std::unique_ptr<BodyTracker> tracker_;
  double time_ = 0.0;
};

struct Score {
  double position = 0.0;  // RMS over the bound of one image of each camera [1]
  double rotation = 0.0;
  double nees = 0.0;   // per coordinate [1]
  double wrong = 0.0;  // share of estimates more than 20 degrees off
  double known = 0.0;  // share of the time
};

Score score(Follow* follow, double seconds) {
  Score score;
  int count = 0;
  int known = 0;
  double position_bound = 0.0;
  double rotation_bound = 0.0;
  const double warm = 1001.0;
  while (follow->time_ < warm + seconds) {
    follow->step();
    if (follow->time_ < warm)
      continue;
    ++count;
    if (!follow->estimate())
      continue;
    ++known;
    const Isometry3d truth = follow->truth();
    const Isometry3d& found = follow->estimate()->world_from_body;
    const double turn = rotationError(truth, found).norm();
    score.wrong += turn > 0.35 ? 1.0 : 0.0;
    if (count % 8 != 0)
      continue;
    const PoseCovariance least = bound(Follow::rig(), follow->body_, truth, 0.5);
    score.position += (found.translation() - truth.translation()).squaredNorm();
    score.rotation += turn * turn;
    position_bound += least.topLeftCorner<3, 3>().trace();
    rotation_bound += least.bottomRightCorner<3, 3>().trace();
    score.nees += squaredError(truth, found, follow->estimate()->covariance.topLeftCorner<6, 6>()) /
                  6.0 * 8.0;
  }
  score.position = std::sqrt(score.position / position_bound);
  score.rotation = std::sqrt(score.rotation / rotation_bound);
  score.nees /= known;
  score.wrong /= known;
  score.known = static_cast<double>(known) / count;
  return score;
}

Isometry3d handheld(double t) {
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = Vector3d(1.25 + 0.4 * std::sin(1.3 * t), 1.25 + 0.4 * std::cos(1.1 * t),
                                1.1 + 0.2 * std::sin(0.7 * t));
  pose.linear() = (Eigen::AngleAxisd(1.2 * std::sin(0.9 * t), Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(0.7 * std::sin(1.7 * t), Vector3d::UnitX()))
                      .toRotationMatrix();
  return pose;
}

Isometry3d tumbling(double t) {
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = Vector3d(1.25, 1.25, 1.1);
  pose.linear() =
      Eigen::AngleAxisd(2.0 * M_PI * (t - 1000.0), Vector3d(0.48, 0.6, 0.64)).toRotationMatrix();
  return pose;
}

tracking::test::SceneOptions halfAPixel() {
  tracking::test::SceneOptions options;
  options.pixel_noise = 0.5;
  return options;
}

TEST(BodyTracker, FollowsAHandWithinTheBoundOfASingleView) {
  Follow follow(plane(), handheld, halfAPixel(), 21);
  const Score result = score(&follow, 8.0);
  EXPECT_EQ(result.known, 1.0);
  EXPECT_EQ(result.wrong, 0.0);
  EXPECT_LT(result.position, 1.1);
  EXPECT_LT(result.rotation, 1.1);
  EXPECT_GT(result.nees, 0.3);
  EXPECT_LT(result.nees, 1.5);
  RecordProperty("position_ratio", std::to_string(result.position));
  RecordProperty("rotation_ratio", std::to_string(result.rotation));
  RecordProperty("nees", std::to_string(result.nees));
}

TEST(BodyTracker, FollowsAFullTurnASecond) {
  Follow follow(plane(), tumbling, halfAPixel(), 22);
  const Score result = score(&follow, 6.0);
  EXPECT_GT(result.known, 0.999);
  EXPECT_LT(result.wrong, 0.001);
  EXPECT_LT(result.position, 1.1);
  EXPECT_LT(result.rotation, 1.1);
  RecordProperty("position_ratio", std::to_string(result.position));
  RecordProperty("rotation_ratio", std::to_string(result.rotation));
  RecordProperty("nees", std::to_string(result.nees));
}

TEST(BodyTracker, IsNotLostWhenItIsShaken) {
  const auto shaken = [](double t) {
    Isometry3d pose = handheld(t);
    pose.translation().x() += 0.1 * std::sin(2.0 * M_PI * 2.0 * t);  // up to 16 m/s^2
    pose.linear() = Eigen::AngleAxisd(0.5 * std::sin(2.0 * M_PI * 2.5 * t), Vector3d::UnitY())
                        .toRotationMatrix() *
                    pose.linear();
    return pose;
  };
  Follow follow(plane(), shaken, halfAPixel(), 28);
  const Score result = score(&follow, 6.0);
  EXPECT_EQ(result.known, 1.0);
  EXPECT_EQ(result.wrong, 0.0);
  EXPECT_LT(result.nees, 3.0);
  RecordProperty("position_ratio", std::to_string(result.position));
  RecordProperty("rotation_ratio", std::to_string(result.rotation));
  RecordProperty("nees", std::to_string(result.nees));
}

TEST(BodyTracker, LightsThatBecomeOneSpotPullItNowhere) {
  tracking::test::SceneOptions options = halfAPixel();
  options.merging_distance = 12.0;
  Follow follow(plane(), handheld, options, 29);
  const Score result = score(&follow, 8.0);
  EXPECT_EQ(result.known, 1.0);
  EXPECT_EQ(result.wrong, 0.0);
  // The bound knows nothing of merging.
  EXPECT_LT(result.position, 1.3);
  EXPECT_LT(result.rotation, 1.3);
  EXPECT_LT(result.nees, 1.5);
  RecordProperty("position_ratio", std::to_string(result.position));
  RecordProperty("rotation_ratio", std::to_string(result.rotation));
  RecordProperty("nees", std::to_string(result.nees));
}

TEST(BodyTracker, OneLedOfFourMayBeHidden) {
  tracking::test::SceneOptions options = halfAPixel();
  options.hidden = [](std::size_t, std::size_t led, double) { return led == 2; };
  Follow follow(plane(), handheld, options, 23);
  const Score result = score(&follow, 4.0);
  EXPECT_EQ(result.known, 1.0);
  EXPECT_EQ(result.wrong, 0.0);
  ASSERT_TRUE(follow.estimate());
  EXPECT_TRUE(std::isnan(follow.estimate()->leds[2].deviation));
  EXPECT_LT(follow.estimate()->leds[0].deviation, 0.02);
  EXPECT_TRUE(follow.estimate()->leds[2].cameras.empty());
  EXPECT_GE(follow.estimate()->leds[0].cameras.size(), 2u);
}

TEST(BodyTracker, FindsTheBodyAgainSoonAfterItWasHidden) {
  tracking::test::SceneOptions options = halfAPixel();
  options.hidden = [](std::size_t, std::size_t, double t) { return std::fmod(t, 2.0) > 1.2; };
  Follow follow(plane(), handheld, options, 24);
  int occlusions = 0;
  bool was_lost = false;
  for (int i = 0; i < 4 * 100 * 20; ++i) {
    follow.step();
    const double since = std::fmod(follow.time_, 2.0);
    if (since > 1.3 && since < 1.9 && follow.estimate()) {
      EXPECT_FALSE(follow.estimate()->tracked);
    }
    was_lost = was_lost || !follow.estimate();
    if (was_lost && since > 0.2 && since < 1.2) {
      ++occlusions;
      was_lost = false;
      ASSERT_TRUE(follow.estimate()) << "0.2 s after the light came back";
      EXPECT_LT(rotationError(follow.truth(), follow.estimate()->world_from_body).norm(), 0.1);
    }
  }
  EXPECT_GE(occlusions, 8);
}

TEST(BodyTracker, OneCameraIsEnoughForFourLeds) {
  tracking::test::SceneOptions options = halfAPixel();
  options.hidden = [](std::size_t camera, std::size_t, double t) {
    return t > 1001.0 && camera != 1;
  };
  Follow follow(plane(), handheld, options, 25);
  while (follow.time_ < 1010.0)
    follow.step();
  ASSERT_TRUE(follow.estimate());
  EXPECT_TRUE(follow.estimate()->tracked);
  EXPECT_LT(
      (follow.estimate()->world_from_body.translation() - follow.truth().translation()).norm(),
      0.15);
  EXPECT_LT(rotationError(follow.truth(), follow.estimate()->world_from_body).norm(), 0.3);
}

TEST(BodyTracker, TwoBodiesAndAFreeLed) {
  const Constellation other{"other", {{0.1, 0.0, 0.0}, {-0.08, 0.02, 0.0}, {0.0, 0.07, 0.05}}};
  const auto second = [](double t) {
    Isometry3d pose = handheld(t + 3.0);
    pose.translation() += Vector3d(0.1, -0.3, 0.3);
    return pose;
  };
  std::vector<tracking::test::Path> paths = Follow::pathsOf(plane(), handheld);
  for (const auto& path : Follow::pathsOf(other, second))
    paths.push_back(path);
  paths.push_back(tracking::test::still({1.0, 1.6, 0.7}));
  tracking::test::SceneOptions options = halfAPixel();
  options.maximum_spots = 8;
  tracking::test::Scene scene(Follow::rig(), paths, options, 26);
  BodyTracker tracker(Follow::rig(), {plane(), other}, BodyTrackerOptions());
  int known = 0;
  int good = 0;
  while (tracker.time() < 1006.0 || std::isinf(tracker.time())) {
    const tracking::test::SceneImage& image = scene.next();
    std::vector<Eigen::Vector2d> pixels;
    for (const tracking::Spot& spot : image.image.spots)
      pixels.push_back(spot.pixel);
    tracker.add(image.camera, image.image.stamp, pixels);
    if (tracker.time() < 1001.0 || !tracker.bodies()[0] || !tracker.bodies()[1])
      continue;
    ++known;
    const double first_error =
        rotationError(handheld(tracker.time()), tracker.bodies()[0]->world_from_body).norm();
    const double second_error =
        rotationError(second(tracker.time()), tracker.bodies()[1]->world_from_body).norm();
    good += first_error < 0.2 && second_error < 0.2 ? 1 : 0;
  }
  EXPECT_GE(known, 1900);
  EXPECT_GE(good, known * 99 / 100);
}

TEST(BodyTracker, TheOrderOfArrivalDoesNotMatter) {
  tracking::test::SceneOptions options = halfAPixel();
  options.delay_jitter = 0.004;
  tracking::test::Scene scene(Follow::rig(), Follow::pathsOf(plane(), handheld), options, 27);
  struct Image {
    std::size_t camera;
    double time;
    std::vector<Eigen::Vector2d> pixels;
  };
  std::vector<Image> images;
  for (int i = 0; i < 800; ++i) {
    const tracking::test::SceneImage& image = scene.next();
    images.push_back({image.camera, image.image.stamp, {}});
    for (const tracking::Spot& spot : image.image.spots)
      images.back().pixels.push_back(spot.pixel);
  }
  BodyTracker as_arrived(Follow::rig(), {plane()}, BodyTrackerOptions());
  for (const Image& image : images)
    EXPECT_TRUE(as_arrived.add(image.camera, image.time, image.pixels));
  const bool was_sorted = std::is_sorted(
      images.begin(), images.end(), [](const Image& a, const Image& b) { return a.time < b.time; });
  EXPECT_FALSE(was_sorted);
  std::sort(images.begin(), images.end(),
            [](const Image& a, const Image& b) { return a.time < b.time; });
  BodyTracker in_order(Follow::rig(), {plane()}, BodyTrackerOptions());
  for (const Image& image : images)
    in_order.add(image.camera, image.time, image.pixels);
  ASSERT_TRUE(as_arrived.bodies()[0]);
  ASSERT_TRUE(in_order.bodies()[0]);
  EXPECT_EQ(as_arrived.bodies()[0]->world_from_body.matrix(),
            in_order.bodies()[0]->world_from_body.matrix());
  EXPECT_FALSE(as_arrived.add(0, as_arrived.time() - 1.0, {}));
}

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

TEST(BodyFollower, TakesTheSpotsOfBodiesOutOfTheImages) {
  const geometry::Rig rig = Follow::rig();
  BodyFollower follower((BodyTrackerOptions()));
  const Constellation three{"three", {{0.1, 0.0, 0.0}, {-0.08, 0.02, 0.0}, {0.0, 0.07, 0.05}}};
  follower.setBodies({three});
  follower.setRig(rig);
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
    follower.take(camera, &image);
    const BodySnapshot* snapshot = follower.next();
    ASSERT_TRUE(snapshot);
    EXPECT_GT(snapshot->time, last);
    last = snapshot->time;
    EXPECT_FALSE(follower.next()) << "once only";
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
    follower.take(0, &image);
    const BodySnapshot* snapshot = follower.next();
    ASSERT_TRUE(snapshot);
    lost += static_cast<int>(snapshot->lost.size());
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
    follower.take(camera, &image);
  }
  const BodySnapshot* snapshot = follower.next();
  ASSERT_TRUE(snapshot);
  EXPECT_LT(snapshot->time, 901.0);
  EXPECT_TRUE(snapshot->bodies[0]);
}

TEST(BodyTracker, LabelsTellHowASymmetricBodyIsTurned) {
  const Constellation square{
      "square", {{0, 0, 0}, {0.1, 0, 0}, {0.1, 0.1, 0}, {0, 0.1, 0}}, {"a", "b", "c", "d"}};
  const geometry::Rig rig = Follow::rig();
  BodyTracker tracker(rig, {square}, BodyTrackerOptions());
  Random random(43);
  const Isometry3d pose = randomPose(random, {1.2, 1.3, 1.1});
  const auto show = [&](int first, int last) {
    for (int i = first; i < last; ++i) {
      const geometry::Camera& camera = rig.cameras[static_cast<std::size_t>(i) % 4].camera;
      std::vector<Eigen::Vector2d> pixels;
      for (const Vector3d& led : square.leds) {
        if (camera.sees(pose * led))
          pixels.push_back(*camera.project(pose * led));
      }
      tracker.add(static_cast<std::size_t>(i) % 4, 1000.0 + 0.0025 * i, pixels);
    }
  };
  show(0, 40);
  EXPECT_FALSE(tracker.bodies()[0]) << "its shape does not tell";
  std::vector<LabelledPoint> points;
  for (const std::size_t led : {3, 0, 2})
    points.push_back(
        {square.labels[led], pose * square.leds[led], 1e-6 * Eigen::Matrix3d::Identity()});
  points.push_back({"else", Vector3d(0, 0, 0), 1e-6 * Eigen::Matrix3d::Identity()});
  std::vector<LabelledPoint> wrong = points;
  std::swap(wrong[0].position, wrong[1].position);
  wrong[2].position.z() += 0.1;
  tracker.startFromLabels(wrong);
  EXPECT_FALSE(tracker.bodies()[0]) << "they do not lie as on the body";
  tracker.startFromLabels({points[0], points[1]});
  EXPECT_FALSE(tracker.bodies()[0]) << "two are not enough";
  tracker.startFromLabels(points);
  show(40, 200);
  ASSERT_TRUE(tracker.bodies()[0]);
  EXPECT_LT(rotationError(pose, tracker.bodies()[0]->world_from_body).norm(), 0.01);
}

TEST(BodyTracker, DoesNotAllocateOnceWarm) {
  tracking::test::SceneOptions options = halfAPixel();
  options.delay_jitter = 0.004;  // late images too
  options.hidden = [](std::size_t, std::size_t, double t) { return std::fmod(t, 2.0) > 1.2; };
  tracking::test::Scene scene(Follow::rig(), Follow::pathsOf(plane(), handheld), options, 44);
  BodyTracker tracker(Follow::rig(), {plane()}, BodyTrackerOptions());
  std::vector<Eigen::Vector2d> pixels;
  int allocations = 0;
  for (int i = 0; i < 4 * 100 * 8; ++i) {
    const tracking::test::SceneImage& image = scene.next();
    pixels.clear();
    for (const tracking::Spot& spot : image.image.spots)
      pixels.push_back(spot.pixel);
    const int before = g_allocations;
    tracker.add(image.camera, image.image.stamp, pixels);
    // Found again after each loss: what is known of it is new then.
    if (i > 4 * 100 * 4 && tracker.bodies()[0] &&
        tracker.bodies()[0]->first_seen < tracker.time() - 0.1)
      allocations += g_allocations - before;
  }
  EXPECT_EQ(allocations, 0);
}

}  // namespace
}  // namespace wiimote_tracker::body
