#include "tracking_diagnostics.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cmath>

namespace wiimote_tracker {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using tracking::TrackState;

// From a new rig until the images of its cameras can be judged.
const ros::WallDuration kFirstImages(1.0);

}  // namespace

TrackingDiagnostics::TrackingDiagnostics(const ros::NodeHandle& nh,
                                         const ros::NodeHandle& private_nh,
                                         MessageTracker* tracker,
                                         const LoadShedding* shedding,
                                         double clock_tolerance)
    : tracker_(tracker),
      shedding_(shedding),
      clocks_(clock_tolerance),
      lenses_(nh),
      updater_(nh, private_nh) {
  updater_.setHardwareID("none");
  updater_.add("triangulation", this, &TrackingDiagnostics::report);
}

void TrackingDiagnostics::setRig() {
  std::vector<std::string> cameras;
  for (const geometry::RigCamera& camera : tracker_->rig().cameras)
    cameras.push_back(camera.camera.name);
  nodes_.assign(cameras.size(), "");
  clocks_.clear(cameras.size());
  lenses_.setRig(tracker_->rig());
  since_ = ros::SteadyTime::now();
  updater_.wait(kFirstImages);
  updater_.setHardwareID("rig " + tracker_->rigId());
  // What is added is reported as starting, also where it was there before.
  if (cameras != cameras_)
    setCameras(cameras);
}

void TrackingDiagnostics::setCameras(const std::vector<std::string>& cameras) {
  for (const std::string& camera : cameras_)
    updater_.removeByName(camera);
  cameras_ = cameras;
  for (std::size_t i = 0; i < cameras_.size(); ++i)
    updater_.add(cameras_[i], [this, i](Status& status) { reportCamera(i, status); });
}

void TrackingDiagnostics::addArrival(const std::string& camera,
                                     const ros::Time& arrival,
                                     const ros::Time& receipt,
                                     const std::string& node) {
  // Simulated time is too coarse for a comparison.
  if (arrival.isZero() || ros::Time::isSimTime())
    return;
  const auto place = std::find(cameras_.begin(), cameras_.end(), camera);
  if (place == cameras_.end())
    return;
  const std::size_t index = place - cameras_.begin();
  nodes_[index] = node;
  clocks_.add(index, receipt.toSec() - arrival.toSec());
}

void TrackingDiagnostics::update() {
  if (!updater_.update())
    return;
  tracker_->statistics().clear();
  clocks_.clear(cameras_.size());
  since_ = ros::SteadyTime::now();
}

void TrackingDiagnostics::report(Status& status) {
  if (!tracker_->hasRig()) {
    status.summary(DiagnosticStatus::WARN,
                   "no rig: calibrate, or load a saved one; the status of the calibration's "
                   "cameras says why none was loaded");
    return;
  }
  const Statistics& statistics = tracker_->statistics();
  if (statistics.snapshots() == 0)
    status.summary(DiagnosticStatus::WARN,
                   imagesCome() ? "no image can be used: see what is said of each camera"
                                : "no images: start the cameras' drivers; those that run say in "
                                  "/diagnostics what they lack");
  else
    status.summary(DiagnosticStatus::OK, statistics.describe());
  const VolumeCorrection& correction = tracker_->correction();
  if (!correction.problem().empty())
    status.mergeSummary(DiagnosticStatus::WARN, correction.problem());
  if (shedding_->overloaded(ros::SteadyTime::now().toSec()))
    status.mergeSummary(DiagnosticStatus::WARN, LoadShedding::kAdvice);
  status.add("rig", tracker_->rigId());
  status.add("correction of the volume", correction.state());
  status.add("LEDs tracked", statistics.leds(TrackState::kTracked));
  status.add("LEDs predicted", statistics.leds(TrackState::kPredicted));
  status.add("LEDs tentative", statistics.leds(TrackState::kTentative));
  status.add("LEDs with doubtful labels", joined(tracker_->labels().doubtfulNow()));
  status.addf("rate [Hz]", "%.1f", statistics.snapshots() / period());
  status.addf("latency p50 [ms]", "%.3f", 1e3 * statistics.latency(0.50));
  status.addf("latency p99 [ms]", "%.3f", 1e3 * statistics.latency(0.99));
  const tracking::Counters& counters = tracker_->counters();
  status.add("images older than one already used (normal)", counters.late);
  status.add("images dropped: too late, or by a wrong clock", counters.dropped);
  status.add("images dropped because they waited", shedding_->dropped());
  status.add("images repeated", counters.repeated);
  status.add("images out of the order of arrival", counters.disordered);
  status.add("restarts because time jumped back", counters.resets);
}

/// Whether any came in the period, also such that cannot be used.
bool TrackingDiagnostics::imagesCome() const {
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    const CameraStatistics& camera = tracker_->statistics().camera(i);
    if (camera.images > 0 || !camera.problem.empty())
      return true;
  }
  return false;
}

void TrackingDiagnostics::reportCamera(std::size_t camera, Status& status) {
  const CameraStatistics& statistics = tracker_->statistics().camera(camera);
  status.summary(DiagnosticStatus::OK, "in use");
  if (statistics.images == 0 && statistics.problem.empty())
    status.summary(
        DiagnosticStatus::WARN,
        std::string("no images: start its driver, or do what that says in /diagnostics; check the "
                    "network if it runs on another computer") +
            (cameras_.size() > 2 ? "; if it is gone for good, remove it (R in calibrate)" : ""));
  for (const std::string& problem :
       {statistics.problem, describeLights(statistics, cameras_[camera]),
        lenses_.problemOf(cameras_[camera]), clockProblem(camera),
        tracker_->statistics().describeClock(camera, cameras_[camera])}) {
    if (!problem.empty())
      status.mergeSummary(DiagnosticStatus::WARN, problem);
  }
  status.addf("images [Hz]", "%.1f", statistics.images / period());
  status.add("images lost since the last report", statistics.lost);
  status.addf("delay from exposure to arrival [ms]", "%.3f", 1e3 * statistics.meanDelay());
  status.addf("spots that belong to an LED [%]", "%.1f", 100.0 * statistics.inlierRatio());
  status.addf("residual [px]", "%.3f", statistics.residual());
  status.add("spots masked", statistics.masked);
}

std::string TrackingDiagnostics::clockProblem(std::size_t camera) const {
  const auto ahead = clocks_.ahead(camera);
  if (!ahead)
    return "";
  return format("the clock of the driver of %s (%s) is %.3f s %s: run chrony on all computers",
                cameras_[camera].c_str(), nodes_[camera].c_str(), std::abs(*ahead),
                *ahead > 0.0 ? "ahead" : "behind, or its network is slow");
}

}  // namespace wiimote_tracker
