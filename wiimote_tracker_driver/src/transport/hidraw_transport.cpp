#include "transport/hidraw_transport.h"

#include "file_descriptor.h"
#include "transport/users.h"

#include <fcntl.h>
#include <hidapi/hidapi.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace wiimote_tracker::transport {
namespace {

constexpr unsigned short kNintendo = 0x057e;
constexpr unsigned short kRemote = 0x0306;
constexpr unsigned short kRemotePlus = 0x0330;

std::string narrowLowerCase(const wchar_t* text) {
  std::string result;
  for (; text != nullptr && *text != L'\0'; ++text) {
    const auto c = static_cast<unsigned char>(*text & 0x7f);
    result.push_back(static_cast<char>(std::tolower(c)));
  }
  return result;
}

// hidapi's enumeration and opening share state within a process.
std::mutex& hidapiMutex() {
  static std::mutex mutex;
  return mutex;
}

// The Wii U Pro Controller and the Balance Board share the ids, but have no camera.
bool hasCamera(const hid_device_info& info) {
  const std::string name = narrowLowerCase(info.product_string);
  return name.find("rvl-cnt-01-uc") == std::string::npos &&
         name.find("rvl-wbc-01") == std::string::npos;
}

/// Those that the kernel knows, by path. Their drivers are not looked up.
std::vector<Remote> enumerate() {
  const std::lock_guard<std::mutex> lock(hidapiMutex());
  std::vector<Remote> found;
  hid_device_info* const list = hid_enumerate(kNintendo, 0);
  for (const hid_device_info* i = list; i != nullptr; i = i->next) {
    const bool is_remote = i->product_id == kRemote || i->product_id == kRemotePlus;
    if (i->path != nullptr && is_remote && hasCamera(*i))
      found.push_back({narrowLowerCase(i->serial_number), i->path});
  }
  hid_free_enumeration(list);
  // The kernel's order is not that of plugging in.
  std::sort(found.begin(), found.end(),
            [](const Remote& a, const Remote& b) { return a.description < b.description; });
  // Newer versions of hidapi list a device once per use that its descriptor names.
  found.erase(
      std::unique(found.begin(), found.end(),
                  [](const Remote& a, const Remote& b) { return a.description == b.description; }),
      found.end());
  return found;
}

std::string kernelDriverOf(const std::string& path) {
  const std::string name = path.substr(path.rfind('/') + 1);
  std::error_code none;  // then the path is empty
  return std::filesystem::read_symlink("/sys/class/hidraw/" + name + "/device/driver", none)
      .filename()
      .string();
}

std::string nameOf(const Remote& remote) {
  return "the Wii Remote " + remote.identity + " (" + remote.description + ")";
}

class HidrawTransport : public Transport {
 public:
  HidrawTransport(hid_device* device, FileDescriptor lock, const Remote& remote)
      : lock_(std::move(lock)), device_(device), remote_(remote) {
    remote_.kernel_driver = kernelDriverOf(remote_.description);
  }
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
  Remote remote_;
};

std::unique_ptr<Transport> openRemote(const Remote& remote) {
  // The lock goes with an own descriptor, since hidapi does not show its own; it also tells why
  // opening fails, which hidapi does not.
  const std::string& path = remote.description;
  FileDescriptor lock(::open(path.c_str(), O_RDWR | O_CLOEXEC));
  if (lock.get() < 0)
    throwOpenError(errno, path);
  lockDevice(lock.get(), nameOf(remote));
  hid_device* device = nullptr;
  {
    const std::lock_guard<std::mutex> hidapi_lock(hidapiMutex());
    device = hid_open_path(path.c_str());
  }
  if (device == nullptr)
    throwOpenError(errno, path);
  return std::make_unique<HidrawTransport>(device, std::move(lock), remote);
}

std::unique_ptr<Transport> openFirstFree(const std::vector<Remote>& all) {
  std::optional<PermissionDenied> denied;
  std::optional<TransportError> other;
  std::string taken;
  for (const Remote& remote : all) {
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

void beginAfter(const std::string& last, std::vector<Remote>* remotes) {
  const auto at = std::find_if(remotes->begin(), remotes->end(),
                               [&](const Remote& remote) { return remote.description == last; });
  if (at != remotes->end())
    std::rotate(remotes->begin(), at + 1, remotes->end());
}

std::unique_ptr<Transport> openHidraw(const DeviceName& name, const std::string& last) {
  std::vector<Remote> all = enumerate();
  if (name.kind == DeviceName::Kind::kAny) {
    if (all.empty())
      throw NoSuchDevice(
          "no Wii Remote is connected: press a button of a paired one, or pair one first");
    beginAfter(last, &all);
    return openFirstFree(all);
  }
  const bool by_address = name.kind == DeviceName::Kind::kAddress;
  for (const Remote& remote : all) {
    if ((by_address ? remote.identity : remote.description) == name.value)
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
