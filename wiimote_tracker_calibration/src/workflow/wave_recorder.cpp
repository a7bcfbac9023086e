#include "workflow/wave_recorder.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace wiimote_tracker::workflow {

WaveRecorder::WaveRecorder(const std::vector<geometry::Camera>& cameras,
                           bool posed,
                           const std::optional<wave::Wand>& wand,
                           const wave::CoverageOptions& options,
                           double start)
    : wand_(wand),
      options_(options),
      start_(start),
      tracks_(cameras.size()),
      coverage_(cameras, posed, wand ? 2 : 1, options) {
  for (std::size_t i = 0; i < cameras.size(); ++i)
    index_[cameras[i].name] = i;
}

bool WaveRecorder::add(const capture::Image& image) {
  const auto found = index_.find(image.camera);
  if (found == index_.end() || image.stamp < start_ || image.stamp > start_ + kLongest)
    return false;
  const std::size_t index = found->second;
  Track& track = tracks_[index];
  if (track.frames.empty()) {
    track.clock_epoch = image.clock_epoch;
  } else if (image.clock_epoch != track.clock_epoch) {
    track = Track{image.clock_epoch, {}, {}, true};
    coverage_.restart();
    std::vector<std::pair<std::size_t, const wave::Frame*>> frames;
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      for (const wave::Frame& frame : tracks_[i].frames)
        frames.emplace_back(i, &frame);
    }
    std::sort(frames.begin(), frames.end(),
              [](const auto& a, const auto& b) { return a.second->stamp < b.second->stamp; });
    for (const auto& [camera, frame] : frames)
      coverage_.add(camera, *frame);
  } else if (image.stamp <= track.frames.back().stamp) {
    return false;
  }
  track.frames.push_back({image.stamp, image.spots});
  coverage_.add(index, track.frames.back());
  const bool needed_floor = needsFloor();
  track.rest.add(track.frames.back());
  return needed_floor && !needsFloor();
}

bool WaveRecorder::needsFloor() const {
  return wand_ && wand_->led_height &&
         std::count_if(tracks_.begin(), tracks_.end(),
                       [](const Track& track) { return track.rest.spots().has_value(); }) < 2;
}

const WaveRecorder::Track* WaveRecorder::track(const std::string& camera) const {
  const auto found = index_.find(camera);
  return found != index_.end() ? &tracks_[found->second] : nullptr;
}

wave::CoverageReport WaveRecorder::report() const {
  wave::CoverageReport report = coverage_.report();
  if (needsFloor())
    report.missing.insert(
        report.missing.begin(),
        "two cameras have not yet seen both LEDs of the wand, and no other light, "
        "at rest for 2 s: leave it on the floor where they see it");
  if (report.enough())
    return report;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (tracks_[i].reconnected)
      report.missing.push_back(report.cameras[i].name +
                               " reconnected during the wave, so its earlier images do not "
                               "count: continue waving where it looks");
  }
  return report;
}

}  // namespace wiimote_tracker::workflow
