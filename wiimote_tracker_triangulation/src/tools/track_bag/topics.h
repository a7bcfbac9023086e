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

  /// The topic that the tracker means by a name.
  std::string operator()(const std::string& name) const {
    return name[0] == '/' ? name : name_space_ + name;
  }

 private:
  std::string name_space_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_TOPICS_H
