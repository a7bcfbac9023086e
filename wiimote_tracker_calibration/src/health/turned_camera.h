#pragma once

#include "capture/image.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>

#include <cstddef>
#include <deque>
#include <limits>
#include <optional>
#include <vector>

namespace wiimote_tracker::health {

/// Which spot of an image shows which LED.
struct LedMatches {
  std::vector<std::optional<std::size_t>> spot_of;  ///< Per LED.
  std::size_t matched = 0;                          ///< LEDs.
  std::size_t missing = 0;    ///< LEDs that the camera should see, without a spot.
  std::size_t unmatched = 0;  ///< Spots.
  std::size_t visible = 0;    ///< LEDs that the camera should see.

  /// Whether LEDs have no spots while spots have no LEDs: the camera was turned, or it sees other
  /// lights. A hidden LED alone, or a false detection alone, leaves it false.
  bool isContradictory() const { return missing > 0 && unmatched > 0; }

  /// Whether that holds for most LEDs.
  bool isAstray() const { return missing > matched && unmatched > 0; }
};

/// Estimates the orientation of a camera that may have been turned, from several LEDs that the
/// other cameras see. It is good enough to tell which spot is which LED, not to calibrate.
class TurnedCamera {
 public:
  TurnedCamera(const geometry::Rig& rig, const geometry::RigCamera& camera);

  /// One image. @param leds where LEDs were then, world [m], in the same order each time.
  /// @returns its matches by the orientation estimated now.
  LedMatches add(double time,
                 const std::vector<Eigen::Vector3d>& leds,
                 const capture::Blobs& spots);

  bool isTurned() const { return is_turned_; }

  /// World-from-camera rotation now.
  Eigen::Matrix3d orientation() const { return now_.world_from_camera.linear(); }

  /// Where a point [m] is in its images now [px].
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& point) const {
    return now_.project(point);
  }

 private:
  /// An image of moving LEDs.
  struct Sample {
    double time;  // [s]
    std::vector<Eigen::Vector3d> leds;
    capture::Blobs spots;
    bool is_contradictory;
  };
  /// An LED and a spot of one image.
  struct Pair {
    Eigen::Vector3d led;   // World [m].
    Eigen::Vector2d spot;  // [px]
  };

  LedMatches matchesOf(const geometry::Camera& camera,
                       const std::vector<Eigen::Vector3d>& leds,
                       const capture::Blobs& spots) const;
  bool hasMoved(const std::vector<Eigen::Vector3d>& leds) const;
  void judge();
  std::vector<Pair> allPairs() const;
  std::vector<Pair> agreeing(const std::vector<Pair>& pairs) const;
  geometry::Camera turnedTo(const std::vector<Pair>& pairs) const;

  geometry::Camera calibrated_;
  std::vector<geometry::ImageMask> masks_;
  geometry::Camera now_;
  bool is_turned_ = false;
  std::deque<Sample> samples_;
  double last_judgement_ = -std::numeric_limits<double>::infinity();  // [s]
};

}  // namespace wiimote_tracker::health
