#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_TOPICS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_TOPICS_H

#include <string>

namespace wiimote_tracker {

/// Names of the tracker's topics, as if it ran in a namespace.
class Topics {
 public:
  /// @param name_space with a slash at both ends.
  explicit Topics(const std::string& name_space = "/") : name_space_(name_space) {}

  std::string rig() const { return resolve("calibration/rig"); }
  std::string trigger() const { return resolve("trigger"); }
  std::string points() const { return resolve("points"); }
  std::string triggeredPoints() const { return resolve("triggered_points"); }
  std::string zoneEvents() const { return resolve("zone_events"); }
  std::string bodies() const { return resolve("bodies"); }
  std::string pose(const std::string& body) const { return resolve(body + "/pose"); }
  std::string markers() const { return resolve("markers"); }
  std::string blobs(const std::string& camera) const { return resolve(camera + "/ir_blobs"); }
  std::string point(const std::string& label) const { return resolve(label + "/point"); }
  static std::string transforms() { return "/tf"; }

 private:
  std::string resolve(const std::string& name) const {
    return name[0] == '/' ? name : name_space_ + name;
  }

  std::string name_space_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_TOPICS_H
