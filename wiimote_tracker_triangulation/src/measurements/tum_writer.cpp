#include "measurements/tum_writer.h"

#include <wiimote_tracker_msgs/text.h>

#include <cstdlib>
#include <locale>
#include <sstream>

namespace wiimote_tracker::measurements {

void TumWriter::add(std::int64_t stamp,
                    const Eigen::Vector3d& position,
                    const Eigen::Quaterniond& rotation) {
  const std::lldiv_t time = std::lldiv(stamp, 1000000000);
  std::ostringstream line;
  line.imbue(std::locale::classic());
  line.precision(9);
  line << format("%lld.%09lld", time.quot, time.rem);
  for (const double value : {position.x(), position.y(), position.z(), rotation.x(), rotation.y(),
                             rotation.z(), rotation.w()})
    line << ' ' << value;
  line << '\n';
  file_.write(line.str());
}

}  // namespace wiimote_tracker::measurements
