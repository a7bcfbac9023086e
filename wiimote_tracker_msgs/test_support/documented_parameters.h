#pragma once

#include <wiimote_tracker_msgs/parameter_reader.h>

#include <string>

namespace wiimote_tracker {

/// Expects that a YAML file in config/ has the parameters that `reader` has read, and no other
/// ones, with their defaults, and that each number was read with a range. The comment directly
/// above each ends with a full stop. That of a number holds its unit and range, such as
/// "[px, 0.001..100]"; without a unit "[1, 0..5]". A bound may also be a multiple of pi ("2 pi") or
/// the name of a parameter in the same group. The comment of a choice holds its words:
/// "[joint, per_camera]".
void expectDocumented(const ParameterReader& reader, const std::string& path);

}  // namespace wiimote_tracker
