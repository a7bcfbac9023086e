#include "parameter_file.h"

#include "wiimote_tracker_triangulation/ros/parameter_file.h"

#include <wiimote_tracker_msgs/parameter_reader.h>

namespace wiimote_tracker {

TrackingParameters readParameterFile(const std::string& path, const std::string& mode) {
  ParameterTree parameters = readParameterTree(path);
  if (!mode.empty())
    parameters.setParam("mode", mode);
  return TrackingParameters::read(ParameterReader(parameters));
}

}  // namespace wiimote_tracker
