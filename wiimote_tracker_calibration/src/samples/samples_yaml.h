#pragma once

#include "samples/samples.h"

#include <cstddef>
#include <string>
#include <vector>

namespace wiimote_tracker::samples {

/// Samples without their frames, and how many these are.
struct SamplesHead {
  Samples samples;                  ///< Without frames.
  std::vector<std::size_t> frames;  ///< How many, per camera.
};

/// YAML text of samples without their frames.
std::string yamlFromSamples(const Samples& samples);

/// `where`: the file, for the messages. @throws geometry::FileError naming the key.
SamplesHead headFromYaml(const std::string& text, const std::string& where);

}  // namespace wiimote_tracker::samples
