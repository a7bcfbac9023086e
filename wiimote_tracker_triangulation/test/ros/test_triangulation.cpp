// The running node or nodelet: a rig and blobs in; points, TF and markers out.
#include "geometry/random_rigs.h"
#include "wiimote_tracker_triangulation/ros/conversions.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/PointStamped.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Log.h>
#include <tf2_ros/transform_listener.h>
#include <visualization_msgs/MarkerArray.h>
#include <wiimote_tracker_msgs/IrBlobArray.h>
#include <wiimote_tracker_msgs/TrackedPointArray.h>

#include <algorithm>
#include <cstdio>
#include <functional>
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
using wiimote_tracker_msgs::TrackedPointArray;

constexpr double kPeriod = 0.01;
constexpr double kBatch = 0.05;  // below the camera time-out, so that the order of topics is free

/// 0.5 m/s, in view of all cameras.
Vector3d ledAt(double t) {
  return {0.5 * std::cos(t), 0.5 * std::sin(t), 0.2};
}

/// Collects everything and feeds cameras; one for all tests, which follow each other in time.
class Bench {
 public:
  Bench() {
    geometry::test::Random random(81);
    rig_ = geometry::test::randomRig(random, 3);
    rig_publisher_ =
        nh_.advertise<wiimote_tracker_msgs::RigCalibration>("calibration/rig", 10, true);
    for (const auto& camera : rig_.cameras)
      blob_publishers_.push_back(
          nh_.advertise<IrBlobArray>(camera.camera.name + "/ir_blobs", 1000));
    subscribers_ = {
        nh_.subscribe<TrackedPointArray>("points", 10000,
                                         [this](const auto& m) { arrays_.push_back(*m); }),
        nh_.subscribe<geometry_msgs::PointStamped>(
            "led/point", 10000, [this](const auto& m) { points_.push_back(*m); }),
        nh_.subscribe<visualization_msgs::MarkerArray>(
            "markers", 1000, [this](const auto& m) { markers_.push_back(*m); }),
        nh_.subscribe<diagnostic_msgs::DiagnosticArray>("/diagnostics", 1000,
                                                        [this](const auto& m) {
                                                          for (const auto& status : m->status)
                                                            diagnostics_.push_back(status);
                                                        }),
        nh_.subscribe<rosgraph_msgs::Log>("/rosout", 1000,
                                          [this](const auto& m) { log_ += m->msg + "\n"; })};
    newest_.assign(3, -1.0);
  }

  /// Runs callbacks until the condition holds; false after a minute.
  static bool waitFor(const std::function<bool()>& condition) {
    const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(60.0);
    while (ros::ok() && !condition()) {
      if (ros::WallTime::now() > deadline)
        return false;
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
    }
    return condition();
  }

  bool waitForLog(const std::string& words) {
    return waitFor([&] { return log_.find(words) != std::string::npos; });
  }

  bool waitForSubscriptions() {
    return waitFor([&] {
      return std::all_of(blob_publishers_.begin(), blob_publishers_.end(),
                         [](const auto& p) { return p.getNumSubscribers() > 0; });
    });
  }

  IrBlobArray image(std::size_t camera, double time) const {
    const geometry::Camera& c = rig_.cameras[camera].camera;
    IrBlobArray blobs;
    blobs.header.stamp.fromSec(time);
    blobs.header.frame_id = opticalFrame(c.name);
    blobs.camera = c.name;
    blobs.identity = c.identity;
    blobs.arrival.fromSec(time + 0.002);
    blobs.width = static_cast<std::uint32_t>(c.intrinsics.width);
    blobs.height = static_cast<std::uint32_t>(c.intrinsics.height);
    blobs.max_blobs = 4;
    if (const auto pixel = c.project(ledAt(time))) {
      wiimote_tracker_msgs::IrBlob blob;
      blob.x = pixel->x();
      blob.y = pixel->y();
      blobs.blobs.push_back(blob);
    }
    return blobs;
  }

  /// Films for a while with these cameras, batch by batch, each of which is awaited.
  bool film(double duration, const std::vector<std::size_t>& cameras) {
    for (const double end = now_ + duration; now_ < end; now_ += kBatch) {
      for (const std::size_t c : cameras) {
        for (double t = now_ + 0.003 * c; t < now_ + kBatch - 1e-6; t += kPeriod) {
          blob_publishers_[c].publish(image(c, t));
          newest_[c] = std::max(newest_[c], t);
        }
      }
      // Without a word from the others for 0.1 s, the cameras that film decide.
      double reached = now_ + kBatch;
      const double newest = *std::max_element(newest_.begin(), newest_.end());
      for (const double t : newest_) {
        if (t >= newest - 0.1 - 1e-6)
          reached = std::min(reached, t);
      }
      const auto arrived = [&] {
        return !arrays_.empty() && arrays_.back().header.stamp.toSec() >= reached - 1e-6;
      };
      if (!waitFor(arrived))
        return false;
    }
    return true;
  }

  std::vector<TrackedPointArray> arraysSince(double time) const {
    std::vector<TrackedPointArray> result;
    for (const TrackedPointArray& array : arrays_) {
      if (array.header.stamp.toSec() > time)
        result.push_back(array);
    }
    return result;
  }

  ros::NodeHandle nh_;
  Rig rig_;
  double now_ = 1000.0;
  std::vector<double> newest_;
  ros::Publisher rig_publisher_;
  std::vector<ros::Publisher> blob_publishers_;
  std::vector<ros::Subscriber> subscribers_;
  std::vector<TrackedPointArray> arrays_;
  std::vector<geometry_msgs::PointStamped> points_;
  std::vector<visualization_msgs::MarkerArray> markers_;
  std::vector<diagnostic_msgs::DiagnosticStatus> diagnostics_;
  std::string log_;
};

std::unique_ptr<Bench> g_bench;

void expectOnPath(const TrackedPointArray& array, std::size_t rays) {
  ASSERT_EQ(1u, array.points.size());
  const wiimote_tracker_msgs::TrackedPoint& point = array.points[0];
  const Vector3d position(point.position.x, point.position.y, point.position.z);
  EXPECT_LT((position - ledAt(array.header.stamp.toSec())).norm(), 2e-5);
  EXPECT_EQ(rays, point.rays_used);
  EXPECT_EQ(rays, point.cameras.size());
  EXPECT_LT(point.residual, 0.1);
}

// In the order in which they stand: each continues where the one before ended.

TEST(Triangulation, SaysWhatToDoWithoutARig) {
  EXPECT_TRUE(g_bench->waitForLog("calibrate, or load a saved rig"));
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
  const auto arrays = g_bench->arraysSince(1000.05);
  ASSERT_GT(arrays.size(), 250u);
  for (std::size_t i = 0; i < arrays.size(); ++i) {
    expectOnPath(arrays[i], 3);
    EXPECT_EQ("world", arrays[i].header.frame_id);
    EXPECT_EQ(g_bench->rig_.id(), arrays[i].rig_id);
    EXPECT_EQ("maximum_likelihood", arrays[i].method);
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
  // From now on the listener hears; film until it has.
  ASSERT_TRUE(Bench::waitFor([&] {
    return g_bench->film(kBatch, {0, 1, 2}) && buffer.canTransform("world", "led", ros::Time(0));
  }));
  const auto transform = buffer.lookupTransform("world", "led", ros::Time(0));
  const auto& t = transform.transform.translation;
  EXPECT_LT((Vector3d(t.x, t.y, t.z) - ledAt(transform.header.stamp.toSec())).norm(), 2e-5);
}

TEST(Triangulation, PublishesMarkers) {
  ASSERT_TRUE(g_bench->film(0.2, {0, 1, 2}));
  ASSERT_TRUE(Bench::waitFor([] { return g_bench->markers_.size() > 2; }));
  std::set<std::string> kinds;
  for (const auto& marker : g_bench->markers_.back().markers)
    kinds.insert(marker.ns);
  EXPECT_EQ((std::set<std::string>{"blob", "camera", "covariance", "frustum", "image_plane",
                                   "point", "ray", "trail"}),
            kinds);
  // Throttled: 20 per second of the images' time, while there are 300 instants.
  EXPECT_LT(g_bench->markers_.size(), g_bench->arrays_.size() / 10);
}

TEST(Triangulation, ReportsDiagnostics) {
  const auto reported = [] {
    for (const auto& status : g_bench->diagnostics_) {
      if (status.message == "tracking" && status.hardware_id == "rig " + g_bench->rig_.id())
        return true;
    }
    return false;
  };
  ASSERT_TRUE(Bench::waitFor([&] { return g_bench->film(kBatch, {0, 1, 2}) && reported(); }));
}

TEST(Triangulation, DiagnosticsNameACameraThatIsAnotherDevice) {
  const auto reported = [](const std::string& words) {
    g_bench->diagnostics_.clear();
    return Bench::waitFor([&] {
      if (!g_bench->film(kBatch, {0, 1, 2}))
        return false;
      return std::any_of(g_bench->diagnostics_.begin(), g_bench->diagnostics_.end(),
                         [&](const auto& s) { return s.message.find(words) != std::string::npos; });
    });
  };
  std::string& identity = g_bench->rig_.cameras[1].camera.identity;  // of the images to come
  const std::string calibrated = identity;
  identity = "00:00:00:00:00:99";
  EXPECT_TRUE(reported("camera_1 is device 00:00:00:00:00:99, but was calibrated as " + calibrated +
                       ": calibrate again"));
  identity = calibrated;
  EXPECT_TRUE(reported("tracking"));
}

TEST(Triangulation, GoesOnWhenOneCameraStopsAndWhenItComesBack) {
  ASSERT_TRUE(g_bench->film(0.6, {1, 2}));
  for (const auto& array : g_bench->arraysSince(g_bench->now_ - 0.2)) {
    expectOnPath(array, 2);
    EXPECT_EQ(3u, array.points.at(0).rays_possible);
  }
  ASSERT_TRUE(g_bench->film(0.4, {0, 1, 2}));
  const auto arrays = g_bench->arraysSince(g_bench->now_ - 0.2);
  EXPECT_GT(arrays.size(), 40u);
  for (const auto& array : arrays)
    expectOnPath(array, 3);
}

TEST(Triangulation, SaysWhenNothingIsSeen) {
  const double begin = g_bench->now_;
  for (std::size_t c = 0; c < 3; ++c) {
    for (const double t : {begin, begin + 0.01, begin + 0.02}) {
      IrBlobArray dark = g_bench->image(c, t);
      dark.blobs.clear();
      g_bench->blob_publishers_[c].publish(dark);
    }
  }
  ASSERT_TRUE(Bench::waitFor([&] { return g_bench->arraysSince(begin + 0.0199).size() > 0; }));
  for (const auto& array : g_bench->arraysSince(begin - 0.001))
    EXPECT_TRUE(array.points.empty());
  g_bench->now_ = begin + kBatch;
}

TEST(Triangulation, KeepsItsRigWhenABadOneComes) {
  auto bad = toMessage(g_bench->rig_);
  bad.cameras[1].fx = -1.0;
  g_bench->rig_publisher_.publish(bad);
  ASSERT_TRUE(g_bench->waitForLog("is refused, the one before stays in use: camera 'camera_1'"));
  ASSERT_TRUE(g_bench->film(0.3, {0, 1, 2}));
  const auto arrays = g_bench->arraysSince(g_bench->now_ - 0.2);
  EXPECT_GT(arrays.size(), 40u);
  for (const auto& array : arrays) {
    expectOnPath(array, 3);
    EXPECT_EQ(g_bench->rig_.id(), array.rig_id);
  }
}

/// Everything 0.1 m higher, measured between these heights.
remap::Remap raised(const Rig& rig, double bottom, double top) {
  remap::Remap remap{rig.id(), remap::Model::kAffine, std::vector<double>(12, 0.0), {}};
  remap.parameters[2] = 0.1;
  for (int corner = 0; corner < 8; ++corner)
    remap.support.emplace_back(corner % 2 ? 1.0 : -1.0, corner / 2 % 2 ? 1.0 : -1.0,
                               corner / 4 ? top : bottom);
  return remap;
}

/// Films with a rig that carries this correction; expects the points at this height, 0.2 m being
/// the truth, and all of them remapped or none.
void expectCorrected(const std::optional<remap::Remap>& remap, double height, bool remapped) {
  Rig rig = g_bench->rig_;
  rig.remap = remap;
  g_bench->rig_publisher_.publish(toMessage(rig));
  // From the first point at that height on; the rig may overtake images, and they it.
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
  EXPECT_GT(arrays.size(), 40u);
  for (const auto& array : arrays) {
    ASSERT_EQ(1u, array.points.size());
    EXPECT_EQ(rig.id(), array.rig_id);
    EXPECT_EQ(remapped, array.points[0].remapped);
    const auto& p = array.points[0].position;
    Vector3d expected = ledAt(array.header.stamp.toSec());
    expected.z() = height;
    EXPECT_LT((Vector3d(p.x, p.y, p.z) - expected).norm(), 2e-5);
  }
}

TEST(Triangulation, CorrectsTheVolumeAndNothingElse) {
  expectCorrected(raised(g_bench->rig_, 0.0, 1.0), 0.3, true);
  // All below what was measured: displaced as the border is, and not said to be corrected.
  expectCorrected(raised(g_bench->rig_, 0.5, 1.0), 0.3, false);
  expectCorrected(std::nullopt, 0.2, false);
  ASSERT_TRUE(Bench::waitFor([] {
    return !g_bench->points_.empty() &&
           g_bench->points_.back().header.stamp == g_bench->arrays_.back().header.stamp;
  }));
  EXPECT_EQ(g_bench->arrays_.back().points.at(0).position, g_bench->points_.back().point);
}

TEST(Triangulation, SaysThatACorrectionOfAnotherCalibrationIsVoid) {
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
  EXPECT_EQ(std::string::npos, g_bench->log_.find(first, place + 1)) << "taken once only";
  ASSERT_TRUE(g_bench->film(0.3, {0, 1, 2}));
  int found = 0;
  for (const auto& array : g_bench->arraysSince(g_bench->now_ - 0.3)) {
    EXPECT_EQ(shifted.id(), array.rig_id);
    if (array.points.empty())
      continue;
    const auto& p = array.points[0].position;
    const Vector3d expected = ledAt(array.header.stamp.toSec()) + Vector3d(1.0, 0.0, 0.0);
    EXPECT_LT((Vector3d(p.x, p.y, p.z) - expected).norm(), 2e-5);
    ++found;
  }
  EXPECT_GT(found, 40);
}

TEST(Triangulation, IgnoresImagesOfAnotherSize) {
  IrBlobArray image = g_bench->image(0, g_bench->now_);
  image.width += 1;
  g_bench->blob_publishers_[0].publish(image);
  EXPECT_TRUE(g_bench->waitForLog("Images of camera_0 have"));
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

TEST(TriangulationNode, LeavesWithAnErrorThatNamesTheParameter) {
  const auto [output, failed] = run(
      "rosrun wiimote_tracker_triangulation triangulation_node __name:=wrong _camera_timeout:=-1");
  EXPECT_TRUE(failed);
  EXPECT_NE(std::string::npos, output.find("/wrong/camera_timeout is -1")) << output;
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
