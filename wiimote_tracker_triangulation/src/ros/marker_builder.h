#pragma once

#include "marker_parts.h"
#include "tracker/parameters.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/tracking/snapshot.h"

#include <visualization_msgs/MarkerArray.h>
#include <wiimote_tracker_msgs/TrackedPointArray.h>

#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker {

/// Markers for rviz of a rig, its cameras' spots, and the LEDs, in the world frame. Namespaces:
/// camera (its name), housing, frustum, image_plane, mask, blob (one id per camera, in the order of
/// the rig); ray (one per spot); point, covariance (95 % ellipsoid), height (a line to the floor),
/// shadow (on the floor), label, trail (one per LED, with its id). Spots and rays are green when
/// they belong to an LED, orange when they do not, and grey when masked. A camera without images is
/// grey and says so. A doubtful label ends with "?". A label keeps its colour, up to 1000 labels.
class MarkerBuilder {
 public:
  explicit MarkerBuilder(const MarkerOptions& options) : options_(options) {}

  /// Until there is a rig: a text at the world's origin that says what to do (namespace advice).
  visualization_msgs::MarkerArray buildWithoutRig(double time) const;

  /// Draws this rig from now on. Deletes the markers of the previous one, unless it had the same
  /// frames.
  void setRig(const geometry::Rig& rig);

  /// Whether 1 / rate has passed since the last array, or time jumped back.
  bool isDue(double time) const;

  /// `views`: one per camera of the rig. Deletes the markers of LEDs that are lost or gone; their
  /// trails fade within 0.5 s.
  visualization_msgs::MarkerArray build(const wiimote_tracker_msgs::TrackedPointArray& points,
                                        const std::vector<tracking::CameraView>& views);

 private:
  /// Where an LED was.
  struct Place {
    double time;  // [s]
    geometry_msgs::Point position;
  };
  struct Trail {
    std_msgs::ColorRGBA color;
    std::deque<Place> places;
  };

  void addCamera(std::size_t index, bool has_images);
  void addMasks(std::size_t index);
  std_msgs::ColorRGBA colorOfLed(const std::string& label, float alpha);
  void addView(std::size_t index,
               const tracking::CameraView& view,
               const wiimote_tracker_msgs::TrackedPointArray& points);
  void addLed(const wiimote_tracker_msgs::TrackedPoint& point);
  void addTrails();
  void deleteOld();

  MarkerOptions options_;
  geometry::Rig rig_;
  double time_ = -std::numeric_limits<double>::infinity();
  std::set<std::pair<std::string, int>> drawn_;  // namespaces and ids in the last array
  std::map<std::uint32_t, Trail> trails_;        // by id
  std::map<std::string, std::size_t> labels_;    // in the order in which they came
  visualization_msgs::MarkerArray array_;
  markers::Common of_cameras_, of_leds_;
};

}  // namespace wiimote_tracker
