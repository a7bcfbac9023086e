#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_SESSION_SESSION_YAML_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_SESSION_SESSION_YAML_H

#include "wiimote_tracker_calibration/session/session.h"

#include <cstddef>
#include <string>
#include <vector>

namespace wiimote_tracker::session {

/// A session but for its frames, of which only the number stands there.
struct SessionHead {
  Session session;                  ///< Without frames.
  std::vector<std::size_t> frames;  ///< How many, per camera.
};

/// YAML text of all but the frames. Needs a ClassicLocale.
std::string yamlFromSession(const Session& session);

/// `where`: the file, for the messages. @throws geometry::RigFileError naming the key.
SessionHead headFromYaml(const std::string& text, const std::string& where);

}  // namespace wiimote_tracker::session

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_SESSION_SESSION_YAML_H
