#include "capture/camera_monitor.h"
#include "capture/corner_capture.h"
#include "capture/rest_gravity.h"

#include "expect_says.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace wiimote_tracker::capture {
namespace {

using State = CornerCapture::State;
using Source = std::function<Blobs(double)>;

constexpr double kPeriod = 0.01;  // [s]

Blobs one(double x, double y) {
  return {Eigen::Vector2d(x, y)};
}

Image image(const std::string& camera, double stamp, const Blobs& spots) {
  return {camera, stamp, 0, spots, {}};
}

/// Feeds cameras in turn at 100 Hz until the capture ends or the time is up.
void feed(CornerCapture* capture,
          const std::map<std::string, Source>& cameras,
          double from,
          double until) {
  for (double t = from; t < until && capture->state() == State::kCollecting; t += kPeriod) {
    for (const auto& camera : cameras)
      capture->add(image(camera.first, t, camera.second(t)));
    capture->update(t);
  }
}

Source still(double x, double y, unsigned seed, double noise = 0.3) {
  auto random = std::make_shared<std::mt19937>(seed);
  return [=](double) {
    std::normal_distribution<double> error(0.0, noise);
    return one(std::round(x + error(*random)), std::round(y + error(*random)));
  };
}

Source blind() {
  return [](double) { return Blobs(); };
}

const std::vector<std::string> kThree = {"a", "b", "c"};

TEST(CornerCapture, AStillLedIsCapturedByAllCamerasThatSeeIt) {
  CornerCapture capture(kThree, CornerCaptureOptions(), 0.0);
  feed(&capture, {{"a", still(100, 200, 1)}, {"b", still(500.5, 300, 2)}, {"c", still(9, 9, 3)}},
       0.0, 9.0);
  ASSERT_EQ(capture.state(), State::kDone);
  EXPECT_EQ(capture.progress(), 1.0);
  EXPECT_EQ(capture.message(), "captured by 3 of 3 cameras");
  const CapturedCorner corner = capture.result();
  ASSERT_EQ(corner.size(), 3U);
  EXPECT_NEAR(corner.at("b").pixel.x(), 500.5, 0.3);
  EXPECT_NEAR(corner.at("a").pixel.y(), 200.0, 0.3);
  EXPECT_GE(corner.at("a").samples, 50U);
  EXPECT_LT(corner.at("a").spread, 1.0);
  EXPECT_GT(corner.at("a").spread, 0.0);
}

TEST(CornerCapture, MeanAndSpreadAreThoseOfTheSamples) {
  CornerCaptureOptions options;
  options.minimum_cameras = 1;
  CornerCapture capture({"a"}, options, 0.0);
  for (int i = 0; i < 50; ++i)
    capture.add(image("a", i * kPeriod, one(10.0 + i % 2, 20.0)));
  ASSERT_EQ(capture.state(), State::kDone);
  EXPECT_NEAR(capture.result().at("a").pixel.x(), 10.5, 1e-12);
  EXPECT_NEAR(capture.result().at("a").pixel.y(), 20.0, 1e-12);
  EXPECT_NEAR(capture.result().at("a").spread, std::sqrt(0.25 * 50.0 / 49.0), 1e-12);
  EXPECT_EQ(capture.result().at("a").samples, 50U);
}

TEST(CornerCapture, ABlindCameraIsLeftOutAndNamed) {
  CornerCapture capture(kThree, CornerCaptureOptions(), 0.0);
  feed(&capture, {{"a", still(100, 200, 1)}, {"b", still(500, 300, 2)}, {"c", blind()}}, 0.0, 9.0);
  ASSERT_EQ(capture.state(), State::kDone);
  EXPECT_EQ(capture.result().count("c"), 0U);
  EXPECT_SAYS(capture.message(), "2 of 3 cameras");
  EXPECT_SAYS(capture.message(), "c sees no spot");
}

TEST(CornerCapture, ACameraWithTwoSpotsIsLeftOutAndNamed) {
  CornerCapture capture(kThree, CornerCaptureOptions(), 0.0);
  const Source two = [](double) { return Blobs{Eigen::Vector2d(5, 5), Eigen::Vector2d(800, 90)}; };
  feed(&capture, {{"a", still(100, 200, 1)}, {"b", two}, {"c", still(3, 3, 3)}}, 0.0, 9.0);
  ASSERT_EQ(capture.state(), State::kDone);
  EXPECT_EQ(capture.result().count("b"), 0U);
  EXPECT_SAYS(capture.message(), "b sees 2 spots");
}

TEST(CornerCapture, WaitsForASlowerCamera) {
  CornerCapture capture({"a", "b"}, CornerCaptureOptions(), 0.0);
  const Source fast = still(100, 200, 1);
  const Source slow = still(300, 200, 2);
  for (int i = 0; i < 400 && capture.state() == State::kCollecting; ++i) {
    capture.add(image("a", i * kPeriod, fast(0.0)));
    if (i % 5 == 0)
      capture.add(image("b", i * kPeriod, slow(0.0)));
  }
  ASSERT_EQ(capture.state(), State::kDone);
  EXPECT_EQ(capture.result().size(), 2U);
  EXPECT_EQ(capture.result().at("a").samples, 50U);
}

TEST(CornerCapture, WaitsForACameraWhoseFirstImageIsLate) {
  CornerCaptureOptions options;
  options.minimum_samples = 20;
  CornerCapture capture(kThree, options, 0.0);
  for (int i = 0; i < 400 && capture.state() == State::kCollecting; ++i) {
    for (const std::string camera : {"a", "b"})
      capture.add(image(camera, i * kPeriod, one(10, 10)));
    if (i * kPeriod >= 0.4)
      capture.add(image("c", i * kPeriod, one(10, 10)));
  }
  EXPECT_EQ(capture.message(), "captured by 3 of 3 cameras");
}

TEST(CornerCapture, AMovedLedIsRefused) {
  CornerCapture capture({"a", "b"}, CornerCaptureOptions(), 0.0);
  const Source jump = [](double t) { return t < 0.3 ? one(100, 100) : one(120, 100); };
  feed(&capture, {{"a", jump}, {"b", still(300, 200, 2)}}, 0.0, 9.0);
  ASSERT_EQ(capture.state(), State::kRefused);
  EXPECT_SAYS(capture.message(), "a: the LED moved");
  EXPECT_SAYS(capture.message(), "keep the LED still");
  EXPECT_LT(capture.progress(), 1.0);
}

TEST(CornerCapture, ASpreadJustOverTheLimitIsToldFromIt) {
  CornerCapture capture({"a", "b"}, CornerCaptureOptions(), 0.0);
  // Ten spots, each 1.426 px beside their mean: spread 1.426 sqrt(10 / 9) = 1.503 px.
  double side = 1.426;
  const Source shaken = [&side](double) { return one(100.0 + (side = -side), 100.0); };
  feed(&capture, {{"a", shaken}, {"b", still(300, 200, 2)}}, 0.0, 9.0);
  ASSERT_EQ(capture.state(), State::kRefused);
  EXPECT_SAYS(capture.message(), "spread over 1.503 px, at most 1.500 px are allowed");
}

TEST(CornerCapture, ASlowDriftWithinTheSpreadIsRefused) {
  CornerCaptureOptions options;
  CornerCapture capture({"a", "b"}, options, 0.0);
  // 4 px/s: two pixels within the fifty samples, spread 0.6 px.
  const Source drift = [](double t) { return one(100 + 4.0 * t, 100); };
  feed(&capture, {{"a", drift}, {"b", still(300, 200, 2)}}, 0.0, 9.0);
  ASSERT_EQ(capture.state(), State::kRefused);
  EXPECT_SAYS(capture.message(), "a: the LED moved slowly");
}

TEST(CornerCapture, NoiseOfAStillLedIsHardlyEverTakenForMotion) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    CornerCapture capture({"a", "b"}, CornerCaptureOptions(), 0.0);
    feed(&capture,
         {{"a", still(100, 200, 2 * seed, 0.5)}, {"b", still(300, 200, 2 * seed + 1, 0.5)}}, 0.0,
         9.0);
    EXPECT_EQ(capture.state(), State::kDone) << capture.message();
  }
}

TEST(CornerCapture, TooFewSamplesUntilTheTimeIsUpAreRefusedWithTheReason) {
  CornerCaptureOptions options;
  options.timeout = 2.0;
  CornerCapture capture({"a", "b", "c"}, options, 10.0);
  for (int i = 0; i < 30; ++i)
    capture.add(image("a", 10.0 + i * kPeriod, one(10, 10)));
  capture.add(image("b", 10.1, Blobs()));
  EXPECT_EQ(capture.update(11.99), State::kCollecting);
  EXPECT_SAYS(capture.problem("a"), "has 30 of 50 samples");
  EXPECT_SAYS(capture.problem("b"), "sees no spot");
  EXPECT_SAYS(capture.problem("c"), "sends no images");
  EXPECT_EQ(capture.update(12.0), State::kRefused);
  EXPECT_SAYS(capture.message(), "0 of at least 2 cameras");
  EXPECT_SAYS(capture.message(), "c sends no images");
}

TEST(CornerCapture, CamerasWithTheSameProblemAreNamedTogether) {
  CornerCapture capture(kThree, CornerCaptureOptions(), 0.0);
  feed(&capture, {{"a", blind()}, {"b", still(500, 300, 2)}, {"c", blind()}}, 0.0, 2.0);
  EXPECT_SAYS(capture.message(), "waits for: each of a, c sees no spot: turn the camera");
  EXPECT_EQ(listOfProblems({{"a", "x"}, {"b", "y"}, {"c", "x"}}), "each of a, c x; b y");
}

TEST(CornerCapture, ACameraThatSeesTheLedNowAndThenDelaysTheOthersOnlyUntilTheTimeIsUp) {
  CornerCaptureOptions options;
  options.timeout = 2.0;
  CornerCapture capture(kThree, options, 0.0);
  // Each 0.4 s.
  const Source rare = [](double t) {
    return std::fmod(t + 0.5 * kPeriod, 0.4) < kPeriod ? one(9, 9) : Blobs();
  };
  const std::map<std::string, Source> cameras = {
      {"a", still(100, 200, 1)}, {"b", still(500, 300, 2)}, {"c", rare}};
  feed(&capture, cameras, 0.0, 1.9);
  EXPECT_EQ(capture.state(), State::kCollecting);
  feed(&capture, cameras, 1.9, 2.1);
  ASSERT_EQ(capture.state(), State::kDone) << capture.message();
  EXPECT_SAYS(capture.message(), "captured by 2 of 3 cameras; left out: c ");
}

TEST(CornerCapture, SilenceBeforeTheFirstImageIsNoProblem) {
  CornerCapture capture({"a", "b"}, CornerCaptureOptions(), 10.0);
  capture.update(10.0);
  EXPECT_SAYS(capture.problem("a"), "has 0 of 50 samples");
  capture.add(image("a", 10.3, one(10, 10)));
  EXPECT_SAYS(capture.problem("a"), "has 1 of 50 samples");
  EXPECT_SAYS(capture.problem("b"), "has 0 of 50 samples");
  capture.update(10.6);
  EXPECT_SAYS(capture.problem("b"), "sends no images");
}

TEST(CornerCapture, NamesAClockThatIsBehind) {
  CornerCapture capture(kThree, CornerCaptureOptions(), 10.0);
  const Source sees = still(100, 200, 1);
  for (double t = 10.0; t < 15.0 && capture.state() == State::kCollecting; t += kPeriod) {
    capture.add(image("a", t, sees(t)));
    capture.add(image("b", t, sees(t)));
    capture.add(image("c", t - 7.0, sees(t)));
  }
  ASSERT_EQ(capture.state(), State::kDone);
  EXPECT_SAYS(capture.message(),
              "c sends images that are 7.0 s old by their stamps: set the clock");
}

TEST(CornerCapture, ACameraWhoseClockIsAheadOfTheTimeOutIsLeftOutAndNamed) {
  CornerCapture capture(kThree, CornerCaptureOptions(), 10.0);
  const Source sees = still(100, 200, 1);
  for (double t = 10.0; t < 15.0 && capture.state() == State::kCollecting; t += kPeriod) {
    capture.add(image("c", t + 3600.0, sees(t)));
    capture.add(image("a", t, sees(t)));
    capture.add(image("b", t, sees(t)));
  }
  ASSERT_EQ(capture.state(), State::kDone) << capture.message();
  EXPECT_SAYS(capture.message(), "captured by 2 of 3 cameras");
  EXPECT_SAYS(capture.message(), "c sends images that are 3600.0 s ahead of the time");
}

TEST(CornerCapture, OneCameraIsNotEnough) {
  CornerCaptureOptions options;
  options.timeout = 1.0;
  CornerCapture capture({"a", "b"}, options, 0.0);
  feed(&capture, {{"a", still(100, 200, 1)}, {"b", blind()}}, 0.0, 1.5);
  ASSERT_EQ(capture.state(), State::kRefused);
  EXPECT_SAYS(capture.message(), "1 of at least 2 cameras");
}

TEST(CornerCapture, ProgressIsThatOfTheSlowestCameraThatSeesTheLed) {
  CornerCapture capture(kThree, CornerCaptureOptions(), 0.0);
  EXPECT_EQ(capture.progress(), 0.0);
  for (int i = 0; i < 20; ++i) {
    capture.add(image("a", i * kPeriod, one(10, 10)));
    if (i % 2 == 0)
      capture.add(image("b", i * kPeriod, one(10, 10)));
    capture.add(image("c", i * kPeriod, Blobs()));
  }
  EXPECT_DOUBLE_EQ(capture.progress(), 0.2);
}

TEST(CornerCapture, ImagesBeforeTheStartAndOfOtherCamerasAreIgnored) {
  CornerCapture capture({"a", "b"}, CornerCaptureOptions(), 5.0);
  for (int i = 0; i < 100; ++i) {
    capture.add(image("a", 4.0, one(10, 10)));
    capture.add(image("x", 5.0 + i * kPeriod, one(10, 10)));
  }
  EXPECT_EQ(capture.spot("a").samples(), 0U);
  EXPECT_EQ(capture.state(), State::kCollecting);
}

TEST(CameraMonitor, RateAndSpotOfACameraThatSeesTheLed) {
  CameraMonitor monitor;
  EXPECT_FALSE(monitor.summary(0.0).connected);
  EXPECT_SAYS(monitor.summary(0.0).problem, "sends no images");
  for (int i = 0; i <= 300; ++i)
    monitor.add(i * kPeriod, one(i, 7), i * kPeriod);
  const CameraSummary summary = monitor.summary(3.0);
  EXPECT_TRUE(summary.connected);
  EXPECT_TRUE(summary.sees_led);
  EXPECT_NEAR(summary.rate, 100.0, 1e-6);
  EXPECT_EQ(summary.pixel, Eigen::Vector2d(300, 7));
  EXPECT_EQ(summary.problem, "");
  EXPECT_FALSE(monitor.summary(4.5).connected);  // the images stopped
  EXPECT_TRUE(monitor.summary(4.5, 2.0).connected);
  monitor.add(3.01, {}, 3.01);
  EXPECT_FALSE(monitor.summary(3.01).sees_led);
}

TEST(CameraMonitor, SaysWhatIsWrong) {
  CameraMonitor two;
  two.add(0.0, {Eigen::Vector2d(1, 1), Eigen::Vector2d(2, 2)}, 0.0);
  EXPECT_EQ(two.summary(0.0).blobs, 2U);
  EXPECT_SAYS(two.summary(0.0).problem, "sees 2 spots");
  CameraMonitor none;
  none.add(0.0, {}, 0.0);
  EXPECT_SAYS(none.summary(0.0).problem, "sees no spot");
  CameraMonitor flicker;
  for (int i = 0; i < 50; ++i)
    flicker.add(i * kPeriod, i % 2 == 0 ? Blobs() : one(1, 1), i * kPeriod);
  EXPECT_FALSE(flicker.summary(0.5).sees_led);
  EXPECT_SAYS(flicker.summary(0.5).problem, "50 % of its images only");
  EXPECT_TRUE(std::isnan(flicker.summary(0.5).pixel.x()));
}

TEST(CameraMonitor, NamesMissingStamps) {
  CameraMonitor monitor;
  monitor.add(0.0, {{100.0, 100.0}}, 1.7e9);
  EXPECT_SAYS(monitor.summary(1.7e9).problem, "without stamps");
}

TEST(CameraMonitor, NamesAClockThatIsBehind) {
  CameraMonitor monitor;
  for (int i = 0; i <= 50; ++i)
    monitor.add(i * kPeriod, one(1, 1), i * kPeriod + 7.0);
  EXPECT_SAYS(monitor.summary(7.6).problem, "7.0 s old by their stamps");
  EXPECT_SAYS(monitor.summary(20.0).problem, "sends no images");
}

TEST(CameraMonitor, ForgetsWhatAShortBagShowedBeforeItStartedOver) {
  CameraMonitor monitor;
  for (int i = 0; i <= 300; ++i)
    monitor.add(i * kPeriod, one(1, 1), i * kPeriod);
  monitor.add(0.5, one(1, 1), 0.5);
  EXPECT_TRUE(monitor.summary(1.0).connected);
  EXPECT_FALSE(monitor.summary(2.0).connected) << "the images stopped";
}

TEST(Image, SpotsOutsideOfItAreRemoved) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  Blobs spots = {{nan, 1.0},    {1.0, nan},   {5.0, 7.0},   {1000.0, 760.0}, {infinity, 1.0},
                 {1100.0, 1.0}, {-50.0, 1.0}, {1.0, 800.0}, {1.0, -50.0}};
  removeImpossible(1024.0, 768.0, &spots);
  EXPECT_EQ(spots, (Blobs{{5.0, 7.0}, {1000.0, 760.0}}));
}

TEST(RestGravity, MeanOfACameraAtRestOnly) {
  RestGravity rest;
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(rest.mean());
    rest.add(Eigen::Vector3d(0.1 * (i % 2), -9.8, 1.0));
  }
  ASSERT_TRUE(rest.mean());
  EXPECT_LT((*rest.mean() - Eigen::Vector3d(0.05, -9.8, 1.0)).norm(), 1e-12);

  RestGravity shaken;
  for (int i = 0; i < 100; ++i)
    shaken.add(Eigen::Vector3d(3.0 * std::sin(0.7 * i), -9.8, 0.0));
  EXPECT_FALSE(shaken.mean());

  RestGravity falling;
  for (int i = 0; i < 100; ++i)
    falling.add(Eigen::Vector3d(0.0, -4.0, 0.0));
  EXPECT_FALSE(falling.mean());

  rest.add(Eigen::Vector3d::Constant(std::nan("")));
  EXPECT_TRUE(rest.mean());
}

TEST(CornerCapture, ACameraThatSeesMaskedLightsOnlySaysSo) {
  CornerCapture capture(kThree, CornerCaptureOptions(), 0.0);
  Image behind = image("a", 0.01, {});
  behind.masked = one(10, 10);
  capture.add(behind);
  EXPECT_SAYS(capture.problem("a"), "sees only masked lights");
  capture.add(image("a", 0.02, {}));
  EXPECT_SAYS(capture.problem("a"), "sees no spot");
}

TEST(CornerCapture, WhatIsCapturedDoesNotDependOnTheTimeThatOthersTake) {
  std::vector<CapturedCorner> results;
  for (const double lag : {0.0, 0.25}) {
    CornerCapture capture({"a", "b"}, CornerCaptureOptions(), 0.0);
    const Source a = still(100, 200, 4);
    for (int i = 0; i < 200 && capture.state() == State::kCollecting; ++i) {
      capture.add(image("a", i * kPeriod, a(0.0)));
      if (i * kPeriod >= lag)
        capture.add(image("b", i * kPeriod, one(50, 50)));
    }
    ASSERT_EQ(capture.state(), State::kDone);
    results.push_back(capture.result());
  }
  EXPECT_EQ(results[0].at("a").pixel, results[1].at("a").pixel);
  EXPECT_EQ(results[0].at("a").samples, 50U);
}

}  // namespace
}  // namespace wiimote_tracker::capture
