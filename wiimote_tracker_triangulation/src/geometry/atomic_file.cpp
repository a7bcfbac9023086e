#include "wiimote_tracker_triangulation/geometry/atomic_file.h"

#include "geometry/output_file.h"
#include "wiimote_tracker_triangulation/geometry/error.h"

#include <wiimote_tracker_msgs/text.h>

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <limits>
#include <memory>
#include <mutex>

namespace wiimote_tracker::geometry {
namespace {

[[noreturn]] void failToRead(const std::string& path, int error) {
  throw FileError("cannot read " + path + " (" + std::strerror(error) +
                  "); check its name and permissions");
}

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// What kind of file a content is, by its key `format`; empty: it does not say.
std::string kindOf(const std::string& content) {
  if (content.rfind("#ROSBAG", 0) == 0)
    return "bag";
  const std::string key = "\nformat:";
  const std::string lines = "\n" + content;
  const std::size_t found = lines.find(key);
  if (found == std::string::npos)
    return "";
  const std::size_t begin =
      std::min(lines.find_first_not_of(" \"'", found + key.size()), lines.size());
  return lines.substr(begin, lines.find_first_of(" \"'\r\n", begin) - begin);
}

}  // namespace

void writeFileAtomically(const std::string& path, const std::string& content) {
  namespace fs = std::filesystem;
  static std::mutex mutex;  // without it another thread would be refused as another program is
  const std::lock_guard<std::mutex> lock(mutex);
  try {
    fs::path target = fs::absolute(path);
    if (fs::is_symlink(target))
      target = fs::weakly_canonical(target);
    if (fs::exists(target)) {
      const std::string kind =
          kindOf(readFile(target.string(), std::numeric_limits<std::size_t>::max()));
      if (!kind.empty() && kind != kindOf(content))
        throw FileError(path + " was not written: it is a file of another kind (" + kind +
                        "); choose another name");
    }
    OutputFile file(target.string(), false);
    try {
      file.write(content);
      file.finish();
    } catch (...) {
      file.discard();
      throw;
    }
  } catch (const fs::filesystem_error& e) {
    failToWrite(path, e.code().value());
  }
}

std::string readFile(const std::string& path, std::size_t largest) {
  // std::fopen would wait for the writer of a FIFO.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  const File file(descriptor < 0 ? nullptr : ::fdopen(descriptor, "r"), std::fclose);
  struct stat status {};
  if (!file || ::fstat(descriptor, &status) != 0)
    failToRead(path, errno);
  if (!S_ISREG(status.st_mode))
    throw FileError("cannot read " + path + ", it is " +
                    (S_ISDIR(status.st_mode) ? "a folder" : "a device or a pipe") +
                    "; name a file");
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size > largest)
    throw FileError(
        format("cannot read %s, its %.0f MB are more than the %.0f MB of the largest "
               "file of this kind; name another file",
               path.c_str(), 1e-6 * size, 1e-6 * largest));
  std::string content(size, '\0');
  content.resize(std::fread(content.data(), 1, size, file.get()));  // it may be shorter now
  if (std::ferror(file.get()) != 0)
    failToRead(path, errno);
  return content;
}

}  // namespace wiimote_tracker::geometry
