#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_SESSION_SESSION_YAML_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_SESSION_SESSION_YAML_H

#include "session/session.h"

#include <cstddef>
#include <string>
#include <vector>

namespace wiimote_tracker::session {

/// A session without its frames, and their numbers.
struct SessionHead {
  Session session;                  ///< Without frames.
  std::vector<std::size_t> frames;  ///< How many, per camera.
};

/// YAML text of a session without its frames.
std::string yamlFromSession(const Session& session);

/// `where`: the file, for the messages. @throws geometry::FileError naming the key.
SessionHead headFromYaml(const std::string& text, const std::string& where);

}  // namespace wiimote_tracker::session

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_SESSION_SESSION_YAML_H
