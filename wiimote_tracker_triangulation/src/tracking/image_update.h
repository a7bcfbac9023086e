#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_IMAGE_UPDATE_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_IMAGE_UPDATE_H

#include "association/assign_spots.h"
#include "camera_fit.h"
#include "group_camera.h"
#include "merged_pair.h"
#include "stored_image.h"
#include "track.h"
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
  /// @param members indices of the group's cameras in the rig
  ImageUpdate(const geometry::Rig& rig,
              const std::vector<std::size_t>& members,
              const TrackerOptions& options);

  /// If the image does not fit, all its spots are false detections; but those of one of only two
  /// cameras are used, or it would never be known to fit again.
  /// @param fits one per camera of the group; that of the image's is updated
  void apply(const GroupCamera& camera,
             const StoredImage& image,
             std::vector<CameraFit>* fits,
             std::vector<Track>* tracks,
             std::vector<MergedPair>* pairs);

  /// Replaces the covariance of the rig, which is the same otherwise.
  void setCovariance(const Eigen::MatrixXd& covariance) { rig_.covariance = covariance; }

  /// For each spot of that image its index in `tracks`, or association::kFalseDetection.
  const std::array<int, association::kMaximumSpots>& trackOfSpot() const { return track_of_spot_; }

 private:
  /// A track that may be in this camera's image.
  struct Candidate {
    std::size_t track;
    motion::PixelPrediction prediction;
    bool in_view;
    bool expected;                    // without a spot, it is a missed detection
    std::optional<std::size_t> spot;  // assigned to it
    bool updated;                     // by its MergedPair
  };

  static double pixelsBetween(const Candidate& a, const Candidate& b) {
    return (a.prediction.pixel() - b.prediction.pixel()).norm();
  }

  void collectCandidates(const GroupCamera& camera,
                         const StoredImage& image,
                         std::vector<Track>* tracks);
  bool isTooUncertain(const Track& track,
                      const motion::PixelPrediction& prediction,
                      double time) const;
  std::size_t othersSeeing(const StoredImage& image, const Track& track) const;
  void measureFit(const StoredImage& image,
                  const std::vector<Track>& tracks,
                  std::vector<CameraFit>* fits) const;
  bool isExplained(const StoredImage& image, const Candidate& candidate, const Track& track) const;
  void measureClock(const StoredImage& image,
                    const std::vector<Track>& tracks,
                    std::vector<CameraFit>* fits) const;
  bool isBeside(const Candidate& candidate, double distance) const;
  bool mayBeMerged(const StoredImage& image,
                   const Candidate& candidate,
                   const std::vector<Track>& tracks) const;
  std::optional<std::size_t> nearestUnassigned(const StoredImage& image,
                                               const Eigen::Vector2d& pixel,
                                               double distance) const;
  std::optional<std::size_t> spotBetween(const StoredImage& image,
                                         const Candidate& a,
                                         const Candidate& b) const;
  std::optional<Eigen::Vector2d> residualOf(const StoredImage& image,
                                            const Candidate& candidate) const;
  void assign(const GroupCamera& camera,
              const StoredImage& image,
              const std::vector<Track>& tracks);
  void updateTrack(const GroupCamera& camera,
                   const StoredImage& image,
                   const Candidate& candidate,
                   const Track* other,
                   Track* track) const;
  const Candidate* mergedWith(const StoredImage& image,
                              const Candidate& candidate,
                              const std::vector<Track>& tracks) const;
  void updateMerged(const GroupCamera& camera,
                    const StoredImage& image,
                    const Candidate& candidate,
                    const Candidate& other,
                    std::vector<Track>* tracks) const;

  void findMergedSpots(const StoredImage& image, const std::vector<Track>& tracks);
  void addMergedPairs(const StoredImage& image,
                      const std::vector<Track>& tracks,
                      std::vector<MergedPair>* pairs) const;
  void updateMergedPairs(const GroupCamera& camera,
                         const StoredImage& image,
                         std::vector<Track>* tracks,
                         std::vector<MergedPair>* pairs);
  Candidate* find(const std::vector<Track>& tracks, std::uint32_t id);
  void assignSpot(std::size_t spot, Candidate* candidate);

  geometry::Rig rig_;
  std::vector<std::size_t> members_;
  TrackerOptions options_;
  motion::PixelNoise noise_;           // of the image
  std::vector<Candidate> candidates_;  // at most kMaximumTracks
  association::SpotCosts costs_;
  std::array<int, association::kMaximumSpots> track_of_spot_;
};

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_IMAGE_UPDATE_H
