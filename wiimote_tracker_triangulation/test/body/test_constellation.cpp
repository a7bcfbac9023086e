// Shapes of bodies: refusals, symmetries, learning, and their file.
#include "body/align.h"
#include "body/bodies_file.h"
#include "body/body_scene.h"
#include "body/learn_constellation.h"
#include "refusal_of.h"
#include "wiimote_tracker_triangulation/geometry/error.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numeric>
#include <string>

namespace wiimote_tracker::body {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using geometry::test::Random;
using test::fourLeds;
using test::noise;

std::string messageOf(const Constellation& body) {
  return refusalOf([&] { body.check(); });
}

TEST(Constellation, SaysWhatIsWrong) {
  EXPECT_EQ(messageOf(fourLeds()), "not refused");
  EXPECT_NE(messageOf({"", fourLeds().leds}).find("no name"), std::string::npos);
  EXPECT_EQ(messageOf({"led_3", fourLeds().leds}),
            "'led_3' is the name of an LED without a label; choose another one");
  EXPECT_EQ(messageOf({"led_a", fourLeds().leds}), "not refused");
  EXPECT_NE(messageOf({"a", {{0, 0, 0}, {0.1, 0, 0}}}).find("2 LEDs"), std::string::npos);
  EXPECT_NE(messageOf({"a", {{0, 0, 0}, {0.1, 0, 0}, {0.3, 0, 0}}}).find("one line"),
            std::string::npos);
  EXPECT_NE(messageOf({"a", {{0, 0, 0}, {0.1, 0, 0}, {0.1, 0, 0}}}).find("one place"),
            std::string::npos);
  EXPECT_NE(messageOf({"a", {{0, 0, 0}, {0.1, 0, 0}, {0.1, NAN, 0}}}).find("finite"),
            std::string::npos);
  std::vector<Vector3d> millimetres = fourLeds().leds;
  for (Vector3d& led : millimetres)
    led *= 1000.0;
  EXPECT_NE(messageOf({"a", millimetres}).find("give positions in metres"), std::string::npos);
  Constellation nine{"a", {}};
  for (int i = 0; i < 9; ++i)
    nine.leds.emplace_back(0.05 * i, 0.01 * i * i, 0.0);
  EXPECT_NE(messageOf(nine).find("9 LEDs"), std::string::npos);
}

TEST(Constellation, SymmetriesAreFound) {
  const Symmetry isosceles = nearestSymmetry({"a", {{-0.05, 0, 0}, {0.05, 0, 0}, {0, 0.2, 0}}});
  EXPECT_NEAR(isosceles.residual, 0.0, 1e-9);
  EXPECT_EQ(isosceles.permutation, (std::vector<std::size_t>{1, 0, 2}));
  EXPECT_NE(describe({"a", {}}, isosceles).find("LED 0 for 1, 1 for 0"), std::string::npos);
  const Symmetry square =
      nearestSymmetry({"b", {{0, 0, 0}, {0.1, 0, 0}, {0.1, 0.1, 0}, {0, 0.1, 0}}});
  EXPECT_NEAR(square.residual, 0.0, 1e-9);
  const Symmetry near = nearestSymmetry(fourLeds());
  EXPECT_GT(near.residual, kSymmetric);
  EXPECT_LT(near.residual, kNearlySymmetric);
  EXPECT_NE(describe(fourLeds(), near).find("11.5 mm"), std::string::npos);
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

TEST(Constellation, NamesTheNearestLedsWhoseSpotsMerge) {
  EXPECT_FALSE(describeMergingLeds(fourLeds()));
  Constellation body = fourLeds();
  body.leds[3] = body.leds[1] + Vector3d(0.0, 0.025, 0.0);
  const auto sentence = describeMergingLeds(body);
  ASSERT_TRUE(sentence);
  EXPECT_NE(sentence->find("'four_leds' has LEDs 1 and 3 only 25.0 mm apart"), std::string::npos);
  body.labels = {"a", "b", "c", "d"};
  body.leds[2] = body.leds[0] + Vector3d(0.015, 0.0, 0.0);
  EXPECT_NE(describeMergingLeds(body)->find("LEDs a and c only 15.0 mm"), std::string::npos);
}

TEST(Constellation, TwinsAreNamed) {
  const Constellation a = fourLeds();
  Constellation b = a;
  b.name = "twin";
  std::reverse(b.leds.begin(), b.leds.end());
  for (Vector3d& led : b.leds)
    led = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()) * led + Vector3d(1, 0, 2);
  ASSERT_TRUE(describeTwins(a, b));
  EXPECT_EQ(describeTwins(a, b)->find("bodies 'four_leds' and 'twin' have the same shape"), 0u);
  b.leds[1] += Vector3d(0.0, 0.1, 0.0);
  EXPECT_FALSE(describeTwins(a, b)) << "a place differs by centimetres";
  b.leds.pop_back();
  EXPECT_FALSE(describeTwins(a, b)) << "three LEDs";

  Constellation corner{"corner", {{0, 0, 0}, {0.1, 0, 0}, {0, 0.2, 0}, {0, 0, 0.15}}};
  Constellation mirrored = corner;
  for (Vector3d& led : mirrored.leds)
    led.x() = -led.x();
  EXPECT_TRUE(describeTwins(corner, corner));
  EXPECT_FALSE(describeTwins(corner, mirrored));

  Constellation square{"square", {{0, 0, 0}, {0.1, 0, 0}, {0.1, 0.1, 0}, {0, 0.1, 0}}};
  square.labels = {"a", "b", "c", "d"};
  Constellation other = square;
  EXPECT_TRUE(describeTwins(square, other));
  other.labels = {"e", "f", "g", "h"};
  EXPECT_FALSE(describeTwins(square, other)) << "found by their labels alone";
}

TEST(Constellation, SymmetricOnesNeedLabels) {
  Constellation square{"square", {{0, 0, 0}, {0.1, 0, 0}, {0.1, 0.1, 0}, {0, 0.1, 0}}};
  EXPECT_NE(messageOf(square).find("looks the same within 0.0 mm"), std::string::npos);
  square.labels = {"a", "b", "c", "d"};
  EXPECT_EQ(messageOf(square), "not refused");
  EXPECT_EQ(square.labelOf(2), "c");
  square.labels[3] = "a";
  EXPECT_NE(messageOf(square).find("labels"), std::string::npos);
  square.labels = {"a", "b", "c"};
  EXPECT_NE(messageOf(square).find("labels"), std::string::npos) << "one too few";
  EXPECT_NE(messageOf({"two words", fourLeds().leds}).find("letter"), std::string::npos);
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

TEST(LearnConstellation, ItsCovarianceIsConsistent) {
  Random random(41);
  double errors = 0.0;
  double expected = 0.0;
  constexpr int kTrials = 60;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<LedsInstant> instants = lookAt(fourLeds(), 0.003, random);
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
      pairs.push_back({fourLeds().leds[led], learned.constellation.leds[led], 1.0});
    // Six of the twelve coordinates are free: the pose of the body's axes.
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
    return refusalOf([&] { learnConstellation("thing", instants); });
  };
  std::vector<LedsInstant> good = lookAt(fourLeds(), 0.001, random);
  EXPECT_EQ(messageFor(good), "not refused");
  EXPECT_NE(messageFor({good.begin(), good.begin() + 20}).find("20 instants"), std::string::npos);
  EXPECT_NE(messageFor({}).find("0 LEDs"), std::string::npos);
  std::vector<LedsInstant> two = good;
  for (LedsInstant& instant : two)
    instant.leds.resize(2);
  EXPECT_NE(messageFor(two).find("saw 2 LEDs at once"), std::string::npos);
  std::vector<LedsInstant> hidden = good;
  for (std::size_t i = 60; i < hidden.size(); ++i)
    hidden[i].leds.pop_back();
  EXPECT_NE(messageFor(hidden).find("LED 3 of body 'thing' was hidden"), std::string::npos);
  std::vector<LedsInstant> loose = good;
  for (LedsInstant& instant : loose)
    instant.leds[2].position.z() += 0.1 * std::sin(5.0 * instant.time);
  EXPECT_NE(messageFor(loose).find("against the others"), std::string::npos);
  Constellation symmetric =
      learnConstellation("thing",
                         lookAt({"a", {{-0.05, 0, 0}, {0.05, 0, 0}, {0, 0.2, 0}}}, 1e-4, random))
          .constellation;
  EXPECT_NE(messageOf(symmetric).find("looks the same"), std::string::npos);
  symmetric.labels = {"left", "right", "top"};
  EXPECT_EQ(messageOf(symmetric), "not refused");
}

/// A file of this process, which is removed at the end.
class BodiesFile : public testing::Test {
 protected:
  void TearDown() override {
    std::remove(file_.c_str());
    std::remove((file_ + ".bak").c_str());
  }

  const std::string name_ = "bodies_" + std::to_string(::getpid());
  const std::string file_ = testing::TempDir() + name_ + ".yaml";
};

TEST_F(BodiesFile, ComesBackBitForBit) {
  Constellation other = fourLeds();
  other.name = "other";
  other.labels = {"tip", "y", "12", "led_3"};
  other.leds[0].x() = 1.0 / 3.0;
  other.imu = ImuMount{"/imu/data", Isometry3d::Identity(), 1.0 / 7.0};
  other.imu->body_from_imu.translation() = Vector3d(0.1, 0.2, 1.0 / 3.0);
  other.imu->body_from_imu.linear() = Eigen::AngleAxisd(0.5, Vector3d::UnitX()).toRotationMatrix();
  writeBodies(file_, {fourLeds(), other});
  const std::vector<Constellation> back = readBodies(file_);
  ASSERT_EQ(back.size(), 2u);
  EXPECT_EQ(back[0].name, "four_leds");
  EXPECT_TRUE(back[0].labels.empty());
  EXPECT_EQ(back[1].name, "other");
  EXPECT_EQ(back[1].leds, other.leds);
  EXPECT_EQ(back[1].labels, other.labels);
  EXPECT_FALSE(back[0].imu);
  ASSERT_TRUE(back[1].imu);
  EXPECT_EQ(back[1].imu->topic, "/imu/data");
  EXPECT_EQ(back[1].imu->clock_offset, 1.0 / 7.0);
  EXPECT_EQ(back[1].imu->body_from_imu.translation(), other.imu->body_from_imu.translation());
  EXPECT_TRUE(back[1].imu->body_from_imu.isApprox(other.imu->body_from_imu, 1e-12));
  EXPECT_NO_THROW(writeBodies(file_, {fourLeds(), fourLeds()}));
  EXPECT_THROW(readBodies(file_), Error) << "two of one name";
}

TEST_F(BodiesFile, ReadsMarkerPositions) {
  std::ofstream(file_) << "# in metres\nmarker_positions:\n  - x: 0.1\n    y: 0.0\n    z: 0.02\n"
                          "  - {x: 0.0, y: 0.05, z: 0}\n  - {x: -0.03, y: -0.1, z: 0}\n";
  const std::vector<Constellation> bodies = readBodies(file_);
  ASSERT_EQ(bodies.size(), 1u);
  EXPECT_EQ(bodies[0].name, name_);
  ASSERT_EQ(bodies[0].leds.size(), 3u);
  EXPECT_EQ(bodies[0].leds[0], Vector3d(0.1, 0.0, 0.02));
  EXPECT_EQ(bodies[0].leds[1], Vector3d(0.0, 0.05, 0.0));
}

TEST_F(BodiesFile, DamagedOnesAreRefusedByName) {
  const auto messageFor = [&](const std::string& content) {
    std::ofstream(file_) << content;
    return refusalOf([&] { readBodies(file_); });
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
  const std::string imu = "  - name: a\n    leds: []\n    imu: {translation: [0, 0, 0], topic: ";
  EXPECT_NE(messageFor(head + imu + "a, quaternion_xyzw: [0, 0, 0, 2]}\n").find("length 1"),
            std::string::npos);
  EXPECT_NE(messageFor(head + imu + "1imu, quaternion_xyzw: [0, 0, 0, 1]}\n").find("a topic"),
            std::string::npos);
  EXPECT_NE(messageFor(head + imu + "a b, quaternion_xyzw: [0, 0, 0, 1]}\n").find("a topic"),
            std::string::npos);
}

}  // namespace
}  // namespace wiimote_tracker::body
