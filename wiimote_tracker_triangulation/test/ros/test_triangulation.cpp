// The running node or nodelet: a rig, blobs and triggers in; points, TF, markers and events out.
// More than 400 lines, because each test continues where the one before ended.
#include "ros/camera_info.h"
#include "ros/triangulation_bench.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <gtest/gtest.h>
#include <sensor_msgs/CameraInfo.h>
#include <tf2_ros/transform_listener.h>
#include <wiimote_tracker_msgs/SetLabel.h>
#include <boost/algorithm/string/predicate.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker {
namespace {

using Eigen::Vector3d;
using geometry::Rig;
using wiimote_tracker_msgs::IrBlobArray;
using wiimote_tracker_msgs::TrackedPoint;
using wiimote_tracker_msgs::TrackedPointArray;

// Bound on errors with exact pixels, which come from the motion model on a circle [m].
constexpr double kNear = 2e-3;

// Outputs in 0.2 s for any order of arrival: one per image of the newest camera, less the last.
constexpr std::size_t kFewest = 19;

std::unique_ptr<Bench> g_bench;

void expectOnPath(const TrackedPointArray& array, std::size_t rays) {
  ASSERT_EQ(1u, array.points.size());
  const TrackedPoint& point = array.points[0];
  EXPECT_EQ("led", point.label);
  EXPECT_EQ(TrackedPoint::TRACKED, point.state);
  EXPECT_LT((vectorOf(point.position) - ledAt(array.header.stamp.toSec())).norm(), kNear);
  EXPECT_EQ(rays, point.rays_used);
  EXPECT_EQ(rays, point.cameras.size());
  EXPECT_LT(point.residual, 0.5);
}

TEST(Triangulation, AdvisesWithoutARig) {
  EXPECT_TRUE(g_bench->waitForLog("run  rosrun wiimote_tracker_calibration calibrate"));
  ASSERT_TRUE(Bench::waitFor([] { return !g_bench->markers_.empty(); }));
  ASSERT_EQ(1u, g_bench->markers_.back().markers.size());
  EXPECT_EQ("Not calibrated: open Calibrate", g_bench->markers_.back().markers[0].text);
}

TEST(Triangulation, RefusesABadRigWithOneSentence) {
  auto bad = toMessage(g_bench->rig_);
  bad.format_version = 99;
  g_bench->rig_publisher_.publish(bad);
  EXPECT_TRUE(g_bench->waitForLog("is refused: the rig calibration has format version 99"));
}

TEST(Triangulation, TracksWithAGoodRig) {
  g_bench->rig_publisher_.publish(toMessage(g_bench->rig_));
  ASSERT_TRUE(g_bench->waitForSubscriptions());
  ASSERT_TRUE(g_bench->film(1.0, {0, 1, 2}));
  const auto arrays = g_bench->arraysSince(1000.3);
  ASSERT_GT(arrays.size(), 60u);  // at least those of the camera whose images are the newest
  for (std::size_t i = 0; i < arrays.size(); ++i) {
    expectOnPath(arrays[i], 3);
    EXPECT_EQ("world", arrays[i].header.frame_id);
    EXPECT_EQ(g_bench->rig_.id(), arrays[i].rig_id);
    EXPECT_EQ("track", arrays[i].method);
    EXPECT_GT(arrays[i].latest_arrival, arrays[i].header.stamp);
    if (i > 0) {
      EXPECT_GT(arrays[i].header.stamp, arrays[i - 1].header.stamp);
    }
  }
}

TEST(Triangulation, PublishesThePointAlone) {
  ASSERT_TRUE(g_bench->waitFor([] {
    return !g_bench->points_.empty() &&
           g_bench->points_.back().header.stamp == g_bench->arrays_.back().header.stamp;
  }));
  const geometry_msgs::PointStamped& point = g_bench->points_.back();
  EXPECT_EQ("world", point.header.frame_id);
  EXPECT_EQ(g_bench->arrays_.back().points.at(0).position, point.point);
}

TEST(Triangulation, PublishesTheTransform) {
  tf2_ros::Buffer buffer(ros::Duration(1000.0));
  tf2_ros::TransformListener listener(buffer, g_bench->nh_);
  // Publishes until the listener is connected.
  ASSERT_TRUE(Bench::waitFor([&] {
    return g_bench->film(kBatch, {0, 1, 2}) && buffer.canTransform("world", "led", ros::Time(0));
  }));
  const auto transform = buffer.lookupTransform("world", "led", ros::Time(0));
  const Vector3d place = vectorOf(transform.transform.translation);
  EXPECT_LT((place - ledAt(transform.header.stamp.toSec())).norm(), kNear);
}

/// tf2 warns about a stamp that it has had before.
TEST(Triangulation, SendsATransformOncePerStamp) {
  std::set<std::pair<std::string, ros::Time>> stamps;
  ASSERT_GT(g_bench->transforms_.size(), 50u);
  for (const auto& transform : g_bench->transforms_)
    EXPECT_TRUE(stamps.insert({transform.child_frame_id, transform.header.stamp}).second)
        << transform.child_frame_id << " " << transform.header.stamp;
}

TEST(Triangulation, GivesPointsAtAFixedRate) {
  const auto arrives = [] {
    return !g_bench->steady_arrays_.empty() &&
           g_bench->steady_arrays_.back().header.stamp.toSec() > g_bench->now_ - 0.1;
  };
  ASSERT_TRUE(Bench::waitFor(arrives));
  const auto& arrays = g_bench->steady_arrays_;
  const std::size_t before = arrays.size();
  // Batch by batch: images that wait too long would be too late.
  for (int batch = 0; batch < 50; ++batch) {
    ASSERT_TRUE(g_bench->film(kBatch, {0, 1, 2}));
    ASSERT_TRUE(Bench::waitFor(arrives));
  }
  int found = 0;
  for (std::size_t i = before; i < arrays.size(); ++i) {
    const double tick = 20.0 * arrays[i].header.stamp.toSec();
    EXPECT_NEAR(std::round(tick), tick, 1e-4);
    found += arrays[i].points.size() == 1 && arrays[i].points[0].label == "steady_led";
  }
  EXPECT_GT(found, 5);
}

TEST(Triangulation, PublishesMarkers) {
  ASSERT_TRUE(g_bench->film(0.2, {0, 1, 2}));
  // Without those before the rig: one a second of real time, for as long as the tests needed.
  const auto count = [] {
    return std::count_if(g_bench->markers_.begin(), g_bench->markers_.end(),
                         [](const auto& array) { return array.markers.size() > 1; });
  };
  ASSERT_TRUE(Bench::waitFor([&] { return count() > 2; }));
  std::set<std::string> kinds;
  for (const auto& marker : g_bench->markers_.back().markers)
    kinds.insert(marker.ns);
  EXPECT_EQ(
      (std::set<std::string>{"blob", "camera", "covariance", "frustum", "height", "housing",
                             "image_plane", "label", "mask", "point", "ray", "shadow", "trail"}),
      kinds);
  // Throttled: 20 per second of the images' time.
  EXPECT_LT(static_cast<double>(count()), 21.0 * (g_bench->now_ - 1000.0) + 1.0);
}

/// Films until a status of the tracker matches.
bool reports(const std::function<bool(const diagnostic_msgs::DiagnosticStatus&)>& matches) {
  g_bench->diagnostics_.clear();
  return Bench::waitFor([&] {
    return g_bench->film(kBatch, {0, 1, 2}) &&
           std::any_of(g_bench->diagnostics_.begin(), g_bench->diagnostics_.end(),
                       [&](const auto& status) {
                         return status.name.find("steady") == std::string::npos && matches(status);
                       });
  });
}

/// The first part of its name is the process, that is a nodelet's manager.
bool isOf(const std::string& camera, const diagnostic_msgs::DiagnosticStatus& status) {
  return boost::algorithm::ends_with(status.name, ": " + camera);
}

bool warns(const std::string& camera, const std::string& words) {
  return reports([&](const diagnostic_msgs::DiagnosticStatus& status) {
    return isOf(camera, status) && status.level == diagnostic_msgs::DiagnosticStatus::WARN &&
           status.message.find(words) != std::string::npos;
  });
}

bool isWell(const std::string& camera) {
  return reports([&](const diagnostic_msgs::DiagnosticStatus& status) {
    return isOf(camera, status) && status.message == "in use";
  });
}

std::string valueOf(const diagnostic_msgs::DiagnosticStatus& status, const std::string& key) {
  for (const auto& value : status.values) {
    if (value.key == key)
      return value.value;
  }
  return "";
}

TEST(Triangulation, ReportsDiagnosticsOfAllAndOfEachCamera) {
  EXPECT_TRUE(reports([](const diagnostic_msgs::DiagnosticStatus& status) {
    return status.message == "tracking" && status.hardware_id == "rig " + g_bench->rig_.id() &&
           valueOf(status, "LEDs tracked") == "1";
  }));
  EXPECT_TRUE(reports([](const diagnostic_msgs::DiagnosticStatus& status) {
    return isOf("camera_1", status) && status.message == "in use" &&
           valueOf(status, "spots that belong to an LED [%]") == "100.0" &&
           std::atof(valueOf(status, "residual [px]").c_str()) < 0.5;
  }));
}

TEST(Triangulation, PointsToTheDriverOfASilentCamera) {
  g_bench->diagnostics_.clear();
  EXPECT_TRUE(Bench::waitFor([] {
    return g_bench->film(kBatch, {0, 1}) &&
           std::any_of(g_bench->diagnostics_.begin(), g_bench->diagnostics_.end(),
                       [](const auto& status) {
                         return isOf("camera_2", status) &&
                                status.message.find(
                                    "no images: start its driver, or do what that "
                                    "says in /diagnostics") == 0;
                       });
  }));
  EXPECT_TRUE(isWell("camera_2"));
}

TEST(Triangulation, IgnoresAndReportsACameraThatIsAnotherDevice) {
  std::string& identity = g_bench->rig_.cameras[1].camera.identity;  // of the images to come
  const std::string calibrated = identity;
  identity = "00:00:00:00:00:99";
  EXPECT_TRUE(warns("camera_1",
                    "camera_1 is device 00:00:00:00:00:99, but was calibrated as " + calibrated));
  EXPECT_TRUE(reports([](const diagnostic_msgs::DiagnosticStatus& status) {
    return isOf("camera_1", status) && valueOf(status, "images [Hz]") == "0.0" &&
           status.message.find("camera_1 is device") == 0;  // not that there are no images
  }));
  const double begin = g_bench->now_;
  ASSERT_TRUE(g_bench->film(0.3, {0, 1, 2}));
  const auto arrays = g_bench->arraysSince(begin + 0.2);
  EXPECT_FALSE(arrays.empty());
  for (const auto& array : arrays)
    expectOnPath(array, 2);
  identity = calibrated;
  EXPECT_TRUE(isWell("camera_1"));
}

TEST(Triangulation, NamesImpossibleSpotsOnce) {
  IrBlobArray image = g_bench->image(2, g_bench->now_);
  ASSERT_FALSE(image.blobs.empty());
  image.blobs[0].x = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 3; ++i)
    g_bench->blob_publishers_[2].publish(image);
  const std::string words = "camera_2 reports spots outside its image";
  EXPECT_TRUE(warns("camera_2", words));
  EXPECT_TRUE(isWell("camera_2"));
  ASSERT_TRUE(g_bench->waitForLog(words));
}

TEST(Triangulation, NamesALensThatContradictsTheRig) {
  ros::Publisher publisher =
      g_bench->nh_.advertise<sensor_msgs::CameraInfo>("camera_0/camera_info", 1, true);
  const sensor_msgs::CameraInfo right = infoOf(g_bench->rig_.cameras[0].camera.intrinsics);
  sensor_msgs::CameraInfo wrong = right;
  wrong.K[0] += 50.0;
  publisher.publish(wrong);
  EXPECT_TRUE(warns("camera_0", "camera_info of camera_0 contradicts the rig"));
  publisher.publish(right);
  EXPECT_TRUE(isWell("camera_0"));
}

TEST(Triangulation, NamesACameraWhoseComputerHasAnotherClock) {
  g_bench->arrival_error_ = 0.5;
  EXPECT_TRUE(warns("camera_1", "run chrony on all computers"));
  g_bench->arrival_error_ = 0.0;
  EXPECT_TRUE(isWell("camera_1"));
}

TEST(Triangulation, GoesOnWhenOneCameraStopsAndWhenItComesBack) {
  ASSERT_TRUE(g_bench->film(0.6, {1, 2}));
  auto arrays = g_bench->arraysSince(g_bench->now_ - 0.2);
  EXPECT_FALSE(arrays.empty());
  for (const auto& array : arrays)
    expectOnPath(array, 2);
  ASSERT_TRUE(g_bench->film(0.4, {0, 1, 2}));
  arrays = g_bench->arraysSince(g_bench->now_ - 0.2);
  EXPECT_GE(arrays.size(), kFewest);
  for (const auto& array : arrays)
    expectOnPath(array, 3);
}

TEST(Triangulation, ReportsWhenNothingIsSeen) {
  const double begin = g_bench->now_;
  g_bench->leds_.clear();
  ASSERT_TRUE(g_bench->film(3.0, {0, 1, 2}));
  g_bench->leds_ = {ledAt};
  std::set<int> states;
  int lost = 0;
  for (const auto& array : g_bench->arraysSince(begin)) {
    for (const TrackedPoint& point : array.points) {
      states.insert(point.state);
      lost += point.state == TrackedPoint::LOST;
    }
  }
  EXPECT_EQ(1u, states.count(TrackedPoint::PREDICTED));
  EXPECT_EQ(1, lost);
  EXPECT_TRUE(g_bench->arrays_.back().points.empty());
  // A little while it still counts as seen; then nothing that is not measured goes out by itself.
  for (const auto& point : g_bench->points_)
    EXPECT_LT(point.header.stamp.toSec(), begin + 0.06);
}

TEST(Triangulation, PublishesSeveralLedsUnderTheirLabels) {
  g_bench->leds_ = {ledAt, otherLedAt};
  const double begin = g_bench->now_;
  ASSERT_TRUE(g_bench->film(0.6, {0, 1, 2}));
  ASSERT_TRUE(Bench::waitFor([] { return !g_bench->second_points_.empty(); }));
  const TrackedPointArray& last = g_bench->arrays_.back();
  ASSERT_EQ(2u, last.points.size());
  std::map<std::string, Vector3d> places;
  for (const TrackedPoint& point : last.points)
    places[point.label] = vectorOf(point.position);
  ASSERT_EQ(1u, places.count("led"));
  ASSERT_EQ(1u, places.count("second"));
  const double height = places["led"].z();
  EXPECT_NEAR(0.4, std::abs(places["second"].z() - height), 2.0 * kNear);
  for (const auto& point : g_bench->points_) {
    if (point.header.stamp.toSec() > begin) {
      EXPECT_NEAR(height, point.point.z, kNear);
    }
  }
  wiimote_tracker_msgs::SetLabel set;
  set.request.label = "second";
  set.request.right_label = "third";
  ASSERT_TRUE(ros::service::call("set_label", set));
  EXPECT_FALSE(set.response.success);
  set.request.right_label = "second";
  ASSERT_TRUE(ros::service::call("set_label", set));
  EXPECT_TRUE(set.response.success) << set.response.message;
  ASSERT_TRUE(g_bench->film(0.1, {0, 1, 2}));
  for (const TrackedPoint& point : g_bench->arrays_.back().points)
    EXPECT_EQ(point.label == "second", point.label_confidence == 1.0) << point.label;
  // Both leave; the next one alone is the first again.
  g_bench->leds_.clear();
  ASSERT_TRUE(g_bench->film(3.0, {0, 1, 2}));
  g_bench->leds_ = {ledAt};
  ASSERT_TRUE(g_bench->film(0.6, {0, 1, 2}));
  ASSERT_EQ(1u, g_bench->arrays_.back().points.size());
  EXPECT_EQ("led", g_bench->arrays_.back().points[0].label);
}

TEST(Triangulation, AnswersATrigger) {
  std_msgs::Header trigger;
  trigger.stamp.fromSec(g_bench->now_ + 0.123);
  g_bench->trigger_publisher_.publish(trigger);
  ASSERT_TRUE(g_bench->film(0.3, {0, 1, 2}));
  ASSERT_TRUE(Bench::waitFor([] { return !g_bench->triggered_.empty(); }));
  const TrackedPointArray& answer = g_bench->triggered_.back();
  EXPECT_EQ(trigger.stamp, answer.header.stamp);
  ASSERT_EQ(1u, answer.points.size());
  EXPECT_LT((vectorOf(answer.points[0].position) - ledAt(trigger.stamp.toSec())).norm(), kNear);

  trigger.stamp = ros::Time(500);
  g_bench->trigger_publisher_.publish(trigger);
  EXPECT_TRUE(g_bench->waitForLog("there are no points for the trigger at 500"));
}

TEST(Triangulation, ReportsLedsThatEnterAndLeaveAZone) {
  const double begin = g_bench->now_;
  const Vector3d here = ledAt(begin);
  Rig rig = g_bench->rig_;
  rig.zones = {{"here", here - Vector3d::Constant(0.3), here + Vector3d::Constant(0.3)}};
  g_bench->rig_publisher_.publish(toMessage(rig));
  ASSERT_TRUE(Bench::waitFor([] {
    return g_bench->film(kBatch, {0, 1, 2}) && g_bench->zone_events_.size() >= 2;
  }));
  const auto& events = g_bench->zone_events_;
  EXPECT_EQ("here", events[0].zone);
  EXPECT_EQ("led", events[0].label);
  EXPECT_EQ(wiimote_tracker_msgs::ZoneEvent::ENTERED, events[0].event);
  EXPECT_EQ(wiimote_tracker_msgs::ZoneEvent::LEFT, events[1].event);
  const Vector3d way = vectorOf(events[1].position) - here;
  EXPECT_NEAR(0.3, way.cwiseAbs().maxCoeff(), kNear);
}

TEST(Triangulation, KeepsItsRigWhenABadOneComes) {
  auto bad = toMessage(g_bench->rig_);
  bad.cameras[1].fx = -1.0;
  g_bench->rig_publisher_.publish(bad);
  ASSERT_TRUE(g_bench->waitForLog("is refused, the one before stays in use: camera 'camera_1'"));
  ASSERT_TRUE(g_bench->film(0.3, {0, 1, 2}));
  const auto arrays = g_bench->arraysSince(g_bench->now_ - 0.2);
  EXPECT_GE(arrays.size(), kFewest);
  for (const auto& array : arrays) {
    expectOnPath(array, 3);
    EXPECT_EQ(g_bench->rig_.id(), array.rig_id);
  }
}

/// A correction that raises points by 0.1 m, measured between these heights.
remap::Remap raised(const Rig& rig, double bottom, double top) {
  remap::Remap remap{rig.id(), remap::Model::kAffine, std::vector<double>(12, 0.0), {}};
  remap.parameters[2] = 0.1;
  for (int corner = 0; corner < 8; ++corner)
    remap.support.emplace_back(corner % 2 ? 1.0 : -1.0, corner / 2 % 2 ? 1.0 : -1.0,
                               corner / 4 ? top : bottom);
  return remap;
}

/// Publishes images with a rig that has this correction. Expects the points at this height (the
/// truth is 0.2 m), and all of them remapped or none.
void expectCorrected(const std::optional<remap::Remap>& remap, double height, bool remapped) {
  Rig rig = g_bench->rig_;
  rig.remap = remap;
  g_bench->rig_publisher_.publish(toMessage(rig));
  // Starts at the first point at that height: rig and images may overtake each other.
  ASSERT_TRUE(Bench::waitFor([&] {
    if (!g_bench->film(kBatch, {0, 1, 2}))
      return false;
    const auto& points = g_bench->arrays_.back().points;
    return !points.empty() && std::abs(points[0].position.z - height) < 1e-3 &&
           points[0].remapped == remapped;
  }));
  const double begin = g_bench->now_;
  ASSERT_TRUE(g_bench->film(0.2, {0, 1, 2}));
  const auto arrays = g_bench->arraysSince(begin);
  EXPECT_GE(arrays.size(), kFewest);
  for (const auto& array : arrays) {
    ASSERT_EQ(1u, array.points.size());
    EXPECT_EQ(rig.id(), array.rig_id);
    EXPECT_EQ(remapped, array.points[0].remapped);
    Vector3d expected = ledAt(array.header.stamp.toSec());
    expected.z() = height;
    EXPECT_LT((vectorOf(array.points[0].position) - expected).norm(), kNear);
  }
}

TEST(Triangulation, CorrectsOnlyTheMeasuredVolume) {
  expectCorrected(raised(g_bench->rig_, 0.0, 1.0), 0.3, true);
  // All points are below the measured volume: displaced as at its border, not marked as corrected.
  expectCorrected(raised(g_bench->rig_, 0.5, 1.0), 0.3, false);
  expectCorrected(std::nullopt, 0.2, false);
  ASSERT_TRUE(Bench::waitFor([] {
    return !g_bench->points_.empty() &&
           g_bench->points_.back().header.stamp == g_bench->arrays_.back().header.stamp;
  }));
  EXPECT_EQ(g_bench->arrays_.back().points.at(0).position, g_bench->points_.back().point);
}

TEST(Triangulation, ReportsACorrectionOfAnotherCalibration) {
  remap::Remap old = raised(g_bench->rig_, 0.0, 1.0);
  old.rig_id = "0123456789abcdef";
  g_bench->diagnostics_.clear();
  expectCorrected(old, 0.2, false);
  EXPECT_TRUE(
      g_bench->waitForLog("Points are not corrected: the correction of the volume was "
                          "measured with calibration \"0123456789abcdef\""));
  EXPECT_TRUE(Bench::waitFor([] {
    return g_bench->film(kBatch, {0, 1, 2}) &&
           std::any_of(g_bench->diagnostics_.begin(), g_bench->diagnostics_.end(),
                       [](const auto& status) {
                         return status.level == diagnostic_msgs::DiagnosticStatus::WARN &&
                                status.message.find("it is void") != std::string::npos;
                       });
  }));
  expectCorrected(std::nullopt, 0.2, false);
}

TEST(Triangulation, TakesANewRigAtOnce) {
  Rig shifted = g_bench->rig_;
  for (auto& camera : shifted.cameras)
    camera.camera.world_from_camera.pretranslate(Vector3d(1.0, 0.0, 0.0));
  g_bench->rig_publisher_.publish(toMessage(g_bench->rig_));  // the same again: nothing happens
  g_bench->rig_publisher_.publish(toMessage(shifted));
  ASSERT_TRUE(g_bench->waitForLog("Rig " + shifted.id()));
  const std::string first = "Rig " + g_bench->rig_.id();
  const std::size_t place = g_bench->log_.find(first);
  ASSERT_NE(std::string::npos, place);
  EXPECT_EQ(std::string::npos, g_bench->log_.find(first, place + 1)) << "only one new rig";
  ASSERT_TRUE(g_bench->film(0.3, {0, 1, 2}));
  for (const auto& array : g_bench->arraysSince(g_bench->now_ - 0.3))
    EXPECT_EQ(shifted.id(), array.rig_id);
  // The LED is not where the old rig put it, and is found again.
  ASSERT_TRUE(g_bench->film(2.0, {0, 1, 2}));
  std::size_t found = 0;
  for (const auto& array : g_bench->arraysSince(g_bench->now_ - 0.5)) {
    ASSERT_EQ(1u, array.points.size());
    const Vector3d expected = ledAt(array.header.stamp.toSec()) + Vector3d(1.0, 0.0, 0.0);
    EXPECT_LT((vectorOf(array.points[0].position) - expected).norm(), kNear);
    ++found;
  }
  EXPECT_GE(found, kFewest);
  g_bench->rig_publisher_.publish(toMessage(g_bench->rig_));
  ASSERT_TRUE(g_bench->film(2.0, {0, 1, 2}));
}

TEST(Triangulation, SaysNothingOfALensWhoseRigIsToBeSaved) {
  ros::Publisher publisher =
      g_bench->nh_.advertise<sensor_msgs::CameraInfo>("camera_0/camera_info", 1, true);
  sensor_msgs::CameraInfo info = infoOf(g_bench->rig_.cameras[0].camera.intrinsics);
  info.K[0] += 50.0;
  publisher.publish(info);
  EXPECT_TRUE(warns("camera_0", "camera_info of camera_0 contradicts the rig"));
  g_bench->rig_.solved_at = ros::WallTime::now().toSec();
  g_bench->rig_.cameras[0].camera.world_from_camera.translation().x() += 1e-6;  // another rig
  g_bench->rig_publisher_.publish(toMessage(g_bench->rig_));
  EXPECT_TRUE(isWell("camera_0"));
}

TEST(Triangulation, IgnoresImagesOfAnotherSize) {
  IrBlobArray image = g_bench->image(0, g_bench->now_);
  image.width += 1;
  g_bench->blob_publishers_[0].publish(image);
  EXPECT_TRUE(g_bench->waitForLog("images of camera_0 have"));
}

TEST(Triangulation, RestartsWhenABagStartsOver) {
  g_bench->now_ = 1000.0;
  g_bench->newest_.assign(3, -1.0);
  g_bench->arrays_.clear();
  ASSERT_TRUE(g_bench->film(1.0, {0, 1, 2}));
  EXPECT_TRUE(g_bench->waitForLog("time jumped back, tracking starts anew"));
  const TrackedPointArray& last = g_bench->arrays_.back();
  EXPECT_LT(last.header.stamp.toSec(), 1001.1);
  ASSERT_EQ(1u, last.points.size());
  // The rig that was moved above may have left either label there; they return by place, which the
  // tests of LedLabels check.
  const std::string& label = last.points[0].label;
  EXPECT_TRUE(label == "led" || label == "second") << label;
}

/// Output of a command line and whether it failed.
std::pair<std::string, bool> run(const std::string& command) {
  std::string output;
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (!pipe)
    throw std::runtime_error("cannot run " + command);
  char buffer[256];
  while (std::fgets(buffer, sizeof buffer, pipe))
    output += buffer;
  return {output, pclose(pipe) != 0};
}

/// Starts the node /replay, which publishes a rig (not a good one), and images of a camera.
FILE* startReplay() {
  return popen(
      "exec timeout 60 python3 -c \"import rospy; from wiimote_tracker_msgs.msg import IrBlobArray,"
      "RigCalibration; rospy.init_node('replay'); images = rospy.Publisher('camera_0/ir_blobs',"
      "IrBlobArray, queue_size=1); rig = rospy.Publisher('calibration/rig', RigCalibration,"
      "queue_size=1, latch=True); rig.publish(RigCalibration()); rospy.spin()\"",
      "r");
}

TEST(Triangulation, SaysThatTwoNodesPublishImagesOfACameraOrARig) {
  FILE* replay = startReplay();
  ASSERT_NE(replay, nullptr);
  EXPECT_TRUE(g_bench->waitForLog("/camera_0/ir_blobs has 2 publishers"));
  EXPECT_TRUE(g_bench->waitForLog("The rig of /replay on /calibration/rig is ignored, since /"));
  EXPECT_FALSE(run("rosnode kill /replay").second);
  pclose(replay);
}

TEST(Triangulation, TakesTheRigOfTheNodeThatIsLeft) {
  g_bench->rig_publisher_.shutdown();
  const std::size_t before = g_bench->log_.size();
  FILE* replay = startReplay();
  ASSERT_NE(replay, nullptr);
  EXPECT_TRUE(Bench::waitFor([&] {
    return g_bench->log_.find("The rig calibration on /calibration/rig is refused", before) !=
           std::string::npos;
  }));
  g_bench->rig_.cameras[0].camera.world_from_camera.translation().x() += 1e-6;
  g_bench->rig_publisher_ =
      g_bench->nh_.advertise<wiimote_tracker_msgs::RigCalibration>("calibration/rig", 10, true);
  g_bench->rig_publisher_.publish(toMessage(g_bench->rig_));
  EXPECT_TRUE(g_bench->waitForLog("is ignored, since /replay publishes one, too: end one"));
  EXPECT_FALSE(run("rosnode kill /replay").second);
  pclose(replay);
  EXPECT_TRUE(g_bench->waitForLog("Rig " + g_bench->rig_.id()));
}

TEST(TriangulationNode, AdvisesWithItsNamespace) {
  FILE* second = popen(
      "ROS_NAMESPACE=second exec timeout 60 rosrun wiimote_tracker_triangulation "
      "triangulation_node",
      "r");
  ASSERT_NE(second, nullptr);
  EXPECT_TRUE(g_bench->waitForLog("run  ROS_NAMESPACE=second rosrun wiimote_tracker_calibration"));
  EXPECT_FALSE(run("rosnode kill /second/triangulation").second);
  pclose(second);
}

TEST(TriangulationNode, LeavesWithAnErrorThatNamesTheParameter) {
  const auto [output, failed] =
      run("rosrun wiimote_tracker_triangulation triangulation_node __name:=wrong "
          "_instant/camera_timeout:=-1");
  EXPECT_TRUE(failed);
  EXPECT_NE(std::string::npos, output.find("/wrong/instant/camera_timeout is -1")) << output;
}

TEST(TriangulationNode, LeavesWithAnErrorWithoutAMaster) {
  const auto [output, failed] = run(
      "ROS_MASTER_URI=http://localhost:1 rosrun wiimote_tracker_triangulation triangulation_node");
  EXPECT_TRUE(failed);
  EXPECT_NE(std::string::npos, output.find("start roscore")) << output;
}

}  // namespace
}  // namespace wiimote_tracker

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_triangulation");
  ros::NodeHandle keep_alive;
  wiimote_tracker::g_bench = std::make_unique<wiimote_tracker::Bench>();
  const int result = RUN_ALL_TESTS();
  wiimote_tracker::g_bench.reset();
  return result;
}
