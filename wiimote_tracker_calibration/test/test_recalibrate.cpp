// A camera that was moved or replaced, solved against the others from a waved LED.

#include "expect_says.h"
#include "refusal_of.h"
#include "split_rig.h"
#include "waved_led.h"

#include "recalibrate/recalibrate_camera.h"
#include "recalibrate/rig_cameras.h"

#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace wiimote_tracker::recalibrate {
namespace {

using square::normal;
using square::Random;
using square::uniform;

constexpr double kDegree = M_PI / 180.0;

Request record(WavedLed* led, const std::string& camera, double duration = 15.0) {
  Request request;
  request.camera = camera;
  led->runUntil(duration, [&](const capture::Image& image) { request.images.push_back(image); });
  return request;
}

/// The same camera after it was moved.
geometry::RigCamera knocked(const geometry::RigCamera& camera, Random& random) {
  geometry::RigCamera result = turned(camera, 3.0 * kDegree, random);
  const double x = normal(random, 1.0), y = normal(random, 1.0), z = normal(random, 1.0);
  result.camera.world_from_camera.translation() += 0.05 * Eigen::Vector3d(x, y, z).normalized();
  result.time_offset = uniform(random, -0.02, 0.02);
  return result;
}

/// Estimated less true pose and time offset, as RigCalibration.msg counts them.
Eigen::Matrix<double, 7, 1> errorOf(const geometry::RigCamera& estimate,
                                    const geometry::RigCamera& truth) {
  Eigen::Matrix<double, 7, 1> error;
  error << square::parameterDifference(estimate.camera, truth.camera).head<6>(),
      truth.time_offset - estimate.time_offset;
  return error;
}

Eigen::Matrix<double, 7, 7> covarianceOf(const geometry::Rig& rig, std::size_t camera) {
  const Eigen::Index first = geometry::firstParameter(camera);
  Eigen::Matrix<double, 7, 7> result;
  result.topLeftCorner<6, 6>() = rig.covariance.block<6, 6>(first, first);
  result.bottomLeftCorner<1, 6>() =
      rig.covariance.block<1, 6>(first + geometry::kTimeOffset, first);
  result.topRightCorner<6, 1>() = result.bottomLeftCorner<1, 6>().transpose();
  result(6, 6) = rig.covariance(first + geometry::kTimeOffset, first + geometry::kTimeOffset);
  return result;
}

std::string refusal(const geometry::Rig& rig, const Request& request, const Options& options = {}) {
  return refusalOf([&] { recalibrateCamera(rig, request, options); });
}

TEST(Recalibrate, FindsAMovedCamera) {
  Random random(1);
  const geometry::Rig rig = paperRigWith(wellCalibrated());
  auto truth = rig.cameras;
  truth[1] = knocked(truth[1], random);
  WavedLed led(truth, 11);
  Request request = record(&led, "camera_2");
  request.gravity = Eigen::Vector3d(0.0, -9.8, 0.1);
  const Recalibration result = recalibrateCamera(rig, request, {});
  const geometry::RigCamera& camera = result.rig.cameras[1];
  EXPECT_LT((camera.camera.center() - truth[1].camera.center()).norm(), 0.01);
  EXPECT_NEAR(camera.time_offset, truth[1].time_offset, 3e-4);
  EXPECT_NEAR(result.turned, 3.0 * kDegree, 0.1 * kDegree);
  EXPECT_NEAR(result.moved, 0.05, 0.01);
  EXPECT_GT(camera.inliers, 500u);
  EXPECT_SAYS(result.message, "camera_2 moved by");
  // Its own, of this moment.
  EXPECT_EQ(camera.gravity->z(), 0.1);
  EXPECT_EQ(camera.time_offset_epoch, 7u);
  EXPECT_EQ(camera.time_offset_rule, geometry::TimeOffsetRule::kOneEpoch);
  // The noise of its own pixels, 0.49 px, without that of the points that the others see.
  EXPECT_GT(camera.residual_px / std::sqrt(2.0), 0.40);
  EXPECT_LT(camera.residual_px / std::sqrt(2.0), 0.55);
  // The others are as they were.
  for (const std::size_t i : {0u, 2u, 3u}) {
    EXPECT_EQ(result.rig.cameras[i].camera.world_from_camera.matrix(),
              rig.cameras[i].camera.world_from_camera.matrix());
    const Eigen::Index k = geometry::firstParameter(i);
    EXPECT_EQ((result.rig.covariance.block<16, 16>(k, k)), (rig.covariance.block<16, 16>(k, k)));
  }
  EXPECT_NE(result.rig.id(), rig.id());
}

TEST(Recalibrate, FindsTheClockOfACameraThatReconnectsMeanwhile) {
  const geometry::Rig rig = paperRigWith(wellCalibrated());
  WavedLed led(rig.cameras, 13);
  Request request = record(&led, "camera_2", 11.0);
  led.truth[1].time_offset = -0.015;
  const Request rest = record(&led, "camera_2", 19.0);
  for (capture::Image image : rest.images) {
    image.clock_epoch += image.camera == "camera_2" ? 1 : 0;
    request.images.push_back(image);
  }
  const geometry::RigCamera camera = recalibrateCamera(rig, request, {}).rig.cameras[1];
  EXPECT_EQ(camera.time_offset_epoch, 8u);
  EXPECT_NEAR(camera.time_offset, -0.015, 5e-4);
  EXPECT_LT((camera.camera.center() - led.truth[1].camera.center()).norm(), 0.02);
}

TEST(Recalibrate, NamesEachCameraOnceInTheMethod) {
  geometry::Rig rig = paperRigWith(wellCalibrated());
  rig.method = "wave+recalibrated camera_22";
  WavedLed led(rig.cameras, 12);
  const Request request = record(&led, "camera_2");
  for (int i = 0; i < 2; ++i) {
    rig = recalibrateCamera(rig, request, {}).rig;
    EXPECT_EQ(rig.method, "wave+recalibrated camera_22+recalibrated camera_2");
  }
}

TEST(Recalibrate, AddsACamera) {
  const geometry::Rig five = paperRigWith(wellCalibrated(), 5);
  WavedLed led(five.cameras, 15);
  const Request request = record(&led, "camera_5");
  geometry::Rig rig = withoutCamera(five, "camera_5");
  rig.method = "wave";
  const Recalibration result = recalibrateCamera(rig, request, {});
  ASSERT_EQ(result.rig.cameras.size(), 5u);
  const geometry::RigCamera& camera = result.rig.cameras[4];
  EXPECT_EQ(camera.camera.name, "camera_5");
  EXPECT_LT((camera.camera.center() - five.cameras[4].camera.center()).norm(), 0.05);
  EXPECT_NEAR(camera.time_offset, five.cameras[4].time_offset, 3e-4);
  EXPECT_EQ(camera.time_offset_epoch, 7u);
  EXPECT_SAYS(result.message, "camera_5 was added; it is known to");
  EXPECT_EQ(result.moved, 0.0);
  EXPECT_EQ(result.rig.method, "wave+added camera_5");
  EXPECT_NE(result.rig.id(), rig.id());
  EXPECT_EQ(result.rig.covariance.topLeftCorner(64, 64), rig.covariance);
}

TEST(Recalibrate, RemovesACamera) {
  const geometry::Rig rig = paperRigWith(wellCalibrated());
  const geometry::Rig three = withoutCamera(rig, "camera_2");
  three.check();
  ASSERT_EQ(three.cameras.size(), 3u);
  EXPECT_EQ(three.cameras[1].camera.name, "camera_3");
  EXPECT_EQ(three.covariance.topLeftCorner(16, 16), rig.covariance.topLeftCorner(16, 16));
  EXPECT_EQ(three.covariance.topRightCorner(16, 32), rig.covariance.topRightCorner(16, 32));
  EXPECT_EQ(three.covariance.bottomRightCorner(32, 32), rig.covariance.bottomRightCorner(32, 32));
  EXPECT_SAYS(refusalOf([&] { withoutCamera(three, "camera_2"); }),
              "no camera 'camera_2': name one of camera_1, camera_3, camera_4");
  const geometry::Rig two = withoutCamera(three, "camera_1");
  EXPECT_SAYS(refusalOf([&] { withoutCamera(two, "camera_3"); }), "a rig needs two cameras");
}

TEST(Recalibrate, SaysWhichMasksMissTheirLamps) {
  geometry::Rig before = paperRigWith(wellCalibrated());
  before.cameras[1].masks = {{{500.0, 300.0}, 12.0}};
  geometry::Rig now = before;
  const auto turn = [](double pixels, geometry::RigCamera* camera) {
    camera->camera.world_from_camera.rotate(
        Eigen::AngleAxisd(pixels / camera->camera.intrinsics.fx, Eigen::Vector3d::UnitY()));
  };
  turn(100.0, &now.cameras[0]);
  turn(8.0, &now.cameras[1]);
  EXPECT_EQ(describeOldMasks(before, now), "");
  turn(8.0, &now.cameras[1]);
  EXPECT_EQ(describeOldMasks(before, now),
            "; the masks of camera_2 cover where lamps were before: switch the LED off, and learn "
            "the lights again");
  // It looks away from the lamp.
  now.cameras[1].camera.world_from_camera.rotate(Eigen::AngleAxisd(3.0, Eigen::Vector3d::UnitY()));
  EXPECT_SAYS(describeOldMasks(before, now), "the masks of camera_2");
  EXPECT_EQ(describeOldMasks(withoutCamera(before, "camera_2"), now), "") << "a new camera";
}

TEST(Recalibrate, SaysWhichCamerasSharedViewsOnlyThroughOne) {
  geometry::Rig rig = paperRigWith(wellCalibrated());
  for (const geometry::RigCamera& camera : rig.cameras)
    EXPECT_EQ(describeSplit(rig, camera.camera.name), "") << "all see the same volume";
  linkByTheSecond(&rig);
  EXPECT_SAYS(describeSplit(rig, "camera_2"),
              "camera_2 alone linked the views of camera_1 with those of camera_3, camera_4:");
  EXPECT_EQ(describeSplit(rig, "camera_3"), "");
  EXPECT_EQ(describeSplit(rig, "camera_1"), "") << "what is alone links nothing";
  // Another room, which never had a view in common.
  for (geometry::RigCamera camera : paperRigWith(wellCalibrated()).cameras) {
    camera.camera.name += "_far";
    camera.camera.world_from_camera.pretranslate(Eigen::Vector3d(50.0, 0.0, 0.0));
    rig.cameras.push_back(camera);
  }
  EXPECT_EQ(describeSplit(rig, "camera_1_far"), "");
}

// With right covariances the mean of the normalised squared error is 1, and 95 % are within the
// 95 % region.
TEST(ExtensiveRecalibrate, HasTheStatedUncertainty) {
  const int kTrials = 40;
  for (const std::string kind : {"knocked", "replaced", "added"}) {
    const bool has_rigs_lens = kind == "knocked";
    Random random(2);
    double pose = 0.0;
    double offset = 0.0;
    int covered = 0;
    RigErrors errors = wellCalibrated();
    errors.k2 = 0.02;  // not estimated
    const geometry::Rig rig = paperRigWith(errors);
    for (int trial = 0; trial < kTrials; ++trial) {
      auto truth = drawTruth(rig, random);
      const std::size_t index = static_cast<std::size_t>(trial) % 4;
      truth[index] = knocked(truth[index], random);
      Options options;
      Request start;
      if (!has_rigs_lens) {
        geometry::Intrinsics& lens = truth[index].camera.intrinsics;
        lens = start.intrinsics;
        const double scale = std::exp(normal(random, options.uncertainty.focal));
        const double aspect = std::exp(0.5 * normal(random, options.uncertainty.aspect));
        lens.fx *= scale * aspect;
        lens.fy *= scale / aspect;
        const double center = std::hypot(options.uncertainty.principal_point,
                                         options.uncertainty.shared_principal_point);
        lens.cx += normal(random, center);
        lens.cy += normal(random, center);
        lens.distortion[0] += normal(random, options.uncertainty.k1);
      }
      WavedLed led(truth, 1000 + static_cast<std::uint64_t>(trial));
      Request request = record(&led, truth[index].camera.name, 12.0);
      if (!has_rigs_lens)
        request.identity = "00:1e:35:ff:ff:ff";
      const bool added = kind == "added";
      const std::size_t place = added ? 3 : index;
      const Recalibration result =
          recalibrateCamera(added ? withoutCamera(rig, request.camera) : rig, request, options);
      const geometry::RigCamera& camera = result.rig.cameras[place];
      const auto error = errorOf(camera, truth[index]);
      const auto covariance = covarianceOf(result.rig, place);
      const double squared = geometry::squaredMahalanobis(error, covariance);
      pose += geometry::squaredMahalanobis(error.head<6>(), covariance.topLeftCorner<6, 6>());
      offset += error[6] * error[6] / covariance(6, 6);
      covered += squared <= 14.067;  // chi-squared, seven degrees of freedom, 95 %
      EXPECT_EQ(camera.camera.identity,
                has_rigs_lens ? rig.cameras[index].camera.identity : request.identity);
      const Eigen::Index k2 = geometry::firstParameter(place) + geometry::kDistortion + 1;
      EXPECT_DOUBLE_EQ(result.rig.covariance(k2, k2), has_rigs_lens ? rig.covariance(k2, k2) : 0.0);
      // Positive semidefinite.
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(result.rig.covariance);
      EXPECT_GT(eigen.eigenvalues().minCoeff(), -1e-9 * eigen.eigenvalues().maxCoeff());
    }
    RecordProperty(kind + "_pose", std::to_string(pose / (6.0 * kTrials)));
    RecordProperty(kind + "_offset", std::to_string(offset / kTrials));
    RecordProperty(kind + "_covered", covered);
    EXPECT_NEAR(pose / (6.0 * kTrials), 1.0, 0.3);
    // Slow errors of the stamps, which are allowed for, are not simulated here.
    EXPECT_LT(offset / kTrials, 1.3);
    EXPECT_GE(covered, kTrials * 88 / 100);
  }
}

TEST(Recalibrate, RefusesWithTheReason) {
  Random random(3);
  const geometry::Rig rig = paperRigWith(wellCalibrated());
  WavedLed waved(rig.cameras, 31);
  const Request good = record(&waved, "camera_2");
  EXPECT_EQ(refusal(rig, good), "not refused");

  Request request = good;
  request.camera = "camera_9";
  EXPECT_SAYS(refusal(rig, request), "camera_9 sends no images");

  geometry::Rig image_center = rig;
  image_center.ray_model = geometry::RayModel::kImageCenter;
  EXPECT_SAYS(refusal(image_center, good), "image centre");

  request = good;
  request.images.erase(std::remove_if(request.images.begin(), request.images.end(),
                                      [](const capture::Image& image) {
                                        return image.camera == "camera_3" ||
                                               image.camera == "camera_4";
                                      }),
                       request.images.end());
  EXPECT_SAYS(refusal(rig, request), "camera_1 alone");

  request = good;
  request.images.erase(
      std::remove_if(request.images.begin(), request.images.end(),
                     [](const capture::Image& image) { return image.camera == "camera_2"; }),
      request.images.end());
  EXPECT_SAYS(refusal(rig, request), "camera_2 sends no images");

  WavedLed brief(rig.cameras, 31);
  const Request short_wave = record(&brief, "camera_2", 1.2);
  EXPECT_SAYS(refusal(rig, short_wave), "wave longer");
  EXPECT_SAYS(refusal(rig, short_wave), "camera_2 sent ");

  WavedLed flat(rig.cameras, 32);
  flat.path.reach.z() = 0.0;
  EXPECT_SAYS(refusal(rig, record(&flat, "camera_2")), "on a line or in a plane");

  // It is knocked again while the LED is waved.
  WavedLed moved(rig.cameras, 33);
  request = record(&moved, "camera_2", 7.0);
  moved.truth[1] = knocked(moved.truth[1], random);
  const Request rest = record(&moved, "camera_2", 15.0);
  request.images.insert(request.images.end(), rest.images.begin(), rest.images.end());
  EXPECT_SAYS(refusal(rig, request), "fit to what the others saw");

  // As after a calibration by the square alone: no wave makes the others' clocks known.
  geometry::Rig unclocked = rig;
  for (geometry::RigCamera& camera : unclocked.cameras) {
    camera.time_offset = 0.0;
    camera.time_offset_rule = geometry::TimeOffsetRule::kNone;
  }
  WavedLed in_step(unclocked.cameras, 34);
  const char* const square_alone =
      "at most one of the other cameras has a known clock, as after a calibration by the square "
      "alone, so that camera_2 cannot be solved against them: calibrate all cameras again, with a "
      "waved LED";
  EXPECT_EQ(whyUnsolvable(unclocked, "camera_2", {}), square_alone);
  EXPECT_SAYS(refusal(withoutCamera(unclocked, "camera_2"), record(&in_step, "camera_2", 30.0)),
              square_alone);
  Options lenient;
  lenient.maximum_offset_stddev = 0.01;
  EXPECT_EQ(whyUnsolvable(unclocked, "camera_2", lenient), "");
  // As of a room that was joined: nobody knows before whether these see the LED.
  geometry::Rig joined = unclocked;
  for (const std::size_t i : {0, 2})
    joined.cameras[i].time_offset_rule = geometry::TimeOffsetRule::kAlways;
  EXPECT_EQ(whyUnsolvable(joined, "camera_2", {}), "");
  EXPECT_SAYS(refusal(joined, record(&in_step, "camera_2", 45.0)),
              "those of camera_4 are not known; calibrate all cameras again, with a waved LED");

  // As after new batteries: continuous calibration solves that clock alone.
  request = good;
  for (capture::Image& image : request.images)
    image.clock_epoch += image.camera == "camera_1" ? 1 : 0;
  EXPECT_SAYS(refusal(rig, request), "those of camera_1 are not known since a reconnection; move");
  EXPECT_SAYS(refusal(rig, request), "apply what is then proposed (A in calibrate)");
  EXPECT_SAYS(refusal(withoutCamera(rig, "camera_2"), request),
              "those of camera_1 are not known since a reconnection; move");

  Options options;
  options.maximum_offset_stddev = 1e-6;
  EXPECT_SAYS(refusal(rig, good, options), "time offset");
}

}  // namespace
}  // namespace wiimote_tracker::recalibrate
