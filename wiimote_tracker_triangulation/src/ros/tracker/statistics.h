#pragma once

#include "image_message.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/tracking/estimator.h"
#include "wiimote_tracker_triangulation/tracking/snapshot.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// What one camera contributed since the last clear(). Quotients are NaN where nothing was counted.
struct CameraStatistics {
  std::size_t images = 0;
  std::uint64_t lost = 0;     ///< Images that the camera counted but that never came.
  std::size_t views = 0;      ///< Images whose spots are counted.
  std::size_t spots = 0;      ///< In these, without masked ones.
  std::size_t masked = 0;     ///< Spots.
  std::size_t assigned = 0;   ///< Spots that belong to an LED.
  double delay_sum = 0.0;     ///< From exposure to arrival [s].
  double squares_sum = 0.0;   ///< Of the distances of assigned spots from their LEDs [px^2].
  double clock_stddev = 0.0;  ///< Of its clock at its newest image [s].
  std::string problem;        ///< The last fault of an image in words; empty without one.

  double inlierRatio() const;  ///< [0..1]
  double meanDelay() const;    ///< [s]
  double residual() const;     ///< sqrt(mean(du^2 + dv^2)) [px]
};

/// Names a camera that sees many lights, of which few are LEDs; empty for others.
std::string describeLights(const CameraStatistics& statistics, const std::string& camera);

/// Counts for diagnostics.
class Statistics {
 public:
  /// Counts for the cameras of this rig from now on.
  void setRig(const geometry::Rig& rig);

  /// `frame`: the camera's count of its images, from IrBlobArray.
  void addImage(std::size_t camera, const tracking::CameraImage& image, std::uint64_t frame);
  void setClock(std::size_t camera, const tracking::ClockError& error);
  void addProblem(std::size_t camera, const std::string& problem);
  void addSnapshot(const tracking::Snapshot& snapshot);
  void setBodies(std::size_t tracked) { bodies_ = tracked; }
  void addLatency(double latency);  ///< From the newest image's arrival to publication [s].
  void clear();

  std::size_t snapshots() const { return snapshots_; }
  const CameraStatistics& camera(std::size_t i) const { return cameras_.at(i); }

  /// LEDs of the newest snapshot in a state; 0 where none came since the last clear().
  std::size_t leds(tracking::TrackState state) const;

  /// What is tracked, or seen, in words.
  std::string describe() const;

  /// How to make a camera's clock known, where only bodies move, which do not show it; else empty.
  std::string describeClock(std::size_t camera, const std::string& name) const;

  /// Quantile of the latency [s], q in [0..1]; NaN without outputs.
  double latency(double q) const;

 private:
  void addSpot(std::size_t camera,
               const tracking::SeenSpot& spot,
               const std::vector<tracking::TrackedLed>& leds);

  std::vector<geometry::Camera> for_rays_;  // see Rig::rayCamera
  std::vector<CameraStatistics> cameras_;
  std::vector<std::optional<std::uint64_t>> frames_;  // of each camera's last image
  std::size_t snapshots_ = 0;
  std::array<std::size_t, 4> leds_{};  // by state
  std::size_t bodies_ = 0;             // tracked
  std::vector<double> latencies_;
};

}  // namespace wiimote_tracker
