#pragma once

#include <wiimote_tracker_msgs/CalibrationCameraStatus.h>
#include <wiimote_tracker_msgs/CameraCalibration.h>
#include <wiimote_tracker_msgs/IrBlobArray.h>

#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::panel {

/// The worst comes first.
enum class CameraState { kFrozen, kKnocked, kWarned, kLate, kNotCalibrated, kBlind, kFine };

/// What one camera's tile shows. Times are of one steady clock [s].
class CameraView {
 public:
  static constexpr double kFrozenAfter = 1.0;  ///< Without an image [s].
  static constexpr double kLateAfter = 0.1;    ///< From exposure to arrival here [s].
  static constexpr double kWarnedFor =
      3.0;  ///< The tracker's diagnostics come each second, by default [s].
  static constexpr double kBlindAfter = 5.0;  ///< Without a spot, while another camera has one [s].
  static constexpr double kTrail = 1.0;  ///< Spots of this time are drawn behind the newest [s].

  struct Trace {
    double time;  // [s]
    double x, y;  // [px]
  };

  CameraView(const std::string& name, double now) : name(name), known_since_(now), lit_at_(now) {}

  /// @param delay from the exposure, as stamped, to the arrival here [s]
  void onImage(const wiimote_tracker_msgs::IrBlobArray& message, double delay, double now);

  /// @param warning of the tracker about this camera; empty: none
  void onTrackerStatus(const std::string& warning, double now) {
    warning_ = warning;
    warned_at_ = now;
  }

  /// @param others_see whether another camera has a spot now
  CameraState state(double now, bool others_see) const;

  /// The state in words, and what to do where it is known.
  std::string words(double now, bool others_see) const;

  /// Time since the last image, or since the camera became known [s].
  double silence(double now) const { return now - image_at_.value_or(known_since_); }
  bool hasImages(double now) const { return image_at_ && silence(now) < kFrozenAfter; }
  bool seesSpot(double now) const { return hasImages(now) && !visible().empty(); }
  bool isMasked(const wiimote_tracker_msgs::IrBlob& spot) const;

  /// Spots outside of the masks.
  std::vector<wiimote_tracker_msgs::IrBlob> visible() const;

  /// Images a second, also those that were lost on the way; NaN until known [Hz].
  double rate(double now) const;

  std::string name;
  std::optional<wiimote_tracker_msgs::IrBlobArray> image;              ///< The newest.
  std::deque<Trace> trail;                                             ///< Oldest first.
  double battery = std::numeric_limits<double>::quiet_NaN();           ///< [0..1]; NaN: not known.
  std::optional<wiimote_tracker_msgs::CameraCalibration> calibration;  ///< Of the current rig.
  wiimote_tracker_msgs::CalibrationCameraStatus status;                ///< Empty name: none came.

 private:
  struct Count {
    double time;
    std::uint64_t frame;
  };

  double known_since_;
  double lit_at_;
  std::optional<double> image_at_;
  double delay_ = 0.0;  // smoothed [s]
  std::string warning_;
  double warned_at_ = 0.0;
  std::deque<Count> counts_;
};

}  // namespace wiimote_tracker::panel
