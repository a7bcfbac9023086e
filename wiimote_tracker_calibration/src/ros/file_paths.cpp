#include "file_paths.h"

#include "requests.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace wiimote_tracker {
namespace {

namespace fs = std::filesystem;

/// @throws Refusal: it cannot be looked up.
fs::path withoutLinks(const fs::path& path) {
  std::error_code error;
  const fs::path whole = fs::weakly_canonical(fs::absolute(path), error);
  if (error)
    throw Refusal(path.string() + " cannot be looked up (" + error.message() +
                  "): correct it, or the permissions of its folders");
  return whole.has_filename() ? whole : whole.parent_path();  // "folder/" is "folder"
}

bool isBelow(const fs::path& folder, const fs::path& path) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first ==
         folder.end();
}

std::string permittedPath(const std::string& requested, const Parameters& parameters) {
  // Answers repeat the path; those that are not UTF-8 cannot be read in Python.
  if (validUtf8(requested) != requested)
    throw Refusal("the path is not UTF-8: choose another name for the file");
  if (requested.rfind("~/", 0) == 0)  // would be a folder of this name
    throw Refusal(requested + " begins with ~, which only a shell replaces: give the whole path");
  const fs::path rig_folder = fs::absolute(parameters.rig_file).parent_path();
  const fs::path limit =
      parameters.file_folder.empty() ? rig_folder : fs::absolute(parameters.file_folder);
  const fs::path folder = withoutLinks(limit);
  const bool whole = fs::path(requested).is_absolute();
  const fs::path path =
      (whole || isBelow(folder, withoutLinks(rig_folder)) ? rig_folder : limit) / requested;
  if (!isBelow(folder, withoutLinks(path)))
    throw Refusal(
        requested + " is not below " + folder.string() +
        ": choose a file there, or start the node with the parameter file_folder, such as /");
  return path.string();
}

}  // namespace

std::string rigPath(const std::string& requested, const Parameters& parameters) {
  return requested.empty() ? parameters.rig_file : permittedPath(requested, parameters);
}

bool isRigFile(const std::string& path, const Parameters& parameters) {
  try {
    return path == parameters.rig_file || withoutLinks(path) == withoutLinks(parameters.rig_file);
  } catch (const Refusal&) {
    return false;
  }
}

std::string describeMissingRig(const std::string& rig_file) {
  std::error_code error;
  if (fs::exists(rig_file, error) || error)
    return "";
  return "There is no file " + fs::absolute(rig_file).string() +
         ", so the start is without a rig: calibrate and save, which creates the file, or correct "
         "the parameter rig_file";
}

std::string samplesPath(const std::string& requested, const Parameters& parameters) {
  if (!requested.empty())
    return permittedPath(requested, parameters);
  return fs::path(parameters.rig_file).replace_filename(kSamplesFile).string();
}

}  // namespace wiimote_tracker
