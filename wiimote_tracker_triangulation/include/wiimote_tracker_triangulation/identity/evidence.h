#pragma once

#include "wiimote_tracker_triangulation/identity/hypotheses.h"

#include <Eigen/Core>

#include <vector>

namespace wiimote_tracker::identity {

/// Of all hypotheses.
struct LogLikelihoods {
  Eigen::ArrayXf cells;  ///< Hypotheses::cells() values.
  double steady = 0.0;   ///< Of a light that does not blink.
};

/// Log likelihoods of all hypotheses given the sightings of one LED, with exponential forgetting
/// (Hypotheses::memory).
///
/// A dark interval of a camera is kept apart until that camera sees the LED again. Its log
/// likelihood is limited from below to that of an occlusion (kOccluded).
class Evidence {
 public:
  explicit Evidence(const Hypotheses& hypotheses);

  /// Forgets all sightings. Phases are relative to `origin` [s], near the first sighting.
  void reset(double origin);

  /// Does not allocate once each camera has had a sighting.
  void add(const Sighting& sighting);

  /// The present log likelihoods.
  void read(LogLikelihoods* now) const;

 private:
  /// The present dark interval of a camera.
  struct Darkness {
    bool lasts = false;
    double weight = 1.0;  // at its start
    LogLikelihoods sum;
  };

  double weightAt(double time);
  void accumulate(const Sighting& sighting, double weight, LogLikelihoods* sum) const;
  void addLimited(const Darkness& darkness, LogLikelihoods* sum) const;

  const Hypotheses* hypotheses_;
  double origin_ = 0.0;  // of the phases [s]

  // All sums are multiplied by weight_, which grows with time, so that forgetting needs no
  // multiplication of old sums.
  double weight_ = 1.0;
  double weight_origin_ = 0.0;      // time of weight 1 [s]
  LogLikelihoods sum_;              // without darkness that lasts
  std::vector<Darkness> darkness_;  // per camera
};

}  // namespace wiimote_tracker::identity
