#include "driver.h"

#include <geometry_msgs/TransformStamped.h>
#include <sensor_msgs/Imu.h>
#include <wiimote_tracker_msgs/IrBlobArray.h>
#include <wiimote_tracker_msgs/parameter_reader.h>

#include <pthread.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

namespace wiimote_tracker::driver {
namespace {

constexpr double kStandardGravity = 9.80665;  // [m/s^2]
constexpr double kReadWait = 0.1;             // [s] How soon a request to stop is noticed.
constexpr double kRepeatErrorAfter = 30.0;    // [s]
constexpr double kDiagnosticsCheck = 0.2;     // [s]
// A remote sends some 95 to 100 images a second; below this something is wrong [Hz].
constexpr double kLowRate = 80.0;
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

double steadyNow() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

wiimote::Options wiimoteOptions(const DriverParameters& parameters) {
  wiimote::Options options;
  options.session.leds = static_cast<std::uint8_t>(parameters.leds);
  options.session.sensitivity = *protocol::irSensitivity(parameters.ir_sensitivity);
  options.session.reply_timeout = parameters.reply_timeout;
  options.session.silence_timeout = parameters.silence_timeout;
  options.session.status_interval = parameters.status_interval;
  return options;
}

wiimote::Wiimote::Open opener(const std::string& device) {
  return [name = transport::parseDeviceName(device)] { return transport::open(name); };
}

std::uint8_t irMode(protocol::IrFormat format) {
  switch (format) {
    case protocol::IrFormat::kBasic:
      return wiimote_tracker_msgs::IrBlobArray::IR_MODE_BASIC;
    case protocol::IrFormat::kExtended:
      return wiimote_tracker_msgs::IrBlobArray::IR_MODE_EXTENDED;
    default:
      return wiimote_tracker_msgs::IrBlobArray::IR_MODE_UNKNOWN;
  }
}

/// A thread in which no signal handler runs, so that none interrupts a read.
template <typename F>
std::thread threadWithoutSignals(F f) {
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  std::thread thread(std::move(f));
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return thread;
}

}  // namespace

Driver::Driver(ros::NodeHandle nh, const ros::NodeHandle& private_nh)
    : parameters_(readDriverParameters(nh, private_nh)),
      optical_frame_(parameters_.camera_name + "_optical_frame"),
      imu_frame_(parameters_.camera_name + "_imu_frame"),
      camera_info_(nh, parameters_.camera_name),
      updater_(nh, private_nh, private_nh.getNamespace().substr(1)),
      wiimote_(wiimoteOptions(parameters_), opener(parameters_.device), steadyNow),
      logged_at_(steadyNow()),
      statistics_(steadyNow()) {
  if (!camera_info_.validateURL(parameters_.camera_info_url))
    throw ParameterError(private_nh.resolveName("camera_info_url") + " is '" +
                         parameters_.camera_info_url +
                         "', but must be empty or a URL such as file:///path/to/camera.yaml or "
                         "package://name/camera.yaml");
  if (nh.getNamespace() == "/")
    ROS_WARN(
        "the driver runs in the namespace /, so that its topics are /ir_blobs and so on: start "
        "it in the camera's namespace, for example ROS_NAMESPACE=wiimote_1");
  // Now rather than at the first image.
  camera_info_.loadCameraInfo(parameters_.camera_info_url);

  blobs_ = nh.advertise<wiimote_tracker_msgs::IrBlobArray>("ir_blobs", 20);
  camera_info_publisher_ = nh.advertise<sensor_msgs::CameraInfo>("camera_info", 20);
  imu_ = nh.advertise<sensor_msgs::Imu>("imu/data_raw", 20);
  publishStaticTransform();

  updater_.setHardwareID("none");
  updater_.add("Wii Remote " + parameters_.camera_name, this, &Driver::diagnose);
  diagnostics_ = nh.createSteadyTimer(ros::WallDuration(kDiagnosticsCheck),
                                      [this](const ros::SteadyTimerEvent&) { updater_.update(); });
  reader_ = threadWithoutSignals([this] { run(); });
}

Driver::~Driver() {
  diagnostics_.stop();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  stopping_.notify_all();
  reader_.join();
}

void Driver::run() {
  std::uint64_t seen_changes = 0;
  for (;;) {
    const double idle = wiimote_.idleTime();
    {
      std::unique_lock<std::mutex> lock(mutex_);
      if (idle > 0.0)
        stopping_.wait_for(lock, std::chrono::duration<double>(idle), [this] { return stop_; });
      if (stop_)
        break;
    }
    const auto image = wiimote_.step(kReadWait);
    if (image)
      publishImage(*image, ros::Time::now());
    if (wiimote_.linkChanges() != seen_changes) {
      seen_changes = wiimote_.linkChanges();
      linkChanged();
    }
  }
  wiimote_.close();
}

void Driver::publishImage(const protocol::DataReport& image, const ros::Time& arrival) {
  ros::Time stamp = arrival;
  if (arrival.toSec() > parameters_.latency)  // else the clock has hardly begun
    stamp -= ros::Duration(parameters_.latency);
  publishBlobs(image, stamp, arrival);
  publishCameraInfo(stamp);
  if (image.acceleration)
    publishAcceleration(*image.acceleration, stamp);
  ++frame_;
  const std::lock_guard<std::mutex> lock(mutex_);
  statistics_.add(steadyNow());
}

void Driver::publishBlobs(const protocol::DataReport& image,
                          const ros::Time& stamp,
                          const ros::Time& arrival) {
  // A message of its own each time, so that nodelets may share it.
  const auto message = boost::make_shared<wiimote_tracker_msgs::IrBlobArray>();
  message->header.stamp = stamp;
  message->header.frame_id = optical_frame_;
  message->camera = parameters_.camera_name;
  message->identity = wiimote_.link().identity;
  message->arrival = arrival;
  message->stamp_stddev = std::numeric_limits<double>::quiet_NaN();
  message->clock_epoch = wiimote_.link().clock_epoch;
  message->frame = frame_;
  message->width = protocol::kSensorWidth;
  message->height = protocol::kSensorHeight;
  message->max_blobs = static_cast<std::uint32_t>(image.spots.size());
  message->ir_mode = irMode(image.ir_format);
  message->blobs.reserve(image.spots.size());
  for (std::size_t slot = 0; slot < image.spots.size(); ++slot) {
    const protocol::IrSpot& spot = image.spots[slot];
    if (!spot.seen)
      continue;
    wiimote_tracker_msgs::IrBlob blob;
    blob.x = spot.x;
    blob.y = protocol::kSensorHeight - 1 - spot.y;  // the sensor's y points up
    blob.size =
        image.ir_format == protocol::IrFormat::kExtended ? static_cast<float>(spot.size) : kUnknown;
    blob.intensity = kUnknown;
    blob.slot = static_cast<std::uint8_t>(slot);
    message->blobs.push_back(blob);
  }
  blobs_.publish(message);
}

void Driver::publishCameraInfo(const ros::Time& stamp) {
  if (camera_info_publisher_.getNumSubscribers() == 0)
    return;
  const auto message = boost::make_shared<sensor_msgs::CameraInfo>(camera_info_.getCameraInfo());
  message->header.stamp = stamp;
  message->header.frame_id = optical_frame_;
  if (message->width == 0) {  // not calibrated yet
    message->width = protocol::kSensorWidth;
    message->height = protocol::kSensorHeight;
  }
  camera_info_publisher_.publish(message);
}

void Driver::publishAcceleration(const std::array<int, 3>& raw, const ros::Time& stamp) {
  const std::array<double, 3> g = wiimote_.accelerometer().toG(raw);
  const auto message = boost::make_shared<sensor_msgs::Imu>();
  message->header.stamp = stamp;
  message->header.frame_id = imu_frame_;
  message->orientation_covariance[0] = -1.0;  // not measured
  message->angular_velocity_covariance[0] = -1.0;
  message->linear_acceleration.x = kStandardGravity * g[0];
  message->linear_acceleration.y = kStandardGravity * g[1];
  message->linear_acceleration.z = kStandardGravity * g[2];
  const double stddev = parameters_.linear_acceleration_stddev;
  for (const std::size_t diagonal : {0u, 4u, 8u})
    message->linear_acceleration_covariance[diagonal] = stddev * stddev;
  imu_.publish(message);
}

void Driver::publishStaticTransform() {
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = ros::Time::now();
  transform.header.frame_id = optical_frame_;
  transform.child_frame_id = imu_frame_;
  // Half a turn that takes the remote's x (left), y (rear), z (up) to -x, -z, -y of the image.
  transform.transform.rotation.x = 0.0;
  transform.transform.rotation.y = std::sqrt(0.5);
  transform.transform.rotation.z = -std::sqrt(0.5);
  transform.transform.rotation.w = 0.0;
  transform_.sendTransform(transform);
}

// Tells people once what has changed, and again from time to time what does not get better.
void Driver::linkChanged() {
  const wiimote::Link& link = wiimote_.link();
  const double now = steadyNow();
  const char* camera = parameters_.camera_name.c_str();
  wiimote::Link::State before;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    before = link_.state;
    link_ = link;
  }
  if (!link.error.empty()) {
    if (link.error != logged_error_ || now - logged_at_ > kRepeatErrorAfter) {
      logged_error_ = link.error;
      logged_at_ = now;
      ROS_WARN("%s: %s (trying again)", camera, link.error.c_str());
    }
    return;
  }
  logged_error_.clear();
  if (link.state == wiimote::Link::State::kStreaming && before != link.state) {
    ROS_INFO("%s: images come from %s (%s)", camera, link.description.c_str(),
             link.identity.c_str());
    if (!link.accelerometer_calibrated)
      ROS_WARN(
          "%s: the accelerometer calibration of the remote is damaged, a typical one serves: "
          "expect errors of some 0.5 m/s^2",
          camera);
    if (link.kernel_driver == "wiimote")
      ROS_WARN(
          "%s: the kernel's driver hid-wiimote is attached to the same remote and now and then "
          "interrupts its images: blacklist it as the README says",
          camera);
  }
}

void Driver::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  wiimote::Link link;
  wiimote::StreamStatistics::Summary stream;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    link = link_;
    stream = statistics_.take(steadyNow());
  }
  updater_.setHardwareID(link.identity.empty() ? "none" : link.identity);

  const char* state = "searching";
  if (link.state == wiimote::Link::State::kSearching) {
    status.summary(DiagnosticStatus::ERROR,
                   link.error.empty() ? "looking for the remote" : link.error);
  } else if (link.state == wiimote::Link::State::kStarting) {
    state = "starting";
    status.summary(DiagnosticStatus::WARN,
                   link.error.empty() ? "setting up the remote" : link.error);
  } else {
    state = "streaming";
    status.summary(DiagnosticStatus::OK, "streaming");
    if (stream.rate < kLowRate)
      status.mergeSummaryf(DiagnosticStatus::WARN, "only %.0f images a second", stream.rate);
    if (link.kernel_driver == "wiimote")
      status.mergeSummary(DiagnosticStatus::WARN, "the kernel's driver hid-wiimote interferes");
    if (!link.accelerometer_calibrated)
      status.mergeSummary(DiagnosticStatus::WARN, "no accelerometer calibration in the remote");
    if (link.status && link.status->battery_low)
      status.mergeSummary(DiagnosticStatus::WARN, "the batteries are nearly empty");
  }

  status.add("Link", state);
  status.add("Device", link.description);
  status.add("Identity", link.identity);
  status.add("Kernel driver", link.kernel_driver.empty() ? "none" : link.kernel_driver);
  status.addf("Rate [Hz]", "%.1f", stream.rate);
  status.addf("Longest gap [ms]", "%.0f", 1e3 * stream.longest_gap);
  status.add("Gaps over 50 ms", stream.gaps);
  status.add("Reconnects", link.clock_epoch);
  if (link.status) {
    status.add("Battery (raw)", static_cast<int>(link.status->battery));
    status.addf("Battery [%]", "%.0f", 100.0 * protocol::batteryCharge(link.status->battery));
  }
}

}  // namespace wiimote_tracker::driver
