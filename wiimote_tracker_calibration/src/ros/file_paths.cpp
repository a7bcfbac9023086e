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

std::string permittedPath(const std::string& requested, const Parameters& parameters) {
  // Answers repeat the path; those that are not UTF-8 cannot be read in Python.
  if (validUtf8(requested) != requested)
    throw Refusal("the path is not UTF-8: choose another name for the file");
  const std::string& limit = parameters.file_folder;
  const fs::path folder = withoutLinks(
      limit.empty() ? fs::absolute(parameters.rig_file).parent_path() : fs::path(limit));
  const fs::path path = withoutLinks(requested);
  if (std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first != folder.end())
    throw Refusal(
        requested + " is not below " + folder.string() +
        ": choose a file there, or start the node with the parameter file_folder, such as /");
  return requested;
}

}  // namespace

std::string rigPath(const std::string& requested, const Parameters& parameters) {
  return requested.empty() ? parameters.rig_file : permittedPath(requested, parameters);
}

std::string samplesPath(const std::string& requested, const Parameters& parameters) {
  if (!requested.empty())
    return permittedPath(requested, parameters);
  return fs::path(parameters.rig_file).replace_filename(kSamplesFile).string();
}

}  // namespace wiimote_tracker
