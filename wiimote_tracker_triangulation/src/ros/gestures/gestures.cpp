#include "gestures.h"

#include "../callbacks.h"
#include "../marker_parts.h"
#include "gesture/examples_file.h"
#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/geometry/yaml_map.h"
#include "wiimote_tracker_triangulation/ros/conversions.h"

#include <visualization_msgs/MarkerArray.h>
#include <wiimote_tracker_msgs/GestureEvent.h>
#include <wiimote_tracker_msgs/free_name.h>
#include <wiimote_tracker_msgs/text.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

namespace wiimote_tracker {

using visualization_msgs::Marker;
using wiimote_tracker_msgs::GestureEvent;
using wiimote_tracker_msgs::TrackedPoint;

namespace {

// Time jumps back when a bag is restarted; smaller steps back are ignored.
constexpr double kJump = 1.0;  // [s]

// LEDs that may draw at the same time; others are ignored.
constexpr std::size_t kMostHands = 64;

}  // namespace

Gestures::Hand::Hand(std::uint32_t led,
                     const GestureParameters& parameters,
                     const ButtonTimes& button)
    : id(led), segmenter(parameters.segmenter), spotter(parameters.spotter) {
  if (button.pressed)
    segmenter.button(*button.pressed, true);
  if (button.released)
    segmenter.button(*button.released, false);
}

Gestures::Gestures(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh)
    : nh_(nh),
      parameters_(GestureParameters::read(ParameterReader(private_nh))),
      guard_(parameters_.file),
      recognizer_(parameters_.recognizer) {
  std::error_code unknown;  // whether it exists; reading it says why
  if (std::filesystem::exists(parameters_.file, unknown) || unknown) {
    for (const gesture::Example& example : gesture::readExamples(parameters_.file))
      recognizer_.add(example);
    ROS_INFO("%s of gestures from %s.", counted(recognizer_.examples().size(), "example").c_str(),
             parameters_.file.c_str());
  } else {
    ROS_INFO("There are no gestures yet: record some with the service %s.",
             nh_.resolveName("gestures/record").c_str());
  }
  events_publisher_ = nh_.advertise<GestureEvent>("gestures", 20);
  markers_publisher_ = nh_.advertise<visualization_msgs::MarkerArray>("gesture_markers", 5);
  services_ = {nh_.advertiseService("gestures/record", &Gestures::record, this),
               nh_.advertiseService("gestures/remove", &Gestures::remove, this),
               nh_.advertiseService("gestures/list", &Gestures::list, this)};
  rig_.start(nh_, [this](const auto& message) { onRig(message); });
  points_subscriber_ = subscribe<wiimote_tracker_msgs::TrackedPointArray>(
      nh_, "points", 200, [this](const auto& event) { onPoints(*event.getConstMessage()); });
  if (parameters_.segmenter.boundary == gesture::Boundary::kButton)
    joy_subscriber_ = subscribe<sensor_msgs::Joy>(
        nh_, "joy", 50, [this](const auto& event) { onJoy(*event.getConstMessage()); });
}

void Gestures::writeExamples(const gesture::Recognizer& recognizer) {
  guard_.check();
  gesture::writeExamples(parameters_.file, recognizer.examples());
  guard_.update();
}

void Gestures::onRig(const wiimote_tracker_msgs::RigCalibration& message) {
  try {
    zones_ = fromMessage(message).zones;
  } catch (const geometry::Error& e) {
    ROS_ERROR("The zones of the rig on %s are not used: %s", rig_.topic().c_str(), e.what());
  }
}

void Gestures::onPoints(const wiimote_tracker_msgs::TrackedPointArray& message) {
  const double time = message.header.stamp.toSec();
  if (isStray(time))
    return;
  if (time < time_ - kJump) {
    hands_.clear();
    if (button_.pressed && *button_.pressed > time + kJump)
      button_ = {};
    ROS_WARN_THROTTLE(10.0, "Time jumped back by more than %.0f s; all gestures are reset.", kJump);
  }
  time_ = time;
  world_frame_ = message.header.frame_id;
  if (joy_subscriber_ && joy_subscriber_.getNumPublishers() == 0)
    ROS_WARN_DELAYED_THROTTLE(5.0,
                              "Nobody publishes %s, whose button marks gestures: name the topic by "
                              "joy:=, such as joy:=/wiimote_1/joy, or start its driver.",
                              joy_subscriber_.getTopic().c_str());
  for (const TrackedPoint& point : message.points)
    onPoint(point, time);

  // Remove LEDs that are gone.
  for (auto place = hands_.begin(); place != hands_.end();) {
    Hand& hand = place->second;
    if (const auto spotted = hand.spotter.advance(time))
      publish(GestureEvent::RECOGNISED, spotted->recognition, spotted->path, hand);
    if (const auto path = hand.segmenter.advance(time))
      onGesture(*path, hand);
    const bool gone = std::none_of(
        message.points.begin(), message.points.end(),
        [&](const TrackedPoint& p) { return p.id == hand.id && p.state != TrackedPoint::LOST; });
    // The segmenter needs some time to end a gesture.
    place = gone && time > hand.last_seen + 2.0 * parameters_.segmenter.dark_time
                ? hands_.erase(place)
                : std::next(place);
  }
}

/// One message of quite another time may be another program's. Time has jumped when a second
/// follows.
bool Gestures::isStray(double time) {
  stray_ = !stray_ && std::fabs(time - time_) > kJump;
  return stray_;
}

void Gestures::onPoint(const TrackedPoint& point, double time) {
  // One camera suffices to see that the light is on.
  const bool is_on = point.state == TrackedPoint::TRACKED ||
                     (point.state == TrackedPoint::PREDICTED && point.rays_used > 0);
  if (!is_on)
    return;
  if (!parameters_.labels.empty() && std::find(parameters_.labels.begin(), parameters_.labels.end(),
                                               point.label) == parameters_.labels.end())
    return;
  if (hands_.size() >= kMostHands && hands_.count(point.id) == 0)
    return;
  Hand& hand = hands_.try_emplace(point.id, point.id, parameters_, button_).first->second;
  hand.label = point.label;
  if (time - hand.last_seen > parameters_.segmenter.dark_time)
    hand.on_since = time;
  hand.last_seen = time;
  if (parameters_.segmenter.boundary == gesture::Boundary::kLight &&
      time - hand.on_since > parameters_.segmenter.maximum_duration)
    ROS_WARN_THROTTLE(60.0,
                      "'%s' is on for more than %g s, but with boundary light a gesture ends when "
                      "its LED is switched off: switch it off, set boundary to rest, or name the "
                      "LEDs that draw in labels.",
                      hand.label.c_str(), parameters_.segmenter.maximum_duration);
  const gesture::PathPoint here{time, vectorOf(point.position)};
  // An example needs a start and an end.
  if (parameters_.continuous && !wanted_) {
    const auto recognize = [this](const auto& path) {
      return recognizer_.recognize(path, zoneOf(path));
    };
    if (const auto spotted = hand.spotter.add(here, recognize))
      publish(GestureEvent::RECOGNISED, spotted->recognition, spotted->path, hand);
  }
  if (const auto path = hand.segmenter.add(here, point.last_observed.toSec()))
    onGesture(*path, hand);
}

void Gestures::onJoy(const sensor_msgs::Joy& message) {
  const auto index = static_cast<std::size_t>(parameters_.button);
  if (index >= message.buttons.size()) {
    ROS_ERROR_THROTTLE(10.0, "%s has %s and none with index %d; set ~button.",
                       joy_subscriber_.getTopic().c_str(),
                       counted(message.buttons.size(), "button").c_str(), parameters_.button);
    return;
  }
  const bool pressed = message.buttons[index] != 0;
  const double time = message.header.stamp.toSec();
  if (button_.pressed && time < *button_.pressed - kJump) {
    // A bag starts over: a button that was held there is not released before it is pressed again.
    button_ = {};
    hands_.clear();
  }
  const bool was_pressed = button_.pressed && !button_.released;
  if (pressed == was_pressed)
    return;
  if (pressed)
    button_ = {time, std::nullopt};
  else
    button_.released = time;
  for (auto& [id, hand] : hands_) {
    if (const auto path = hand.segmenter.button(time, pressed))
      onGesture(*path, hand);
  }
}

void Gestures::onGesture(const gesture::Path& path, const Hand& hand) {
  if (wanted_) {
    keepExample(path, hand);
    return;
  }
  if (parameters_.continuous)  // the spotter finds gestures
    return;
  if (const auto recognition = recognizer_.recognize(path, zoneOf(path)))
    publish(recognition->accepted() ? GestureEvent::RECOGNISED : GestureEvent::REJECTED,
            *recognition, path, hand);
}

void Gestures::keepExample(const gesture::Path& path, const Hand& hand) {
  if (!gesture::shapeOf(path, parameters_.recognizer.shape)) {  // wait for a longer one
    ROS_WARN_THROTTLE(5.0,
                      "The example of '%s' is too short to be a gesture; draw it again, larger.",
                      wanted_->gesture.c_str());
    return;
  }
  gesture::Example example = *wanted_;
  example.path = path;
  wanted_.reset();
  gesture::Recognizer with_it = recognizer_;
  with_it.add(example);
  try {
    writeExamples(with_it);
  } catch (const Error& e) {
    ROS_ERROR("The example of '%s' is not kept: %s", example.gesture.c_str(), e.what());
    return;
  }
  recognizer_ = with_it;
  ROS_INFO("An example of '%s', %.1f s long, is kept in %s.", example.gesture.c_str(),
           path.back().time - path.front().time, parameters_.file.c_str());
  publish(GestureEvent::RECORDED, {example.gesture, 1.0, "", 0.0}, path, hand);
}

void Gestures::publish(std::uint8_t event,
                       const gesture::Recognition& recognition,
                       const gesture::Path& path,
                       const Hand& hand) {
  GestureEvent message;
  message.header.stamp.fromSec(path.back().time);
  message.header.frame_id = world_frame_;
  message.event = event;
  message.gesture = recognition.gesture;
  message.score = static_cast<float>(recognition.score);
  message.runner_up = recognition.runner_up;
  message.runner_up_score = static_cast<float>(recognition.runner_up_score);
  message.id = hand.id;
  message.label = hand.label;
  message.zone = zoneOf(path);
  message.begin.fromSec(path.front().time);
  message.end.fromSec(path.back().time);
  Eigen::AlignedBox3d box;
  for (const gesture::PathPoint& point : path)
    box.extend(point.position);
  message.minimum = pointOf(box.min());
  message.maximum = pointOf(box.max());
  events_publisher_.publish(message);
  if (markers_publisher_.getNumSubscribers() > 0) {
    static const char* const kWords[] = {"", " (rejected)", " (recorded)"};
    draw(recognition.gesture + kWords[event], path, hand.id);
  }
}

/// Shows the path and its name for a few seconds.
void Gestures::draw(const std::string& text, const gesture::Path& path, std::uint32_t id) {
  constexpr double kLifetime = 3.0;     // [s]
  constexpr double kTextHeight = 0.15;  // [m]
  const markers::Common common{world_frame_, path.back().time, kLifetime};
  const std_msgs::ColorRGBA orange = markers::color(1.0f, 0.6f, 0.0f, 1.0f);
  Marker line = markers::marker(common, "way", id, Marker::LINE_STRIP, markers::kLine, orange);
  for (const gesture::PathPoint& point : path)
    line.points.push_back(pointOf(point.position));
  visualization_msgs::MarkerArray array;
  array.markers = {line, markers::textAbove(common, "name", id, path.back().position, text, orange,
                                            kTextHeight)};
  markers_publisher_.publish(array);
}

/// @throws Error: an example cannot be recorded.
void Gestures::check(const wiimote_tracker_msgs::RecordGesture::Request& request) const {
  if (request.gesture.find(geometry::kUnreadableText) != std::string::npos)
    throw Error("the file of examples cannot have a name with '" +
                std::string(geometry::kUnreadableText) + "'; choose another one");
  if (!isFreeName(request.gesture))
    throw Error("a gesture's name must have " + std::string(kFreeName) + "; choose another one");
  const bool known_zone = request.zone.empty() ||
                          std::any_of(zones_.begin(), zones_.end(),
                                      [&](const auto& zone) { return zone.name == request.zone; });
  if (!known_zone)
    throw Error("the rig has no zone '" + request.zone + "'; name one of its zones, or none");
  guard_.check();
}

bool Gestures::record(wiimote_tracker_msgs::RecordGesture::Request& request,
                      wiimote_tracker_msgs::RecordGesture::Response& response) {
  return answer(&response, [&]() -> std::string {
    if (request.gesture.empty()) {
      wanted_.reset();
      return "recording is cancelled";
    }
    check(request);
    wanted_ = gesture::Example{request.gesture, request.zone, {}};
    return "the next movement is kept as an example of '" + request.gesture +
           "', also one to where it begins; gestures/remove drops all of '" + request.gesture + "'";
  });
}

bool Gestures::remove(wiimote_tracker_msgs::RemoveGesture::Request& request,
                      wiimote_tracker_msgs::RemoveGesture::Response& response) {
  return answer(&response, [&] {
    gesture::Recognizer without = recognizer_;
    const std::size_t removed = without.remove(request.gesture);
    if (removed == 0)
      throw Error("there is no gesture '" + request.gesture + "'; see gestures/list");
    writeExamples(without);
    recognizer_ = without;
    return "removed " + counted(removed, "example") + " of '" + request.gesture + "'";
  });
}

bool Gestures::list(wiimote_tracker_msgs::ListGestures::Request&,
                    wiimote_tracker_msgs::ListGestures::Response& response) {
  std::map<std::pair<std::string, std::string>, std::uint32_t> examples;
  for (const gesture::Example& example : recognizer_.examples())
    ++examples[{example.gesture, example.zone}];
  for (const auto& [gesture_and_zone, count] : examples) {
    response.gestures.push_back(gesture_and_zone.first);
    response.zones.push_back(gesture_and_zone.second);
    response.examples.push_back(count);
  }
  return true;
}

/// The first zone that contains the middle of the path.
std::string Gestures::zoneOf(const gesture::Path& path) const {
  const Eigen::Vector3d& middle = path[path.size() / 2].position;
  const auto zone = std::find_if(zones_.begin(), zones_.end(), [&](const geometry::Zone& z) {
    return (middle.array() >= z.minimum.array()).all() &&
           (middle.array() <= z.maximum.array()).all();
  });
  return zone == zones_.end() ? "" : zone->name;
}

}  // namespace wiimote_tracker
