#pragma once

#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/tracking/camera_image.h"
#include "wiimote_tracker_triangulation/tracking/snapshot.h"

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>

namespace wiimote_tracker::tracking {

/// How a camera's images fit the LEDs that other cameras see.
///
/// A camera that was moved or exchanged shows spots where no LED is, and none where LEDs are.
class CameraFit {
 public:
  struct Limits {
    double memory;     ///< Recent LEDs in images that count.
    double least;      ///< Share of misfits in the memory of a camera that does not fit.
    double tolerated;  ///< Misfits per fit of one that fits again.
  };

  /// @param ghost_rate expected false detections per image.
  CameraFit(double ghost_rate, const Limits& limits) : limits_(limits), usual_(ghost_rate) {}

  /// @param unassigned spots of no LED.
  void add(const LedFit& leds, std::size_t unassigned) {
    constexpr double kMemoryOfUsual = 150.0;  // images
    constexpr double kRatio = 1.5;            // misfits per fit of a camera that does not fit
    unassigned_ = unassigned;
    const double surplus = unassigned - usual_;
    if (leds.shown > 0 && leds.missing == 0) {
      complete_images_ = std::min(complete_images_ + 1.0, kMemoryOfUsual);
      usual_ += surplus / complete_images_;
    }
    // Forgets exponentially. An LED that is hidden makes no other spot: only as many are misfits as
    // there are more unassigned spots than usual.
    const double kept = std::max(0.0, 1.0 - (leds.shown + leds.missing) / limits_.memory);
    fits_ = kept * fits_ + leds.shown;
    missing_ = kept * missing_ + leds.missing;
    explained_ = kept * explained_ + leds.explained;
    misfits_ = std::max(0.0, kept * misfits_ + std::min<double>(leds.missing, surplus));
    misfit_ = misfit_ ? misfits_ > limits_.tolerated * fits_
                      : misfits_ >= limits_.least * limits_.memory && misfits_ > kRatio * fits_;
  }

  /// Whether most LEDs are missing while more spots than usual are unassigned. (If an LED is only
  /// hidden, there are no more of these.)
  bool isMisfit() const { return misfit_; }

  /// Whether errors of the calibration explain most of what is missing.
  bool isExplained() const { return 2.0 * explained_ > missing_; }

  /// Of the newest image.
  std::size_t unassigned() const { return unassigned_; }

 private:
  Limits limits_;
  double fits_ = 0.0;              // of recent LEDs
  double misfits_ = 0.0;           // the same
  double missing_ = 0.0;           // the same, without regard to other spots
  double explained_ = 0.0;         // of these, by errors of the calibration
  double usual_;                   // unassigned spots of a complete image: one that shows all LEDs
  double complete_images_ = 10.0;  // the expected rate counts as ten
  std::size_t unassigned_ = 0;     // of the newest image
  bool misfit_ = false;
};

/// Greatest distance of a spot that errors of the calibration explain, however vague that is [px].
constexpr double kFarthestByCalibration = 64.0;

/// Whether errors of the calibration, within three standard deviations, may have moved a spot away
/// from the prediction of its LED. Does not allocate.
/// @param led its position [m]. @param camera that of the spot, in the rig.
/// @param others that see the LED.
/// @param residual spot less prediction [px]. @param covariance of this without such errors [px^2].
bool isByCalibration(const geometry::Rig& rig,
                     const Eigen::Vector3d& led,
                     std::size_t camera,
                     const CameraList& others,
                     const Eigen::Vector2d& residual,
                     const Eigen::Matrix2d& covariance);

}  // namespace wiimote_tracker::tracking
