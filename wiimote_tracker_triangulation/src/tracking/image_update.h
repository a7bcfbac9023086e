#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_IMAGE_UPDATE_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_IMAGE_UPDATE_H

#include "encounter.h"
#include "group_camera.h"
#include "stored_image.h"
#include "track.h"
#include "wiimote_tracker_triangulation/association/assign_spots.h"
#include "wiimote_tracker_triangulation/tracking/tracker_options.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace wiimote_tracker::tracking {

/// Takes one image into the tracks: each goes on to the image's time, says where its LED's spot
/// ought to be, and the spots are given to them by the most likely assignment.
class ImageUpdate {
 public:
  explicit ImageUpdate(const TrackerOptions& options);

  void apply(const GroupCamera& camera,
             const StoredImage& image,
             std::vector<Track>* tracks,
             std::vector<Encounter>* encounters);

  /// Of each spot of that image, its place in `tracks` or association::kGhost.
  const std::array<int, association::kMaximumSpots>& trackOfSpot() const { return track_of_spot_; }

 private:
  /// A track that this camera may show.
  struct Candidate {
    std::size_t track;
    motion::PixelPrediction prediction;
    bool expected;  // the image ought to show it
    int spot;       // given to it, or kNone
    bool updated;   // by an encounter
  };
  static constexpr int kNone = -1;

  void collectCandidates(const GroupCamera& camera,
                         const StoredImage& image,
                         std::vector<Track>* tracks);
  bool isVague(const Track& track, const motion::PixelPrediction& prediction, double time) const;
  bool isSeenBeside(const StoredImage& image, const Track& track) const;
  void assign(const StoredImage& image, const std::vector<Track>& tracks);
  void updateTrack(const GroupCamera& camera,
                   const StoredImage& image,
                   const Candidate& candidate,
                   const Track* other,
                   Track* track) const;
  const Candidate* sharing(const Candidate& candidate, const std::vector<Track>& tracks) const;
  void updateMerged(const GroupCamera& camera,
                    const StoredImage& image,
                    const Candidate& candidate,
                    const Candidate& other,
                    std::vector<Track>* tracks) const;

  void findMergedSpots(const StoredImage& image, const std::vector<Track>& tracks);
  void openEncounters(const std::vector<Track>& tracks, std::vector<Encounter>* encounters) const;
  void followEncounters(const GroupCamera& camera,
                        const StoredImage& image,
                        std::vector<Track>* tracks,
                        std::vector<Encounter>* encounters);
  Candidate* find(const std::vector<Track>& tracks, std::uint32_t id);
  void give(std::size_t spot, Candidate* candidate);

  TrackerOptions options_;
  motion::MotionSteps steps_;
  motion::PixelNoise noise_;  // of the image
  std::size_t candidate_count_ = 0;
  std::array<Candidate, association::kMaximumTracks> candidates_;
  association::SpotCosts costs_;
  std::array<int, association::kMaximumSpots> track_of_spot_;
};

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_IMAGE_UPDATE_H
