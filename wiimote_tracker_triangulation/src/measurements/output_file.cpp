#include "measurements/output_file.h"

#include "measurements/part_file.h"

#include <cerrno>

namespace wiimote_tracker::measurements {

OutputFile::OutputFile(const std::string& path) : path_(path) {
  createPart(path_);
  file_.reset(std::fopen(partOf(path_).c_str(), "wb"));
  if (!file_)
    failToWrite(path_, errno);
}

void OutputFile::write(const std::string& bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size())
    failToWrite(path_, errno);
}

void OutputFile::flush() {
  if (std::fflush(file_.get()) != 0)
    failToWrite(path_, errno);
}

void OutputFile::finish() {
  flush();
  if (std::fclose(file_.release()) != 0)
    failToWrite(path_, errno);
  finishPart(path_);
}

}  // namespace wiimote_tracker::measurements
