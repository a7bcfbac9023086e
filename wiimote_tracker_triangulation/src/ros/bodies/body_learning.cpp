#include "body_learning.h"

#include "../callbacks.h"
#include "../tracker/body_parameters.h"
#include "body/bodies_file.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <utility>

namespace wiimote_tracker {
namespace {

using body::Constellation;
using wiimote_tracker_msgs::TrackedPoint;

constexpr double kDefaultDuration = 3.0;  // [s]
constexpr double kShortest = 0.5;         // [s]
constexpr double kLongest = 60.0;         // [s]
// Time for the LEDs of a tracked body to become tracks of their own [s].
constexpr double kUntilFree = 0.5;
// After this time without points the service gives up [s].
constexpr int kSilence = 5;
constexpr std::size_t kMostNamed = 10;  // labels that were seen, in an answer

double stddevOf(const TrackedPoint& point) {
  const auto& c = point.position_covariance;
  return std::sqrt((c[0] + c[4] + c[8]) / 3.0);
}

std::vector<Constellation> without(const std::string& name, std::vector<Constellation> bodies) {
  bodies.erase(std::remove_if(bodies.begin(), bodies.end(),
                              [&](const Constellation& body) { return body.name == name; }),
               bodies.end());
  return bodies;
}

/// Labels of a body's LEDs in their order, if all blink.
std::vector<std::string> labelsOf(const std::vector<std::uint32_t>& ids,
                                  const std::map<std::uint32_t, std::string>& blinks) {
  std::vector<std::string> labels;
  for (const std::uint32_t id : ids) {
    const auto label = blinks.find(id);
    if (label == blinks.end())
      return {};
    labels.push_back(label->second);
  }
  return labels;
}

/// Which labels of a request no LED had; empty if none, or if no LED was seen at all.
std::string describeUnseen(const std::vector<std::string>& labels,
                           const std::set<std::string>& seen) {
  std::vector<std::string> unseen;
  for (const std::string& label : labels) {
    if (seen.count(label) == 0)
      unseen.push_back(label);
  }
  if (unseen.empty() || seen.empty())
    return "";
  std::vector<std::string> others(seen.begin(), seen.end());
  if (others.size() > kMostNamed) {
    others.resize(kMostNamed);
    others.push_back("others");
  }
  return "no LED with the label " + joined(unseen) + " was seen, but " + joined(others) +
         ": correct labels, or bring all of its LEDs in view";
}

/// @param unseen sentence about labels that no LED had, or empty.
/// @throws Error, with that sentence.
body::LearnedConstellation learnFrom(const std::string& name,
                                     const std::vector<body::LedsInstant>& instants,
                                     const std::string& unseen) {
  try {
    return body::learnConstellation(name, instants);
  } catch (const Error& e) {
    if (unseen.empty())
      throw;
    const bool has_leds = std::any_of(instants.begin(), instants.end(),
                                      [](const auto& instant) { return !instant.leds.empty(); });
    throw Error(has_leds ? std::string(e.what()) + "; " + unseen : unseen);
  }
}

}  // namespace

BodyLearning::BodyLearning(const ros::NodeHandle& nh,
                           const std::string& file,
                           const std::vector<Constellation>& bodies,
                           const std::vector<std::string>& names,
                           const std::vector<std::string>& codes)
    : file_(file),
      names_(names),
      codes_(codes.begin(), codes.end()),
      bodies_(bodies),
      guard_(file),
      spinner_(1, &queue_) {
  ros::NodeHandle handle(nh);
  handle.setCallbackQueue(&queue_);
  server_ = handle.advertiseService("learn_body", &BodyLearning::onRequest, this);
  spinner_.start();
}

BodyLearning::~BodyLearning() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_over_ = true;
  }
  changed_.notify_all();
  server_.shutdown();
  spinner_.stop();
}

void BodyLearning::setRig(const geometry::Rig& rig) {
  const std::lock_guard<std::mutex> lock(mutex_);
  frames_ = rig.frames();
}

void BodyLearning::addPoints(const wiimote_tracker_msgs::TrackedPointArray& points) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!is_collecting_)
    return;
  body::LedsInstant instant{points.header.stamp.toSec(), {}};
  std::vector<body::LedsInstant>& instants = collected_.instants;
  if (!instants.empty() && instant.time < instants.back().time) {
    instants.clear();
    ++collected_.jumps;
  }
  for (const TrackedPoint& point : points.points) {
    if (point.state != TrackedPoint::TRACKED)
      continue;
    collected_.seen_labels.insert(point.label);
    if (!labels_.empty() && labels_.count(point.label) == 0)
      continue;
    instant.leds.push_back({point.id, vectorOf(point.position), stddevOf(point)});
    if (codes_.count(point.label) > 0)
      collected_.blinks[point.id] = point.label;
  }
  instants.push_back(instant);
  // Between two jumps lies a whole round of a bag that is played in a loop.
  is_collecting_ = collected_.jumps < 2 && instant.time - instants.front().time < duration_;
  changed_.notify_all();
}

std::optional<std::vector<Constellation>> BodyLearning::change() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(change_, std::nullopt);
}

bool BodyLearning::onRequest(LearnBody::Request& request, LearnBody::Response& response) {
  return answer(&response, [&] {
    check(request);
    track(without(request.name, bodies_));
    try {
      return learn(request, collect(request), &response);
    } catch (...) {
      track(bodies_);
      throw;
    }
  });
}

/// @throws Error: it is refused.
void BodyLearning::check(const LearnBody::Request& request) {
  if (file_.empty())
    throw Error("there is no file for bodies; set the parameter bodies/file");
  if (request.duration != 0.0 && !(request.duration >= kShortest && request.duration <= kLongest))
    throw Error("duration must be 0, or from 0.5 to 60 s");
  if (std::find(names_.begin(), names_.end(), request.name) != names_.end())
    throw Error("'" + request.name + "' is the name of an LED; choose another one");
  std::set<std::string> labels;
  for (const std::string& label : request.labels) {
    if (!labels.insert(label).second)
      throw Error("labels has '" + label + "' twice; name each LED once");
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (std::find(frames_.begin(), frames_.end(), request.name) != frames_.end())
      throw Error("'" + request.name + "' is the name of a frame of the rig; choose another one");
  }
  guard_.check();
  // Checks only the name.
  Constellation{request.name, {{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}, {0.0, 0.2, 0.0}}}.check();
}

BodyLearning::Collected BodyLearning::collect(const LearnBody::Request& request) {
  std::unique_lock<std::mutex> lock(mutex_);
  const bool was_tracked = without(request.name, bodies_).size() < bodies_.size();
  duration_ = request.duration == 0.0 ? kDefaultDuration : request.duration;
  labels_ = {request.labels.begin(), request.labels.end()};
  const double until_free = was_tracked ? kUntilFree : 0.0;
  duration_ += until_free;
  collected_ = {};
  is_collecting_ = true;
  while (is_collecting_ && !is_over_) {
    const std::size_t count = collected_.instants.size();
    const bool has_news = changed_.wait_for(lock, std::chrono::seconds(kSilence), [&] {
      return is_over_ || !is_collecting_ || collected_.instants.size() != count;
    });
    if (!has_news) {
      is_collecting_ = false;
      throw Error("no points came for 5 s; calibrate the cameras and start their drivers");
    }
  }
  if (is_over_)
    throw Error("the tracker was stopped");
  if (collected_.jumps > 1)
    throw Error(
        "time jumped back twice before it was seen long enough, as where a bag is played in a "
        "loop: give a shorter duration, or play a longer bag");
  Collected result = std::move(collected_);
  const double begin = result.instants.front().time + until_free;
  result.instants.erase(result.instants.begin(),
                        std::find_if(result.instants.begin(), result.instants.end(),
                                     [&](const auto& instant) { return instant.time >= begin; }));
  return result;
}

/// @returns the answer.
std::string BodyLearning::learn(const LearnBody::Request& request,
                                const Collected& collected,
                                LearnBody::Response* response) {
  const std::string unseen = describeUnseen(request.labels, collected.seen_labels);
  body::LearnedConstellation learned = learnFrom(request.name, collected.instants, unseen);
  learned.constellation.labels = labelsOf(learned.ids, collected.blinks);
  learned.constellation.check();
  const body::Symmetry symmetry = body::nearestSymmetry(learned.constellation);
  response->stddev = learned.stddev;
  response->symmetry = symmetry.residual;
  for (const Eigen::Vector3d& led : learned.constellation.leds)
    response->leds.push_back(pointOf(led));
  const bool had_imu = std::any_of(bodies_.begin(), bodies_.end(), [&](const Constellation& body) {
    return body.name == request.name && body.imu;
  });
  std::vector<Constellation> bodies = without(request.name, bodies_);
  std::vector<std::string> warnings = shapeWarnings({learned.constellation});
  for (const Constellation& other : bodies) {
    if (const auto twins = body::describeTwins(other, learned.constellation))
      warnings.push_back(*twins);
  }
  if (!unseen.empty())
    warnings.push_back(unseen);
  bodies.push_back(learned.constellation);
  guard_.check();
  const bool replaces = bodies.size() <= bodies_.size();
  body::writeBodies(file_, bodies);
  guard_.update();
  bodies_ = bodies;
  track(bodies_);
  std::string message = "body '" + request.name + "' with " +
                        std::to_string(learned.constellation.leds.size()) + " LEDs is in " + file_ +
                        " and tracked from now on";
  if (replaces)
    message += "; the body that had this name before is in " + file_ + ".bak";
  if (had_imu)
    message += "; find its IMU again by body_to_base --imu, since its axes have changed";
  for (const std::string& warning : warnings)
    message += "; but " + warning;
  return message;
}

/// Gives the bodies to the tracker's thread.
void BodyLearning::track(const std::vector<Constellation>& bodies) {
  const std::lock_guard<std::mutex> lock(mutex_);
  change_ = bodies;
}

}  // namespace wiimote_tracker
