// Replaces matlab_writer.cpp where matio is not installed.
#include "ros/measurements/writer.h"
#include "wiimote_tracker_triangulation/geometry/error.h"

namespace wiimote_tracker::measurements {

std::unique_ptr<Writer> makeMatlabWriter(const std::string& path) {
  throw Error("cannot write " + path +
              ": this was built without matio; install it (libmatio-dev) and build again, or "
              "write CSV");
}

}  // namespace wiimote_tracker::measurements
