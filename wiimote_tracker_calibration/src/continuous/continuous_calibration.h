#pragma once

#include "capture/image.h"
#include "continuous/motion_window.h"
#include "continuous/proposal.h"
#include "continuous/suspect_watch.h"
#include "recalibrate/recalibrate_camera.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::continuous {

struct Options {
  // {{limit [px], window [s], samples}, {samples to solve, samples to check}}; 20 samples a second.
  // Noticed in 6 s, with LEDs that hide each other in up to 24 s; 7 s solve it, 3 s check it. Of
  // several, four cameras see a sample, and up to 28 s solve them: two cameras that face each other
  // locate few points.
  SuspectOptions suspects = {{3.0, 6.0, 80}, {140, 60}, {140, 60, 560, 4}};
  MotionOptions adjustment = {600, 200};  ///< Of all cameras: 30 s and 10 s.
  recalibrate::Options recalibrate;
};

/// Corrects a rig from ordinary tracking. One or two cameras that no longer fit the others are
/// solved against them; when all fit nearly, they are adjusted together. A change must also explain
/// later images than those it was solved from. A deterministic function of the images and readings.
class ContinuousCalibration {
 public:
  ContinuousCalibration(const geometry::Rig& rig, const Options& options);

  /// One image of any camera; of one camera in the order of their stamps. Images of several spots
  /// take no part (health::LedSelection leaves one), nor those of another device than was
  /// calibrated. It may take some seconds when there is enough motion. After a lower clock epoch
  /// than the rig's it starts anew, with that epoch in its rig.
  std::optional<Proposal> add(const capture::Image& image);

  /// Whether the latest images still speak for a proposal.
  bool isCurrent(const Proposal& proposal) const;

  /// Names of the cameras whose time offset is unknown, since they reconnected. While there are
  /// several, no camera is solved against the others; these get their clocks first.
  std::vector<std::string> newClocks() const { return suspects_.newClocks(); }

  /// Which cameras contradict each other, and what to do, if nothing tells which of them were
  /// moved; else empty. It stays while several cameras are off.
  const std::string& contradiction() const { return contradiction_; }

  /// A reading of a camera's accelerometer, optical frame [m/s^2].
  void addAcceleration(const std::string& camera, const Eigen::Vector3d& specific_force);

 private:
  /// What is proposed when there is enough motion since cameras are off.
  std::optional<Proposal> solvedSuspect(const Evidence& evidence);
  /// What is proposed when there is enough motion, whether or not cameras are off.
  std::optional<Proposal> solvedFromMotion();

  /// One or two cameras solved against the others.
  std::optional<Proposal> solvedAgainstOthers(const Evidence& evidence);
  /// The camera solved against the others that alone has turned farther than cameras drift, if
  /// there is one. A roll is found so: it leaves the median of the residuals where it was.
  std::optional<Proposal> knockFoundBy(const Proposal& drift, const MotionImages& images);

  /// adjustRig(), unless the rig tells too little of its lenses.
  std::optional<geometry::Rig> adjustedRig(const MotionImages& images) const;
  /// All cameras adjusted together.
  std::optional<Proposal> adjustedTogether(const MotionImages& images) const;
  /// All cameras adjusted together but the one that contradicts the others even with the clocks of
  /// an adjusted rig. So these get their new clocks, with which that one can be solved.
  std::optional<Proposal> adjustedWithoutKnocked(const geometry::Rig& adjusted,
                                                 const MotionImages& images) const;

  geometry::Rig rig_;
  Options options_;
  SuspectWatch suspects_;
  MotionWindow motion_;
  std::string contradiction_;
  std::optional<Proposal> from_motion_;  // The latest result of solvedFromMotion().
};

}  // namespace wiimote_tracker::continuous
