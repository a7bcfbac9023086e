#include "room.h"

#include <wiimote_tracker_msgs/median.h>

#include <algorithm>
#include <limits>
#include <random>
#include <utility>

namespace wiimote_tracker::monte_carlo {
namespace {

// Of the LEDs: size as reported by the sensor [0..15], and brightness at 1 m, which with a given
// size holds at any distance (simulation::Lamp).
constexpr double kLedSize = 3.0;
constexpr double kLedBrightness = 1.0;
// Of all cameras: the middle one of the console's settings.
constexpr char kSensitivity[] = "wii_3";

bool arrivesLater(const RoomImage& a, const RoomImage& b) {
  return std::make_pair(a.image.arrival, a.camera) > std::make_pair(b.image.arrival, b.camera);
}

}  // namespace

Room::Room(const simulation::Description& description,
           const std::vector<Path>& leds,
           std::uint32_t seed,
           const Hidden& hidden)
    : leds_(leds), hidden_(hidden) {
  std::mt19937 random(seed);
  for (const simulation::CameraDescription& camera : description.cameras) {
    // Phases differ from session to session; those of the description are one draw.
    virtual_wiimote::FrameTimesModel timing = camera.timing;
    timing.phase = timing.period * (random() / 4294967296.0);
    const auto pixel_seed = static_cast<std::uint32_t>(random());
    const auto time_seed = static_cast<std::uint64_t>(random());
    virtual_wiimote::FrameTimes times(timing, time_seed);
    const virtual_wiimote::FrameTime first = times.next();
    cameras_.push_back(
        {simulation::VirtualCamera(camera.camera, description.pixel_noise, pixel_seed),
         RemoteCamera(kSensitivity), times, first, exposure_clock::ExposureClock()});
  }
}

const RoomImage& Room::next() {
  for (;;) {
    const auto camera = std::min_element(cameras_.begin(), cameras_.end(), [](auto& a, auto& b) {
      return a.coming.exposure < b.coming.exposure;
    });
    // An image arrives after its exposure, so no later exposure can come first.
    if (!on_the_way_.empty() && on_the_way_.front().image.arrival <= camera->coming.exposure)
      break;
    expose(static_cast<std::size_t>(camera - cameras_.begin()));
  }
  std::pop_heap(on_the_way_.begin(), on_the_way_.end(), arrivesLater);
  std::swap(current_, on_the_way_.back());
  on_the_way_.pop_back();
  tracking::CameraImage& image = current_.image;
  const exposure_clock::Estimate estimate = cameras_[current_.camera].clock.update(image.arrival);
  image.stamp = estimate.exposure;
  image.stamp_stddev = estimate.stddev;
  return current_;
}

void Room::expose(std::size_t number) {
  Camera& camera = cameras_[number];
  const virtual_wiimote::FrameTime frame = camera.coming;
  camera.coming = camera.times.next();
  lamps_.clear();
  for (std::size_t led = 0; led < leds_.size(); ++led) {
    if (!hidden_ || !hidden_(number, led, frame.exposure))
      lamps_.push_back({leds_[led](frame.exposure), kLedSize, kLedBrightness});
  }
  const std::vector<tracking::Spot>& spots = camera.sensor.look(camera.optics.sense(lamps_));
  if (frame.lost)
    return;
  RoomImage result;
  result.camera = number;
  result.exposure = frame.exposure;
  result.image.arrival = frame.arrival;
  result.image.spots = spots;
  on_the_way_.push_back(std::move(result));
  std::push_heap(on_the_way_.begin(), on_the_way_.end(), arrivesLater);
}

std::vector<RoomImage> record(Room* room, double duration) {
  std::vector<RoomImage> images;
  constexpr double kLatest = 1.0;  // greatest delay of an image [s]
  while (images.empty() || images.back().image.arrival < duration + kLatest)
    images.push_back(room->next());
  images.erase(std::remove_if(images.begin(), images.end(),
                              [&](const RoomImage& image) { return image.exposure > duration; }),
               images.end());
  return images;
}

std::vector<RoomImage> stampedByArrival(std::vector<RoomImage> images) {
  for (RoomImage& each : images) {
    each.image.stamp = each.image.arrival;
    each.image.stamp_stddev = std::numeric_limits<double>::quiet_NaN();  // unknown
  }
  return images;
}

double medianLateness(const std::vector<RoomImage>& images) {
  std::vector<double> lateness;
  lateness.reserve(images.size());
  for (const RoomImage& image : images)
    lateness.push_back(image.image.stamp - image.exposure);
  return medianOf(&lateness);
}

void trackImages(const geometry::Rig& rig,
                 const estimators::EstimatorOptions& options,
                 const std::vector<RoomImage>& images,
                 const std::function<void(double time, const tracking::Snapshot& snapshot)>& take) {
  const double lateness = medianLateness(images);
  const auto estimator = estimators::makeEstimator(rig, options);
  for (const RoomImage& image : images) {
    estimator->add(image.camera, image.image);
    while (const tracking::Snapshot* snapshot = estimator->next())
      take(snapshot->time - lateness, *snapshot);
  }
}

simulation::Description withCameras(const simulation::Description& description, std::size_t count) {
  simulation::Description fewer = description;
  fewer.cameras.resize(std::min(count, fewer.cameras.size()));
  return fewer;
}

geometry::Rig trueRig(const simulation::Description& description) {
  geometry::Rig rig;
  for (const simulation::CameraDescription& camera : description.cameras) {
    geometry::RigCamera known;
    known.camera = camera.camera;
    rig.cameras.push_back(known);
  }
  return rig;
}

}  // namespace wiimote_tracker::monte_carlo
