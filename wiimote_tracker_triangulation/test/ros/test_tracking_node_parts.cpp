// Parts of the node besides tracking and labels: bad images, clocks, lenses, statistics, load.
#include "geometry/random_rigs.h"
#include "ros/camera_info.h"
#include "ros/host_clock_check.h"
#include "ros/lens_check.h"
#include "ros/load_shedding.h"
#include "ros/tracker/image_message.h"
#include "ros/tracker/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace wiimote_tracker {
namespace {

using geometry::Rig;
using tracking::TrackState;
using wiimote_tracker_msgs::IrBlob;
using wiimote_tracker_msgs::IrBlobArray;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Rig someRig(int cameras) {
  geometry::test::Random random(91);
  return geometry::test::randomRig(random, cameras);
}

IrBlobArray goodImage(const geometry::Camera& camera) {
  IrBlobArray image;
  image.header.stamp = ros::Time(100, 250000000);
  image.camera = camera.name;
  image.identity = camera.identity;
  image.arrival = ros::Time(100, 260000000);
  image.stamp_stddev = 0.001;
  image.clock_epoch = 3;
  image.width = static_cast<std::uint32_t>(camera.intrinsics.width);
  image.height = static_cast<std::uint32_t>(camera.intrinsics.height);
  image.max_blobs = 4;
  for (int i = 0; i < 2; ++i) {
    IrBlob blob;
    blob.x = 10.0 + i;
    blob.y = 20.0;
    blob.slot = static_cast<std::uint8_t>(2 + i);
    image.blobs.push_back(blob);
  }
  return image;
}

TEST(ImageMessage, IsReadUnchanged) {
  const geometry::Camera camera = someRig(1).cameras[0].camera;
  tracking::CameraImage image;
  EXPECT_FALSE(readImage(goodImage(camera), camera, &image));
  EXPECT_EQ(100.25, image.stamp);
  EXPECT_EQ(100.26, image.arrival);
  EXPECT_EQ(0.001, image.stamp_stddev);
  EXPECT_EQ(3u, image.clock_epoch);
  EXPECT_EQ(4u, image.maximum_spots);
  ASSERT_EQ(2u, image.spots.size());
  EXPECT_EQ(Eigen::Vector2d(11.0, 20.0), image.spots[1].pixel);
  EXPECT_EQ(3, image.spots[1].slot);
}

TEST(ImageMessage, UnknownValuesStayUnknown) {
  const geometry::Camera camera = someRig(1).cameras[0].camera;
  IrBlobArray message = goodImage(camera);
  message.camera = message.identity = "";
  message.arrival = ros::Time();
  message.max_blobs = 0;
  tracking::CameraImage image;
  for (const double stddev : {-1.0, kInfinity, kNaN}) {
    message.stamp_stddev = stddev;
    EXPECT_FALSE(readImage(message, camera, &image));
    EXPECT_TRUE(std::isnan(image.stamp_stddev)) << stddev;
  }
  EXPECT_EQ(image.stamp, image.arrival);
  EXPECT_GT(image.maximum_spots, 1000000u) << "no number of spots means that the image is full";
}

TEST(ImageMessage, ImpossibleSpotsAreOmitted) {
  const geometry::Camera camera = someRig(1).cameras[0].camera;
  const double width = camera.intrinsics.width;
  const double height = camera.intrinsics.height;
  for (const auto& [x, y] : std::vector<std::pair<double, double>>{{kNaN, 1.0},
                                                                   {1.0, kNaN},
                                                                   {kInfinity, 1.0},
                                                                   {-1.0, 1.0},
                                                                   {1.0, -1.0},
                                                                   {width, 1.0},
                                                                   {1.0, height},
                                                                   {1e300, 1.0}}) {
    IrBlobArray message = goodImage(camera);
    message.blobs[0].x = x;
    message.blobs[0].y = y;
    tracking::CameraImage image;
    const auto fault = readImage(message, camera, &image);
    ASSERT_TRUE(fault) << x << " " << y;
    EXPECT_EQ(ImageFault::Kind::kImpossibleSpots, fault->kind);
    EXPECT_TRUE(fault->leavesImageUsable());
    ASSERT_EQ(1u, image.spots.size());
    EXPECT_EQ(11.0, image.spots[0].pixel.x());
    EXPECT_NE(std::string::npos, fault->sentence.find(camera.name));
  }
  IrBlobArray message = goodImage(camera);
  message.blobs[0].x = width - 1.0;
  message.blobs[1].y = 0.0;
  tracking::CameraImage image;
  EXPECT_FALSE(readImage(message, camera, &image)) << "the border is inside";
}

TEST(ImageMessage, UnusableImagesAreNamed) {
  const geometry::Camera camera = someRig(1).cameras[0].camera;
  using Kind = ImageFault::Kind;
  const auto says = [&](const IrBlobArray& message, Kind expected, const std::string& words) {
    tracking::CameraImage image;
    const auto fault = readImage(message, camera, &image);
    ASSERT_TRUE(fault) << words;
    EXPECT_EQ(expected, fault->kind);
    EXPECT_FALSE(fault->leavesImageUsable());
    EXPECT_NE(std::string::npos, fault->sentence.find(words)) << fault->sentence;
  };
  IrBlobArray message = goodImage(camera);
  message.header.stamp = ros::Time();
  says(message, Kind::kNoTime, "carry no time");
  message = goodImage(camera);
  message.header.stamp = message.arrival - ros::Duration(11.0);
  says(message, Kind::kImpossibleTime, "before their arrival");
  message.header.stamp = message.arrival + ros::Duration(0.05);
  says(message, Kind::kAfterArrival, "0.05 s after their arrival");
  // Their difference is no ros::Duration.
  message.header.stamp = ros::TIME_MAX;
  says(message, Kind::kAfterArrival, "after their arrival");
  std::swap(message.header.stamp, message.arrival);
  says(message, Kind::kImpossibleTime, "before their arrival");
  message = goodImage(camera);
  message.camera = "stranger";
  says(message, Kind::kOtherCamera, "are from stranger");
  message = goodImage(camera);
  message.identity = "00:00:00:00:00:99";
  says(message, Kind::kOtherDevice, "is device 00:00:00:00:00:99");
  message = goodImage(camera);
  message.width += 1;
  says(message, Kind::kOtherSize, "calibrate again");
  message = goodImage(camera);
  message.height = 4294967295u;
  says(message, Kind::kOtherSize, "4294967295");
}

TEST(HostClockCheck, FindsNothingWhereClocksAgree) {
  HostClockCheck clocks(0.02);
  clocks.clear(3);
  EXPECT_FALSE(clocks.ahead(0)) << "nothing known";
  for (int i = 0; i < 100; ++i) {
    clocks.add(0, 0.001 + 0.0001 * i);
    clocks.add(1, 0.5 - 0.0049 * i);  // mostly slow
  }
  for (std::size_t camera = 0; camera < 3; ++camera)
    EXPECT_FALSE(clocks.ahead(camera)) << camera;
}

TEST(HostClockCheck, FindsAClockThatIsAhead) {
  HostClockCheck clocks(0.02);
  clocks.clear(3);
  clocks.add(0, 0.001);
  clocks.add(1, -0.1);
  clocks.add(2, 0.002);
  EXPECT_FALSE(clocks.ahead(0));
  ASSERT_TRUE(clocks.ahead(1));
  EXPECT_NEAR(0.1, *clocks.ahead(1), 1e-12);
  EXPECT_FALSE(clocks.ahead(2));
  // Stamps in the future, also without other cameras to compare with.
  clocks.clear(1);
  clocks.add(0, -0.1);
  ASSERT_TRUE(clocks.ahead(0));
}

TEST(HostClockCheck, FindsTheOneThatIsBehindTheOthers) {
  HostClockCheck clocks(0.02);
  clocks.clear(4);
  for (std::size_t camera = 0; camera < 4; ++camera)
    clocks.add(camera, camera == 2 ? 0.3 : 0.001);
  EXPECT_FALSE(clocks.ahead(0));
  ASSERT_TRUE(clocks.ahead(2));
  EXPECT_NEAR(-0.299, *clocks.ahead(2), 1e-12);
  // Of two, it is the one whose images take longer.
  clocks.clear(2);
  clocks.add(0, 0.3);
  clocks.add(1, 0.001);
  EXPECT_TRUE(clocks.ahead(0));
  EXPECT_FALSE(clocks.ahead(1));
}

TEST(HostClockCheck, ACommonDelayIsNoClockError) {
  HostClockCheck clocks(0.02);
  clocks.clear(3);
  for (std::size_t camera = 0; camera < 3; ++camera)
    clocks.add(camera, 1.7e9);  // a bag without its clock
  for (std::size_t camera = 0; camera < 3; ++camera)
    EXPECT_FALSE(clocks.ahead(camera));
}

TEST(LensCheck, AgreesWithTheSameLensAndWithAnUnknownOne) {
  const geometry::Camera camera = someRig(1).cameras[0].camera;
  sensor_msgs::CameraInfo info = infoOf(camera.intrinsics);
  EXPECT_EQ("", lensMismatch(info, camera));
  info.K[2] += 1.0;  // as precise as a lens is known
  EXPECT_EQ("", lensMismatch(info, camera));
  info = sensor_msgs::CameraInfo();
  EXPECT_EQ("", lensMismatch(info, camera)) << "not calibrated";
}

TEST(LensCheck, NamesAContradiction) {
  const geometry::Camera camera = someRig(1).cameras[0].camera;
  const auto contradicts = [&](const std::function<void(sensor_msgs::CameraInfo&)>& change) {
    sensor_msgs::CameraInfo info = infoOf(camera.intrinsics);
    change(info);
    return lensMismatch(info, camera).find("camera_info of " + camera.name) == 0;
  };
  EXPECT_TRUE(contradicts([](auto& i) { i.K[0] *= 1.02; }));
  EXPECT_TRUE(contradicts([](auto& i) { i.K[5] += 3.0; }));
  EXPECT_TRUE(contradicts([](auto& i) { i.K[4] = kNaN; }));
  EXPECT_TRUE(contradicts([](auto& i) { i.D[0] += 0.2; }));
  EXPECT_TRUE(contradicts([](auto& i) { i.D.pop_back(); }));
  EXPECT_TRUE(contradicts([](auto& i) { i.distortion_model = "rubber"; }));
  EXPECT_TRUE(contradicts([](auto& i) { i.width += 1; }));
  sensor_msgs::CameraInfo info = infoOf(camera.intrinsics);
  info.D.pop_back();
  EXPECT_NE(std::string::npos, lensMismatch(info, camera).find("with 4 coefficients"));
}

TEST(Statistics, CountsEachViewOnceWithoutMaskedSpots) {
  const Rig rig = someRig(2);
  Statistics statistics;
  statistics.setRig(rig);
  const Eigen::Vector3d place(0.1, 0.2, 0.3);
  tracking::Snapshot snapshot;
  snapshot.time = 100.0;
  snapshot.leds.resize(2);
  snapshot.leds[0].id = 5;
  snapshot.leds[0].state = TrackState::kTracked;
  snapshot.leds[0].position = place;
  snapshot.leds[1].id = 6;
  snapshot.leds[1].state = TrackState::kPredicted;
  snapshot.views.resize(2);
  snapshot.views[0].time = 100.0;
  const Eigen::Vector2d pixel = *rig.cameras[0].camera.project(place);
  snapshot.views[0].spots = {{pixel + Eigen::Vector2d(3.0, 4.0), tracking::SpotUse::kAssigned, 5},
                             {{10.0, 10.0}, tracking::SpotUse::kMasked, 0},
                             {{20.0, 10.0}, tracking::SpotUse::kUnassigned, 0}};
  snapshot.views[1].time = 99.99;
  snapshot.views[1].spots = {{{1.0, 1.0}, tracking::SpotUse::kUnassigned, 0}};
  statistics.addSnapshot(snapshot);
  EXPECT_EQ(1u, statistics.snapshots());
  EXPECT_EQ(1u, statistics.leds(TrackState::kTracked));
  EXPECT_EQ(1u, statistics.leds(TrackState::kPredicted));
  EXPECT_EQ(0.5, statistics.camera(0).inlierRatio());
  EXPECT_EQ(1u, statistics.camera(0).masked);
  EXPECT_NEAR(5.0, statistics.camera(0).residual(), 1e-9);
  EXPECT_TRUE(std::isnan(statistics.camera(1).inlierRatio())) << "counted at its own time";
  EXPECT_TRUE(std::isnan(statistics.camera(1).residual()));
  statistics.clear();
  EXPECT_EQ(0u, statistics.leds(TrackState::kTracked)) << "no image came since";
}

TEST(Statistics, SayWhatIsTrackedOrSeen) {
  Statistics statistics;
  statistics.setRig(someRig(1));
  tracking::Snapshot snapshot;
  snapshot.time = 100.0;
  snapshot.views.resize(1);
  snapshot.views[0].time = 100.0;
  statistics.addSnapshot(snapshot);
  EXPECT_EQ("no LED is seen", statistics.describe());
  statistics.setBodies(1);
  EXPECT_EQ("no LED is tracked singly", statistics.describe());
  statistics.setBodies(0);
  snapshot.views[0].spots = {{{20.0, 10.0}, tracking::SpotUse::kUnassigned, 0}};
  statistics.addSnapshot(snapshot);
  EXPECT_EQ("no LED is tracked", statistics.describe());
  snapshot.leds.resize(1);
  snapshot.leds[0].state = TrackState::kTracked;
  statistics.addSnapshot(snapshot);
  EXPECT_EQ("tracking", statistics.describe());
}

TEST(Statistics, NameACameraThatSeesManyLights) {
  const auto lights = [](std::size_t spots, std::size_t assigned) {
    CameraStatistics statistics;
    statistics.views = 100;
    statistics.spots = spots;
    statistics.assigned = assigned;
    return describeLights(statistics, "cam");
  };
  EXPECT_EQ(
      "5 spots in each image of cam belong to no LED that another camera sees: mask lamps and "
      "reflections",
      lights(800, 300));
  EXPECT_EQ("", lights(300, 0)) << "three LEDs that only this camera sees";
  EXPECT_EQ("", lights(800, 450)) << "most are LEDs";
  EXPECT_EQ("", describeLights(CameraStatistics(), "cam"));
}

TEST(Statistics, DelaysLatenciesAndProblemsLastUntilTheyAreCleared) {
  Statistics statistics;
  statistics.setRig(someRig(1));
  EXPECT_TRUE(std::isnan(statistics.latency(0.5)));
  EXPECT_TRUE(std::isnan(statistics.camera(0).meanDelay()));
  for (int i = 0; i <= 100; ++i)
    statistics.addLatency(0.001 * ((i * 37) % 101));
  EXPECT_NEAR(0.050, statistics.latency(0.50), 1e-12);
  EXPECT_NEAR(0.099, statistics.latency(0.99), 1e-12);
  tracking::CameraImage image;
  image.stamp = 100.0;
  for (const double arrival : {100.01, 100.03}) {
    image.arrival = arrival;
    statistics.addImage(0, image, 0);
  }
  statistics.addProblem(0, "broken");
  EXPECT_NEAR(0.02, statistics.camera(0).meanDelay(), 1e-9);
  EXPECT_EQ(2u, statistics.camera(0).images);
  EXPECT_EQ("broken", statistics.camera(0).problem);
  statistics.clear();
  EXPECT_EQ(0u, statistics.camera(0).images);
  EXPECT_EQ("", statistics.camera(0).problem);
}

TEST(Statistics, CountsLostImagesByTheGapsInTheirNumbers) {
  Statistics statistics;
  statistics.setRig(someRig(2));
  const tracking::CameraImage image;
  for (const std::uint64_t frame : {5, 6, 9})
    statistics.addImage(0, image, frame);
  statistics.addImage(1, image, 100);
  EXPECT_EQ(2u, statistics.camera(0).lost);
  EXPECT_EQ(0u, statistics.camera(1).lost) << "the first says nothing of those before it";
  statistics.clear();
  statistics.addImage(0, image, 11);
  EXPECT_EQ(1u, statistics.camera(0).lost) << "of which the last one came before clear()";
  statistics.addImage(0, image, 0);  // its driver was started again
  statistics.addImage(0, image, 0);  // or does not number its images
  EXPECT_EQ(1u, statistics.camera(0).lost);
}

// A camera gives an image each 10 ms; handling one takes `cost` [s], and nothing before `pause`
// [s].
struct Queue {
  LoadShedding shedding;
  double now = 0.0;
  double longest_wait = 0.0;  // of handled images, in the last 2 s

  void run(double cost, double pause, double duration) {
    const double begin = now;
    for (int i = 0; i < static_cast<int>(100 * duration); ++i) {
      const double receipt = begin + 0.01 * i;
      now = std::max({now, receipt, begin + pause});
      if (shedding.drops(now - receipt, now))
        continue;
      if (i > 100 * (duration - 2.0))
        longest_wait = std::max(longest_wait, now - receipt);
      now += cost;
    }
  }
};

TEST(LoadShedding, WorksOffWhatWaitedDuringAPause) {
  Queue queue;
  queue.run(0.0005, 5.0, 20.0);
  EXPECT_EQ(0u, queue.shedding.dropped());
  EXPECT_LE(queue.longest_wait, 0.001);
}

TEST(LoadShedding, KeepsPointsRecentWhenOverloaded) {
  for (const double cost : {0.011, 0.02, 0.1}) {
    Queue queue;
    queue.run(cost, 0.0, 20.0);
    EXPECT_LE(queue.longest_wait, 0.05 + 1e-9) << cost;
    EXPECT_TRUE(queue.shedding.overloaded(queue.now)) << cost;
    const double handled = 2000.0 - static_cast<double>(queue.shedding.dropped());
    EXPECT_GE(handled, 0.95 * 20.0 / cost) << cost << ": no more than needed";
  }
}

TEST(LoadShedding, EndsWithTheLoad) {
  Queue queue;
  queue.run(0.02, 0.0, 10.0);
  const std::uint64_t dropped = queue.shedding.dropped();
  queue.now = 10.0;
  queue.run(0.0005, 0.0, 10.0);
  EXPECT_EQ(dropped, queue.shedding.dropped());
  EXPECT_FALSE(queue.shedding.overloaded(queue.now));
}

}  // namespace
}  // namespace wiimote_tracker
