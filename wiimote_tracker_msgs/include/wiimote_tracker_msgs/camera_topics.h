#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>

namespace wiimote_tracker {

/// Names of the cameras below a namespace: what stands there before "/ir_blobs" in topics of
/// images. Those of another tracker are left out: it has a calibration node in a namespace below
/// this one.
/// @param types of the published topics, by their names
inline std::set<std::string> camerasBelow(const std::string& name_space,
                                          const std::map<std::string, std::string>& types) {
  const std::string own = name_space == "/" ? "/" : name_space + "/";
  const auto before = [&own](const std::string& topic,
                             const std::string& suffix) -> std::optional<std::string> {
    const std::size_t ends = own.size() + suffix.size();
    if (topic.size() <= ends || topic.compare(0, own.size(), own) != 0 ||
        topic.compare(topic.size() - suffix.size(), suffix.size(), suffix) != 0)
      return std::nullopt;
    return topic.substr(own.size(), topic.size() - ends);
  };
  std::set<std::string> cameras;
  for (const auto& [topic, type] : types) {
    const auto camera = before(topic, "/ir_blobs");
    if (camera && type == "wiimote_tracker_msgs/IrBlobArray")
      cameras.insert(*camera);
  }
  for (const auto& [topic, type] : types) {
    const auto other = before(topic, "/calibration/status");
    if (!other || type != "wiimote_tracker_msgs/CalibrationStatus")
      continue;
    const auto first = cameras.lower_bound(*other + "/");
    cameras.erase(first, cameras.lower_bound(*other + static_cast<char>('/' + 1)));
  }
  return cameras;
}

}  // namespace wiimote_tracker
