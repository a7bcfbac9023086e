#include "ros/measurements/sample_table.h"

#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::measurements {
namespace {

constexpr double kLongestGap = 0.05;      // [s]
constexpr double kLongestInFrames = 1.5;  // at low rates
constexpr double kMostPositions = 2e8;    // 4.8 GB; 28 h of 20 LEDs at 100 Hz
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double seconds(std::int64_t nanoseconds) {
  return 1e-9 * static_cast<double>(nanoseconds);
}

}  // namespace

void SampleTable::add(const Measurement& m) {
  if (m.led.state == wiimote_tracker_msgs::TrackedPoint::TRACKED && !m.triggered)
    samples_[{false, m.led.label}].push_back(
        {nanosecondsOf(m.message.header.stamp), vectorOf(m.led.position)});
}

void SampleTable::addBodies(const wiimote_tracker_msgs::TrackedBodyArray& bodies) {
  for (const wiimote_tracker_msgs::TrackedBody& body : bodies.bodies) {
    if (body.state != wiimote_tracker_msgs::TrackedBody::TRACKED)
      continue;
    for (const wiimote_tracker_msgs::BodyLed& led : body.leds)
      samples_[{true, body.name + ":" + led.label}].push_back(
          {nanosecondsOf(bodies.header.stamp), vectorOf(led.position)});
  }
}

Samples SampleTable::resample(double rate) const {
  const double longest = std::max(kLongestGap, kLongestInFrames / rate);
  const auto isEarlier = [](const Sample& a, const Sample& b) { return a.stamp < b.stamp; };
  std::int64_t first = std::numeric_limits<std::int64_t>::max();
  std::int64_t last = 0;
  for (const auto& [name, samples] : samples_) {
    const auto ends = std::minmax_element(samples.begin(), samples.end(), isEarlier);
    first = std::min(first, ends.first->stamp);
    last = std::max(last, ends.second->stamp);
  }
  Samples result;
  result.rate = rate;
  if (samples_.empty())
    return result;
  result.start = first;
  const double frames = std::floor(seconds(last - first) * rate + 1e-6) + 1.0;
  const double positions = frames * static_cast<double>(samples_.size());
  if (positions > kMostPositions)
    throw Error(
        format("the recording spans %.1f h, %.0f frames of C3D or TRC, and has %zu LEDs: %.0f "
               "positions, but %.0f are the most: cut it where its clock was set, lower the rate, "
               "or mask reflections, which count as LEDs",
               seconds(last - first) / 3600.0, frames, samples_.size(), positions, kMostPositions));
  result.frames = static_cast<std::size_t>(frames);
  for (const auto& [name, recorded] : samples_) {
    std::vector<Sample> samples = recorded;
    std::stable_sort(samples.begin(), samples.end(), isEarlier);
    std::vector<Eigen::Vector3d> positions(result.frames, Eigen::Vector3d::Constant(kNaN));
    std::size_t next = 0;  // the first sample at or after the frame
    for (std::size_t frame = 0; frame < result.frames; ++frame) {
      const auto time =
          first + static_cast<std::int64_t>(std::llround(1e9 * static_cast<double>(frame) / rate));
      while (next < samples.size() && samples[next].stamp < time)
        ++next;
      if (next == samples.size())
        break;
      const Sample& after = samples[next];
      if (after.stamp == time) {
        positions[frame] = after.position;
      } else if (next > 0 && seconds(after.stamp - samples[next - 1].stamp) <= longest) {
        const Sample& before = samples[next - 1];
        const double share = seconds(time - before.stamp) / seconds(after.stamp - before.stamp);
        positions[frame] = before.position + share * (after.position - before.position);
      }
    }
    result.labels.push_back(name.second);
    result.positions.push_back(std::move(positions));
  }
  return result;
}

}  // namespace wiimote_tracker::measurements
