#pragma once

#include "health/alarm.h"
#include "health/drift_watch.h"
#include "health/tilt_watch.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::health {

struct HealthOptions {
  TiltOptions tilt;
  DriftOptions drift;
};

/// Whether one camera has moved since it was calibrated.
struct CameraHealth {
  std::string text;            ///< What has changed; empty: nothing has.
  std::string advice;          ///< What to do then.
  bool by_images = false;      ///< Only the images show it, against those of the other cameras.
  bool or_others = false;      ///< Then: perhaps others were moved instead.
  std::optional<Tilt> tilt;    ///< Latest judgement; nothing: none yet.
  std::optional<Drift> drift;  ///< Same.
  std::string no_drift;        ///< Why there is none; empty: there is one.
};

/// Watches whether the cameras of a rig are still where they were calibrated.
class HealthWatch {
 public:
  HealthWatch(const geometry::Rig& rig, const HealthOptions& options);

  /// Goes on with another rig of the same cameras. What was found of a camera stays where that was
  /// not calibrated anew, as while continuous calibration adjusts the rig or solves another camera.
  /// @returns false if it has other cameras: nothing has changed.
  bool follow(const geometry::Rig& rig);

  /// One image of any camera. Of several LEDs LedSelection leaves one.
  void addImage(const capture::Image& image);

  /// A reading of a camera's accelerometer at rest, optical frame [m/s^2].
  void addAcceleration(const std::string& camera,
                       double time,
                       const Eigen::Vector3d& specific_force);

  /// Of all cameras of the rig, by name.
  std::map<std::string, CameraHealth> healths() const;

  /// Cameras whose images cannot be judged now, by the reason.
  std::map<std::string, std::vector<std::string>> notJudged() const;

  /// Cameras that were well at the last call and are not now.
  /// @param isSilent whether nothing is said of a camera now: while it is not well, it stays news.
  std::vector<std::string> takeNews(const std::function<bool(const std::string&)>& isSilent =
                                        [](const auto&) { return false; });

 private:
  struct Watched {
    Watched(const geometry::RigCamera& rig_camera, const TiltOptions& options);

    geometry::RigCamera calibrated;
    std::string other_device;  // Empty: the one that was calibrated.
    std::optional<TiltWatch> tilt;
    Alarm tilt_alarm;
    Alarm drift_alarm;
    Drift drift_finding;  // The latest that supports the alarm, while that is on.
    CameraHealth health;
  };

  /// Null: not in the rig.
  Watched* find(const std::string& name);
  void describe(Watched* camera);

  HealthOptions options_;
  geometry::Rig rig_;
  std::vector<Watched> cameras_;  // In the rig's order.
  DriftWatch drift_;
  std::vector<std::string> news_;
};

}  // namespace wiimote_tracker::health
