#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_IMAGE_UPDATE_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_IMAGE_UPDATE_H

#include "association/assign_spots.h"
#include "group_state.h"
#include "tracker_camera.h"
#include "wiimote_tracker_triangulation/tracking/tracker_options.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace wiimote_tracker::tracking {

/// Updates the tracks with one image: predicts each track to the image's time and into the image,
/// assigns the spots to the tracks by maximum likelihood, and updates each track with its spot.
/// Where two LEDs may have merged into one spot, follows both hypotheses (MergedPair).
class ImageUpdate {
 public:
  /// @param options must live longer.
  ImageUpdate(const geometry::Rig& rig, const TrackerOptions& options);

  /// If the image does not fit, all its spots are false detections; but those of one of only two
  /// cameras are used, or it would never be known to fit again.
  void apply(const TrackerCamera& camera, const StoredImage& image, GroupState* state);

  /// For each spot of that image its index in `tracks`, or association::kFalseDetection.
  const std::array<int, association::kMaximumSpots>& trackOfSpot() const { return track_of_spot_; }

 private:
  /// A track that may be in this camera's image.
  struct Candidate {
    Track* track;
    motion::PixelPrediction prediction;
    bool in_view;
    bool expected;                    // without a spot, it is a missed detection
    std::optional<std::size_t> spot;  // assigned to it
    bool updated;                     // by its MergedPair
  };

  static double pixelsBetween(const Candidate& a, const Candidate& b) {
    return (a.prediction.pixel() - b.prediction.pixel()).norm();
  }

  void collectCandidates();
  bool isTooUncertain(const Track& track, const motion::PixelPrediction& prediction) const;
  CameraList othersSeeing(const Track& track) const;
  void assign();
  void assignSpot(std::size_t spot, Candidate* candidate);
  void measureFit() const;
  bool isExplained(const Candidate& candidate) const;
  void measureClock() const;
  bool isBeside(const Candidate& candidate, double distance) const;
  std::optional<Eigen::Vector2d> residualOf(const Candidate& candidate) const;
  std::optional<std::size_t> nearestUnassigned(const Eigen::Vector2d& pixel, double distance) const;
  void updateTrack(const Candidate& candidate, const Candidate* other) const;

  bool mayBeMerged(const Candidate& candidate) const;
  std::optional<std::size_t> spotBetween(const Candidate& a, const Candidate& b) const;
  const Candidate* mergedWith(const Candidate& candidate) const;
  void updateMerged(const Candidate& candidate, const Candidate& other) const;
  void findMergedSpots();
  void addMergedPairs() const;
  void updateMergedPairs();
  Candidate* find(std::uint32_t id);

  geometry::Rig rig_;
  const TrackerOptions& options_;
  // Of the last apply(); the pointers are valid while it runs.
  const TrackerCamera* camera_ = nullptr;
  const StoredImage* image_ = nullptr;
  GroupState* state_ = nullptr;
  geometry::PixelNoise noise_;
  std::vector<Candidate> candidates_;  // at most kMaximumTracks
  association::SpotCosts costs_;
  std::array<int, association::kMaximumSpots> track_of_spot_;
};

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_IMAGE_UPDATE_H
