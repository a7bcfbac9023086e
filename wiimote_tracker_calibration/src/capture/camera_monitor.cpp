#include "capture/camera_monitor.h"

#include <wiimote_tracker_msgs/text.h>

namespace wiimote_tracker::capture {

namespace {

// Least share of images with exactly one spot: at the edge of the field of view the LED is
// missed now and then.
constexpr double kShareWithOneSpot = 0.9;

}  // namespace

std::string spotCountProblem(std::size_t blobs) {
  if (blobs == 0)
    return "sees no spot: turn the camera or the LED towards each other and clear the way between "
           "them";
  if (blobs > 1)
    return "sees " + std::to_string(blobs) +
           " spots: switch off other lights and cover reflections until one is left";
  return "";
}

std::string stampProblem(double stamp, double delay) {
  if (stamp <= 0.0)
    return "sends images without stamps: repair its driver, or, when no bag is played, run  "
           "rosparam set /use_sim_time false  and start all nodes again";
  if (delay > kLongestDelay)
    return format(
        "sends images that are %.1f s old by their stamps: set the clock of its computer, or "
        "play a bag with --clock",
        delay);
  return "";
}

std::string listOfProblems(const std::vector<std::pair<std::string, std::string>>& problems) {
  std::vector<std::string> different;
  for (const auto& [first, problem] : problems) {
    std::vector<std::string> names;
    for (const auto& [name, same] : problems) {
      if (same == problem)
        names.push_back(name);
    }
    if (names.front() == first)
      different.push_back((names.size() > 1 ? "each of " : "") + joined(names) + " " + problem);
  }
  return joined(different, "; ");
}

void CameraMonitor::add(double time, const Blobs& blobs, double arrival) {
  arrival_ = arrival;
  if (!images_.empty() && time < images_.back().time - kLongestDelay)
    images_.clear();
  images_.push_back({time, blobs.size()});
  if (!blobs.empty())
    first_blob_ = blobs.front();
  while (images_.front().time < time - kMemory)
    images_.pop_front();
}

CameraSummary CameraMonitor::summary(double now, double window) const {
  CameraSummary summary;
  std::size_t count = 0;
  std::size_t with_one_spot = 0;
  double first = 0.0;
  for (const Image& image : images_) {
    if (image.time < now - window)
      continue;
    if (count == 0)
      first = image.time;
    ++count;
    with_one_spot += image.blobs == 1;
  }
  if (count == 0) {
    if (!images_.empty() && (images_.back().time <= 0.0 || arrival_ >= now - window))
      summary.problem = stampProblem(images_.back().time, arrival_ - images_.back().time);
    if (summary.problem.empty())
      summary.problem = kSendsNoImages;
    return summary;
  }

  summary.connected = true;
  const double duration = images_.back().time - first;
  if (duration > 0.0)
    summary.rate = static_cast<double>(count - 1) / duration;
  summary.blobs = images_.back().blobs;
  if (summary.blobs != 1) {
    summary.problem = spotCountProblem(summary.blobs);
  } else if (static_cast<double>(with_one_spot) < kShareWithOneSpot * static_cast<double>(count)) {
    summary.problem =
        "sees exactly one spot in " + std::to_string(100 * with_one_spot / count) +
        " % of its images only: bring the LED nearer or turn it towards the camera, and "
        "remove other lights";
  } else {
    summary.sees_led = true;
    summary.pixel = first_blob_;
  }
  return summary;
}

}  // namespace wiimote_tracker::capture
