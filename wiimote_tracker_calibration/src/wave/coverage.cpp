#include "wave/coverage.h"

#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/triangulate.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace wiimote_tracker::wave {

namespace {

// Speeds are taken over this time [s]; a spot slower than this [px/s] is still.
constexpr double kSpan = 0.1;
constexpr double kStill = 30.0;
// Steps of the speeds' counts.
constexpr double kImageSpeedStep = 20.0;  // [px/s]
constexpr double kSpeedStep = 0.05;       // [m/s]
// Steps of time in which a camera saw the LED or did not [s].
constexpr double kTimeStep = 0.1;
// Edge of the volume's cells [m].
constexpr double kCell = 0.25;
// Images of two cameras this close are of one time [s].
constexpr double kSameTime = 0.012;
// Time a camera must share with others to be solved [s].
constexpr double kLeastTogether = 3.0;

/// Where in the image most cells are still empty; of equals the one nearer to the middle.
std::string emptiestPart(const capture::ImageCells& cells) {
  struct Part {
    const char* name;
    std::size_t row;
    std::size_t column;
  };
  const Part kParts[] = {{"middle", 1, 1},    {"top", 0, 1},         {"bottom", 2, 1},
                         {"left", 1, 0},      {"right", 1, 2},       {"top left", 0, 0},
                         {"top right", 0, 2}, {"bottom left", 2, 0}, {"bottom right", 2, 2}};
  double least = 2.0;
  std::string name;
  for (const Part& part : kParts) {
    int filled = 0;
    int all = 0;
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
      if (cell / capture::kCellColumns * 3 / capture::kCellRows != part.row ||
          cell % capture::kCellColumns * 3 / capture::kCellColumns != part.column)
        continue;
      ++all;
      filled += cells[cell] ? 1 : 0;
    }
    const double share = static_cast<double>(filled) / all;
    if (share < least) {
      least = share;
      name = part.name;
    }
  }
  return name;
}

/// With two decimals. Rounded up, what is too little would show as enough.
std::string roundedDown(double value) {
  return format("%.2f", 0.01 * std::floor(100.0 * value));
}

/// What to do until the wave is enough, most urgent first.
std::vector<std::string> missing(const CoverageReport& report, const CoverageOptions& options) {
  std::vector<std::string> result;
  for (const CameraCoverage& camera : report.cameras) {
    if (camera.seconds == 0.0)
      result.push_back(camera.name +
                       " has not seen the LED move: wave it where it looks, or cover the light it "
                       "sees instead");
    else if (camera.together < kLeastTogether)
      result.push_back(camera.name + " and another camera have seen the LED together for " +
                       format("%.0f s", camera.together) + " only: wave it where both look");
    if (camera.distraction > options.distraction)
      result.push_back(camera.name + " sees other lights in " +
                       format("%.0f %%", 100.0 * camera.distraction) +
                       " of its images: cover lamps and what reflects");
  }
  for (const CameraCoverage& camera : report.cameras) {
    if (camera.seconds > 0.0 && camera.image_share < options.image_share)
      result.push_back(camera.name + " has seen the LED in " +
                       format("%.0f %%", 100.0 * camera.image_share) +
                       " of its image: wave it at the " + emptiestPart(camera.filled));
    if (camera.seconds > 0.0 && camera.image_speed < options.image_speed)
      result.push_back("the LED is slow in the image of " + camera.name + ": wave it faster");
  }
  if (report.volume && *report.volume < options.volume)
    result.push_back(
        format("the LED has been in %s of %g cubic metres: wave it high and low, near and far",
               roundedDown(*report.volume).c_str(), options.volume));
  if (report.speed && *report.speed < options.speed)
    result.push_back(format("the LED moves at %s m/s: wave it faster than %g m/s",
                            roundedDown(*report.speed).c_str(), options.speed));
  if (report.seconds < options.seconds - 0.5 * kTimeStep)
    result.push_back(format("wave on for %.0f s where two cameras see the LED",
                            std::ceil(options.seconds - report.seconds)));
  return result;
}

}  // namespace

void Coverage::Speeds::add(double speed, double step) {
  ++counts[std::min(static_cast<std::size_t>(speed / step), counts.size() - 1)];
  ++total;
}

double Coverage::Speeds::median(double step) const {
  std::uint32_t below = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    below += counts[i];
    if (2 * below > total)
      return (static_cast<double>(i) + 0.5) * step;
  }
  return 0.0;
}

Coverage::Coverage(std::vector<geometry::Camera> cameras,
                   bool posed,
                   std::size_t leds,
                   const CoverageOptions& options)
    : cameras_(std::move(cameras)), posed_(posed), leds_(leds), options_(options) {
  views_.resize(cameras_.size());
}

void Coverage::follow(View* view, const Frame& frame) {
  std::vector<Track>& tracks = view->tracks;
  tracks.erase(std::remove_if(tracks.begin(), tracks.end(),
                              [&](const Track& track) {
                                return frame.stamp - track.back().first > capture::kLongestGap;
                              }),
               tracks.end());
  std::vector<bool> taken(tracks.size(), false);
  for (const Eigen::Vector2d& spot : frame.spots) {
    std::size_t best = taken.size();
    double least = capture::kLongestJump;
    for (std::size_t i = 0; i < taken.size(); ++i) {
      const double distance = (tracks[i].back().second - spot).norm();
      if (!taken[i] && distance < least) {
        least = distance;
        best = i;
      }
    }
    if (best == taken.size()) {
      tracks.push_back(Track{{frame.stamp, spot}});
      continue;
    }
    taken[best] = true;
    Track& track = tracks[best];
    track.emplace_back(frame.stamp, spot);
    while (track.size() > 2 && frame.stamp - track[1].first >= kSpan)
      track.pop_front();
  }
}

void Coverage::add(std::size_t camera, const Frame& frame) {
  View& view = views_.at(camera);
  ++view.frames;
  view.distracted += frame.spots.size() > leds_ ? 1 : 0;
  follow(&view, frame);

  const geometry::Intrinsics& lens = cameras_[camera].intrinsics;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  std::size_t moving = 0;
  for (const Track& track : view.tracks) {
    const auto& [time, pixel] = track.back();
    const double span = time - track.front().first;
    if (time != frame.stamp || span < kSpan)
      continue;
    const double speed = (pixel - track.front().second).norm() / span;
    if (speed < kStill)
      continue;
    view.speeds.add(speed, kImageSpeedStep);
    view.filled.add(pixel, lens.width, lens.height);
    sum += pixel;
    ++moving;
  }
  view.middle.reset();
  if (moving == 0)
    return;
  auto& cameras = seen_[static_cast<std::int64_t>(std::floor(frame.stamp / kTimeStep))];
  cameras.resize(cameras_.size(), false);
  cameras[camera] = true;
  if (moving != leds_)
    return;
  view.time = frame.stamp;
  view.middle = sum / static_cast<double>(moving);
  if (posed_)
    locate(camera);
}

/// Position of the LED, or of the middle of the wand, in the world.
void Coverage::locate(std::size_t camera) {
  const double now = views_[camera].time;
  std::vector<geometry::Observation> observations;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    if (views_[i].middle && std::abs(views_[i].time - now) <= kSameTime)
      observations.push_back({&cameras_[i], *views_[i].middle});
  }
  const double kLargestError = 30.0;  // [px]
  const auto point = geometry::triangulate(observations, geometry::TriangulationOptions());
  if (!point || point->reprojection_error > kLargestError)
    return;
  const Eigen::Vector3d& p = point->position;
  cells_.insert({static_cast<int>(std::floor(p.x() / kCell)),
                 static_cast<int>(std::floor(p.y() / kCell)),
                 static_cast<int>(std::floor(p.z() / kCell))});
  const double span = last_ ? now - last_->first : 0.0;
  if (last_ && span >= 0.0 && span < kSpan)
    return;
  if (last_ && span > 0.0 && span < 3.0 * kSpan)
    speeds_.add((p - last_->second).norm() / span, kSpeedStep);
  last_ = {now, p};
}

CoverageReport Coverage::report() const {
  CoverageReport report;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    const View& view = views_[i];
    CameraCoverage camera;
    camera.name = cameras_[i].name;
    camera.filled = view.filled;
    camera.image_share = view.filled.share();
    camera.image_speed = view.speeds.median(kImageSpeedStep);
    if (view.frames > 0)
      camera.distraction = static_cast<double>(view.distracted) / static_cast<double>(view.frames);
    report.cameras.push_back(camera);
  }
  for (const auto& [step, cameras] : seen_) {
    const bool together = std::count(cameras.begin(), cameras.end(), true) >= 2;
    report.seconds += together ? kTimeStep : 0.0;
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      report.cameras[i].seconds += cameras[i] ? kTimeStep : 0.0;
      report.cameras[i].together += cameras[i] && together ? kTimeStep : 0.0;
    }
  }
  if (posed_)
    report.volume = kCell * kCell * kCell * static_cast<double>(cells_.size());
  if (posed_ && speeds_.total > 0)
    report.speed = speeds_.median(kSpeedStep);
  report.missing = missing(report, options_);
  return report;
}

}  // namespace wiimote_tracker::wave
