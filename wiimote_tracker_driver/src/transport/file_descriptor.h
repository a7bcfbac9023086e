#ifndef WIIMOTE_TRACKER_DRIVER_TRANSPORT_FILE_DESCRIPTOR_H
#define WIIMOTE_TRACKER_DRIVER_TRANSPORT_FILE_DESCRIPTOR_H

#include <unistd.h>

namespace wiimote_tracker::transport {

/// Owns a file descriptor.
class FileDescriptor {
 public:
  explicit FileDescriptor(int fd) : fd_(fd) {}
  ~FileDescriptor() {
    if (fd_ >= 0)
      ::close(fd_);
  }
  FileDescriptor(FileDescriptor&& other) noexcept : fd_(other.fd_) { other.fd_ = -1; }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  FileDescriptor& operator=(FileDescriptor&&) = delete;

  int get() const { return fd_; }

 private:
  int fd_;
};

}  // namespace wiimote_tracker::transport

#endif  // WIIMOTE_TRACKER_DRIVER_TRANSPORT_FILE_DESCRIPTOR_H
