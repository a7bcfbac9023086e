#include "driver.h"

#include "transport/users.h"

#include <wiimote_tracker_msgs/log_exceptions.h>
#include <wiimote_tracker_msgs/parameter_reader.h>

#include <pthread.h>
#include <sched.h>
#include <signal.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <limits>
#include <utility>

namespace wiimote_tracker::driver {
namespace {

// Longest wait for a report [s], three images: only longer stops of the reader are noticed.
constexpr double kLongestRead = 0.03;
// Longest wait for a remote [s], which bounds the delay of callbacks' requests and of shutdown.
constexpr double kLongestWait = 0.1;
constexpr double kUsersCheck = 10.0;  // [s]; takes milliseconds

wiimote::Options remoteOptions(const DriverParameters& p, const RemoteSource& source) {
  wiimote::Options options = p.remote;
  options.ir_format = source.irFormat().value_or(options.ir_format);
  return options;
}

ImageStamper::Options stamperOptions(ImageStamper::Options options, protocol::IrFormat ir_format) {
  if (ir_format == protocol::IrFormat::kFull)  // two reports make an image
    options.period *= 2.0;
  return options;
}

std::shared_ptr<recording::Recorder> makeRecorder(const DriverParameters& p,
                                                  const RemoteSource& source,
                                                  const std::string& parameter) {
  if (p.record.empty())
    return nullptr;
  try {
    return std::make_shared<recording::Recorder>(p.record, source.now(),
                                                 ros::WallTime::now().toSec());
  } catch (const recording::BadRecording& e) {
    throw ParameterError(parameter + ": " + e.what());
  }
}

/// Gives the calling thread real-time priority (SCHED_FIFO, 1..99). @returns an empty string, or
/// one sentence why that failed and what to do.
std::string takeRealtimePriority(int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
  if (error == 0)
    return "";
  const std::string wanted = std::to_string(priority);
  if (error == EPERM)
    return "no permission for real-time priority " + wanted +
           ", so reports are read late when the computer is busy: put the line \"@input - rtprio " +
           wanted +
           "\" into /etc/security/limits.conf and log in again as a member of the group input, or "
           "set ~realtime_priority to 0";
  return "real-time priority " + wanted + " is refused (" + std::strerror(error) +
         "): set ~realtime_priority to 0";
}

/// A thread without signal handlers, so that none interrupts a read.
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
    : parameters_(readDriverParameters(ParameterReader(private_nh), nh.getNamespace())),
      optical_frame_(parameters_.camera_name + "_optical_frame"),
      source_(parameters_, private_nh.resolveName("device")),
      options_(remoteOptions(parameters_, source_)),
      recorder_(makeRecorder(parameters_, source_, private_nh.resolveName("record"))),
      control_(options_.leds, parameters_.rumble_max),
      wiimote_(
          options_,
          [this](bool delivered) { return open(delivered); },
          [this] { return source_.now(); }),
      camera_info_(nh,
                   parameters_.camera_name,
                   optical_frame_,
                   parameters_.camera_info_url,
                   private_nh.resolveName("camera_info_url")),
      blobs_(nh, parameters_.camera_name, optical_frame_),
      imu_(nh,
           optical_frame_,
           parameters_.camera_name + "_imu_frame",
           parameters_.linear_acceleration_stddev),
      battery_(nh, parameters_.camera_name, parameters_.battery_low),
      joy_(nh, optical_frame_),
      log_(parameters_.camera_name, !source_.recorded()),
      stamper_(stamperOptions(parameters_.stamper, options_.ir_format)),
      statistics_(steadyNow()),
      settings_(private_nh, parameters_, control_),
      feedback_(nh, parameters_.camera_name, control_),
      diagnostics_(options_.ir_format,
                   1.0 / stamperOptions(parameters_.stamper, options_.ir_format).period,
                   parameters_.battery_low),
      updater_(nh, private_nh, private_nh.getNamespace()),
      users_due_(steadyNow()) {
  if (nh.getNamespace() == "/")
    ROS_WARN(
        "the driver runs in the namespace /, so its topics are /ir_blobs and so on: start it in "
        "the camera's namespace, for example ROS_NAMESPACE=wiimote_1");
  state_.clock = stamper_.statistics();
  state_.stamp_stddev = std::numeric_limits<double>::quiet_NaN();
  state_.reader_priority = "normal";
  updater_.setHardwareID("none");
  updater_.add("Wii Remote " + parameters_.camera_name, this, &Driver::diagnose);
  diagnostics_timer_ = nh.createSteadyTimer(
      ros::WallDuration(updater_.getPeriod()), [this](const ros::SteadyTimerEvent&) {
        logExceptions(parameters_.camera_name, [this] { updater_.force_update(); });
      });
  reader_ = threadWithoutSignals([this] { run(); });
}

Driver::~Driver() {
  diagnostics_timer_.stop();
  stop_ = true;
  reader_.join();
  if (!recorder_)
    return;
  const std::string error = recorder_->finish();
  if (error != recording_error_)  // at the end of a node ROS logs nothing any more
    std::fprintf(stderr, "%s: %s\n", parameters_.camera_name.c_str(), error.c_str());
}

void Driver::run() {
  logExceptions(parameters_.camera_name, [this] {
    raisePriority();
    log_.notice(source_.notice());
  });
  while (waitForTurn())
    logExceptions(parameters_.camera_name, [this] { readAndPublish(); });
  wiimote_.close();
}

void Driver::readAndPublish() {
  control_.apply(wiimote_, source_.now());
  const auto image = wiimote_.step(kLongestRead);
  if (wiimote_.linkChanges() != seen_changes_) {
    seen_changes_ = wiimote_.linkChanges();
    linkChanged();
  }
  if (image)
    publishImage(*image);
}

// A recording cannot overflow, so it needs no priority.
void Driver::raisePriority() {
  if (parameters_.realtime_priority == 0 || source_.recorded())
    return;
  const std::string refused = takeRealtimePriority(parameters_.realtime_priority);
  if (!refused.empty())
    ROS_WARN("%s: %s", parameters_.camera_name.c_str(), refused.c_str());
  const std::lock_guard<std::mutex> lock(mutex_);
  state_.reader_priority = refused.empty()
                               ? "real time " + std::to_string(parameters_.realtime_priority)
                               : "normal: " + refused;
}

// Waits until the remote may need attention. @returns false at shutdown.
bool Driver::waitForTurn() {
  const double idle = std::min(wiimote_.idleTime(), kLongestWait);
  if (idle > 0.0 && !source_.pass(idle))
    std::this_thread::sleep_for(std::chrono::duration<double>(idle));
  return !stop_;
}

std::unique_ptr<transport::Transport> Driver::open(bool delivered) {
  auto transport = source_.open(delivered);
  if (!recorder_)
    return transport;
  return recording::record(std::move(transport), recorder_, [this] { return source_.now(); });
}

void Driver::publishImage(const protocol::DataReport& image) {
  const wiimote::Link& link = wiimote_.link();
  const ImageTime time =
      stamper_.stamp(source_.readClocks(), link.clock_epoch, wiimote_.imageWaited());
  const exposure_clock::Statistics clock = stamper_.statistics();
  const ImageStamper::Totals totals = stamper_.totals();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    statistics_.add(steadyNow());
    state_.stamp_stddev = time.stddev;
    state_.clock = clock;
    state_.totals = totals;
  }
  blobs_.publish(image, time, link.remote.identity);
  camera_info_.publish(time.stamp);
  if (image.acceleration)
    imu_.publish(*image.acceleration, wiimote_.accelerometer(), time.stamp);
  joy_.publish(image.buttons, time.stamp);
}

void Driver::linkChanged() {
  wiimote::Link now = wiimote_.link();
  if (!source_.statusKnown())
    now.status.reset();
  wiimote::Link before;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    before = std::exchange(state_.link, now);
    if (now.state == wiimote::Link::State::kStreaming && before.state != now.state)
      statistics_.begin(steadyNow());
    if (now.state == wiimote::Link::State::kSearching)
      statistics_.lose();
  }
  log_.report(now, steadyNow());
  log_.notice(source_.notice());
  const ros::Time stamp = source_.readClocks().ros;
  if (now.status && !(now.status == before.status))
    battery_.publish(*now.status, now.remote.identity, stamp);
  if (now.state == wiimote::Link::State::kStreaming && before.state != now.state)
    camera_info_.publishFactory(now.ir_calibration, stamp);
  if (now.state == wiimote::Link::State::kSearching)
    joy_.release(stamp);
}

void Driver::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  DriverState state;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    state = state_;
    state.stream = statistics_.take(steadyNow());
  }
  state.ir_sensitivity = settings_.sensitivity();
  state.replayed = source_.recorded();
  if (recorder_) {
    state.recording = recorder_->path();
    state.recording_error = recorder_->error();
    if (state.recording_error != recording_error_)
      ROS_ERROR("%s: %s", parameters_.camera_name.c_str(), state.recording_error.c_str());
    recording_error_ = state.recording_error;
  }
  if (steadyNow() >= users_due_) {
    users_due_ = steadyNow() + kUsersCheck;
    const bool is_path = state.link.remote.description.compare(0, 1, "/") == 0;
    shared_with_ = is_path ? transport::sharedWith(state.link.remote.description) : "";
  }
  state.shared_with = shared_with_;
  updater_.setHardwareID(state.link.remote.identity.empty() ? "none" : state.link.remote.identity);
  diagnostics_.describe(state, status);
  const std::string problem = camera_info_.problem();
  if (!problem.empty())
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, problem);
}

}  // namespace wiimote_tracker::driver
