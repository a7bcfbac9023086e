#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_TOPICS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_TOPICS_H

#include <string>

namespace wiimote_tracker {

/// Names of the topics of a tracker that runs in a namespace.
class Topics {
 public:
  /// @param name_space slashes at its ends may be left out.
  explicit Topics(const std::string& name_space = "/") : name_space_(name_space) {
    if (name_space_.empty() || name_space_.front() != '/')
      name_space_ = "/" + name_space_;
    if (name_space_.back() != '/')
      name_space_ += "/";
  }

  std::string rig() const { return resolve("calibration/rig"); }
  std::string trigger() const { return resolve("trigger"); }
  std::string points() const { return resolve("points"); }
  std::string triggeredPoints() const { return resolve("triggered_points"); }
  std::string zoneEvents() const { return resolve("zone_events"); }
  std::string bodies() const { return resolve("bodies"); }
  std::string imu(const std::string& topic) const { return resolve(topic); }
  std::string pose(const std::string& body) const { return resolve(body + "/pose"); }
  std::string twist(const std::string& body) const { return resolve(body + "/twist"); }
  /// Of a body or an LED.
  std::string odometry(const std::string& name) const { return resolve(name + "/odometry"); }
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
