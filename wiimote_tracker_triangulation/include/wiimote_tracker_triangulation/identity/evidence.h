#ifndef WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_EVIDENCE_H
#define WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_EVIDENCE_H

#include "wiimote_tracker_triangulation/identity/hypotheses.h"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace wiimote_tracker::identity {

/// What the sightings of one LED say about every hypothesis: log likelihoods that fade with the
/// hypotheses' memory.
///
/// Darkness is put aside, per camera, until that camera sees the LED again, and counts no more
/// against any hypothesis than that something was in the way (SeeingModel::hidden).
class Evidence {
 public:
  explicit Evidence(const Hypotheses& hypotheses);

  /// Forgets everything. Phases are counted from `origin` [s], near the first sighting.
  void reset(double origin);

  /// Does not allocate, once each camera has had a sighting.
  void add(const Sighting& sighting);

  /// Log likelihoods of all cells, and of a light that does not blink, now.
  /// @param cells hypotheses().cells() of them
  void read(Eigen::ArrayXf* cells, double* steady) const;

  const Hypotheses& hypotheses() const { return *hypotheses_; }

 private:
  /// A camera's present darkness.
  struct Darkness {
    bool lasts = false;
    double weight = 1.0;  // of its beginning
    Eigen::ArrayXf cells;
    double steady = 0.0;
  };

  double weightAt(double time);
  void accumulate(const Sighting& sighting, double weight, Eigen::ArrayXf* cells, double* steady);
  void endDarkness(Darkness* darkness);
  float least(const Darkness& darkness) const;

  const Hypotheses* hypotheses_;
  double origin_ = 0.0;  // of the phases [s]

  // Everything is stored times weight_, which grows as if newer sightings were worth more: so
  // nothing has to be made smaller each time.
  double weight_ = 1.0;
  double weight_origin_ = 0.0;  // when it was 1 [s]
  Eigen::ArrayXf cells_;
  double steady_ = 0.0;
  std::vector<Darkness> darkness_;  // of each camera
};

}  // namespace wiimote_tracker::identity

#endif  // WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_EVIDENCE_H
