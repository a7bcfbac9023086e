#include "transport/hidraw_transport.h"

#include "file_descriptor.h"
#include "transport/users.h"

#include <fcntl.h>
#include <hidapi/hidapi.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace wiimote_tracker::transport {
namespace {

std::string nameOf(const Remote& remote) {
  return "the Wii Remote " + remote.identity + " (" + remote.description + ")";
}

class HidrawTransport : public Transport {
 public:
  HidrawTransport(hid_device* device, FileDescriptor lock, const Remote& remote)
      : lock_(std::move(lock)), device_(device), remote_(remote) {}
  ~HidrawTransport() override { hid_close(device_); }
  HidrawTransport(const HidrawTransport&) = delete;
  HidrawTransport& operator=(const HidrawTransport&) = delete;

  bool read(protocol::Report& report, double timeout) override {
    errno = 0;
    const int size = hid_read_timeout(device_, report.bytes.data(), report.bytes.size(),
                                      static_cast<int>(std::ceil(timeout * 1e3)));
    if (size < 0 && errno == EINTR)
      return false;
    if (size < 0)
      throwDisconnected();
    report.size = static_cast<std::size_t>(size);
    return size > 0;
  }

  void write(const protocol::Report& report) override {
    if (hid_write(device_, report.bytes.data(), report.size) < 0)
      throwDisconnected();
  }

  Remote remote() const override { return remote_; }

 private:
  [[noreturn]] void throwDisconnected() const {
    throw Disconnected(nameOf(remote_) +
                       " has disconnected: press one of its buttons to bring it back");
  }

  FileDescriptor lock_;
  hid_device* device_;
  const Remote remote_;
};

std::unique_ptr<Transport> openRemote(const KernelRemote& kernel_remote) {
  const Remote remote{kernel_remote.address, kernel_remote.path, kernel_remote.kernel_driver};
  // A descriptor of our own, since hidapi does not show its own: to lock the node, and to know why
  // it cannot be opened.
  const std::string& path = remote.description;
  FileDescriptor lock(::open(path.c_str(), O_RDWR | O_CLOEXEC));
  if (!lock.open())
    throwOpenError(errno, path);
  lockDevice(lock.get(), nameOf(remote));
  hid_device* device = nullptr;
  {
    static std::mutex mutex;  // hidapi's openings share state within a process
    const std::lock_guard<std::mutex> hidapi_lock(mutex);
    device = hid_open_path(path.c_str());
  }
  if (device == nullptr)
    throwOpenError(errno, path);
  return std::make_unique<HidrawTransport>(device, std::move(lock), remote);
}

std::unique_ptr<Transport> openFirstFree(const std::vector<KernelRemote>& all) {
  std::optional<PermissionDenied> denied;
  std::optional<TransportError> other;
  std::string taken;
  for (const KernelRemote& remote : all) {
    try {
      return openRemote(remote);
    } catch (const PermissionDenied& e) {
      denied = e;
    } catch (const DeviceTaken& e) {
      taken = e.what();
    } catch (const TransportError& e) {
      other = e;  // such as gone since it was listed
    }
  }
  if (denied)
    throw PermissionDenied(*denied);
  if (other && taken.empty())
    throw TransportError(*other);
  if (all.size() == 1)
    throw DeviceTaken(taken);
  throw DeviceTaken(
      "all " + std::to_string(all.size()) +
      " connected Wii Remotes are in use, by whom list_wiimotes shows: connect another one");
}

}  // namespace

void throwOpenError(int error_number, const std::string& path) {
  switch (error_number) {
    case EACCES:
    case EPERM:
      throw PermissionDenied(
          "permission denied on " + path + ": install the udev rule " + kUdevRule +
          " of wiimote_tracker_driver in /etc/udev/rules.d, run " +
          "'udevadm control --reload', and reconnect the Wii Remote; over SSH also join "
          "the group input (usermod -aG input USER) and log in again");
    case ENOENT:
    case ENODEV:
    case ENXIO:
      throw NoSuchDevice("there is no " + path +
                         ": connect the Wii Remote or correct the device name");
    default:
      throw TransportError("cannot open " + path + " (" + std::strerror(error_number) +
                           "): reconnect the Wii Remote");
  }
}

void orderAfter(const std::string& last, bool delivered, std::vector<KernelRemote>* remotes) {
  const auto at = std::find_if(remotes->begin(), remotes->end(),
                               [&](const KernelRemote& remote) { return remote.path == last; });
  if (at != remotes->end())
    std::rotate(remotes->begin(), delivered ? at : at + 1, remotes->end());
}

std::unique_ptr<Transport> openHidraw(const DeviceName& name, std::vector<KernelRemote> all) {
  all.erase(std::remove_if(all.begin(), all.end(),
                           [](const KernelRemote& remote) { return remote.path.empty(); }),
            all.end());
  if (name.kind == DeviceName::Kind::kAny) {
    if (all.empty())
      throw NoSuchDevice(
          "no Wii Remote is connected: press a button of a paired one, or pair one first");
    return openFirstFree(all);
  }
  const bool by_address = name.kind == DeviceName::Kind::kAddress;
  for (const KernelRemote& remote : all) {
    if ((by_address ? remote.address : remote.path) == name.value)
      return openRemote(remote);
  }
  if (by_address)
    throw NoSuchDevice("no Wii Remote with address " + name.value +
                       " is connected: press one of its buttons, or pair it first");
  if (::access(name.value.c_str(), F_OK) != 0)
    throwOpenError(errno, name.value);
  throw NoSuchDevice(name.value + " is not a Wii Remote: choose the right device");
}

}  // namespace wiimote_tracker::transport
