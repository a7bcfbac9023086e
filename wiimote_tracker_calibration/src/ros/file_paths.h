#pragma once

#include "parameters.h"

#include <string>

namespace wiimote_tracker {

/// The rig file of a request. Whoever reaches the master can send one: it must lie below
/// Parameters::file_folder. Links are followed.
/// @param requested absolute, or relative to the folder of the parameter rig_file (where that does
/// not lie below file_folder: to file_folder); empty: rig_file.
/// @throws Refusal: it lies elsewhere, begins with "~/", or is not UTF-8.
std::string rigPath(const std::string& requested, const Parameters& parameters);

/// Whether the next start loads this file. Its lenses are those of the drivers, for programs that
/// do not know the rig. Links are followed.
bool isRigFile(const std::string& path, const Parameters& parameters);

/// Name of the rig's file where the parameter rig_file names none.
inline constexpr char kRigFile[] = "rig.yaml";

/// Why the start is without a rig, and what to do; empty if there is a file, readable or not.
std::string describeMissingRig(const std::string& rig_file);

/// Name of the samples' file where a request names none.
inline constexpr char kSamplesFile[] = "samples.yaml";

/// The same for samples. @param requested empty: kSamplesFile beside the rig file.
std::string samplesPath(const std::string& requested, const Parameters& parameters);

}  // namespace wiimote_tracker
