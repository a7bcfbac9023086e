#include "wiimote_tracker_triangulation/geometry/rig_file.h"

#include "rig_yaml.h"
#include "wiimote_tracker_triangulation/geometry/atomic_file.h"

namespace wiimote_tracker::geometry {

Rig readRigFile(const std::string& path) {
  return rigFromYaml(readFile(path), path);
}

void writeRigFile(const Rig& rig, const std::string& path) {
  rig.check();
  writeFileAtomically(path, yamlFromRig(rig));
}

}  // namespace wiimote_tracker::geometry
