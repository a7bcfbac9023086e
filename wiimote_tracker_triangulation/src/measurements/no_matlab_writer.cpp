// Stands in where matio is not installed.
#include "wiimote_tracker_triangulation/measurements/error.h"
#include "wiimote_tracker_triangulation/measurements/writer.h"

namespace wiimote_tracker::measurements {

bool hasMatlab() {
  return false;
}

std::unique_ptr<Writer> makeMatlabWriter(const std::string& path) {
  throw WriteError("cannot write " + path +
                   ": this was built without matio; install it (libmatio-dev) and build again, or "
                   "write CSV");
}

}  // namespace wiimote_tracker::measurements
