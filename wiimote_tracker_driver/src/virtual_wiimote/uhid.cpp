#include "virtual_wiimote/uhid.h"

#include "file_descriptor.h"
#include "virtual_wiimote/faulty_device.h"
#include "virtual_wiimote/report_descriptor.h"

#include <fcntl.h>
#include <linux/input.h>
#include <linux/uhid.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <deque>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

namespace wiimote_tracker::virtual_wiimote {
namespace {

constexpr char kPath[] = "/dev/uhid";
constexpr std::uint32_t kNintendo = 0x057e;
constexpr std::size_t kLargestReport = 22;
constexpr int kLongestWait = 50;  // [ms] Until the thread sees that it is to end.

using Clock = std::chrono::steady_clock;

[[noreturn]] void fail(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), what);
}

template <std::size_t N>
void copyText(const std::string& text, __u8 (&field)[N]) {
  std::memcpy(field, text.data(), std::min(text.size(), N - 1));
}

Device::Options deviceOptions(const UhidDevice::Options& options) {
  Device::Options device = options.device;
  device.motion_plus |= options.model == UhidDevice::Model::kRemotePlus;
  return device;
}

}  // namespace

struct UhidDevice::State {
  State(UhidDevice& uhid_device, std::string device_address, const Options& device_options)
      : owner(uhid_device),
        address(std::move(device_address)),
        options(device_options),
        uhid(::open(kPath, O_RDWR | O_CLOEXEC | O_NONBLOCK)) {
    if (!uhid.open())
      fail(std::string("cannot open ") + kPath + " (load the module uhid and be root)");
  }

  UhidDevice& owner;
  const std::string address;
  const Options options;
  const FileDescriptor uhid;

  struct InTransit {
    Clock::time_point due;
    Bytes report;
  };
  bool plugged = false;  ///< Guarded by the owner's mutex, as is in_transit.
  std::deque<InTransit> in_transit;

  std::atomic<bool> stop{false};
  std::thread thread;

  /// The kernel pads short events with zeros.
  bool write(const uhid_event& event, std::size_t payload) const {
    const std::size_t size = offsetof(uhid_event, u) + payload;
    return ::write(uhid.get(), &event, size) == static_cast<ssize_t>(size);
  }

  void create() const {
    uhid_event event{};
    event.type = UHID_CREATE2;
    uhid_create2_req& request = event.u.create2;
    copyText(options.model == Model::kRemote ? "Nintendo RVL-CNT-01" : "Nintendo RVL-CNT-01-TR",
             request.name);
    copyText(address, request.uniq);
    std::copy(kReportDescriptor.begin(), kReportDescriptor.end(), request.rd_data);
    request.rd_size = kReportDescriptor.size();
    request.bus = BUS_BLUETOOTH;
    request.vendor = kNintendo;
    request.product = static_cast<std::uint32_t>(options.model);
    if (!write(event, sizeof(request)))
      fail("plugging in the virtual Wii Remote " + address);
  }

  void destroy() const {
    uhid_event event{};
    event.type = UHID_DESTROY;
    if (!write(event, 0))
      fail("unplugging the virtual Wii Remote " + address);
  }

  // The kernel refuses input from a device that it is removing: lost, as over the air.
  void send(const Bytes& report) const {
    uhid_event event{};
    event.type = UHID_INPUT2;
    uhid_input2_req& request = event.u.input2;
    request.size = static_cast<__u16>(report.size());
    std::copy(report.begin(), report.end(), request.data);
    write(event, offsetof(uhid_input2_req, data) + report.size());
  }

  void receive(const __u8* data, std::size_t size) {
    const auto latency =
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options.latency));
    const std::lock_guard<std::mutex> lock(owner.mutex_);
    if (plugged)
      in_transit.push_back(
          {Clock::now() + latency, Bytes(data, data + std::min(size, kLargestReport))});
  }

  void deliver() {
    const std::lock_guard<std::mutex> lock(owner.mutex_);
    for (; !in_transit.empty() && in_transit.front().due <= Clock::now(); in_transit.pop_front()) {
      const Bytes& report = in_transit.front().report;
      if (options.listener)
        options.listener(report);
      owner.send(owner.device_->handleOutput(report));
    }
  }

  /// An output report on the control channel; a Remote Plus refuses it.
  void setReport(const uhid_set_report_req& request) {
    uhid_event reply{};
    reply.type = UHID_SET_REPORT_REPLY;
    reply.u.set_report_reply.id = request.id;
    const bool output = request.rtype == UHID_OUTPUT_REPORT && request.size > 0;
    reply.u.set_report_reply.err = output ? 0 : EIO;
    write(reply, sizeof(reply.u.set_report_reply));
    if (!output)
      return;
    if (options.model == Model::kRemotePlus)
      send({0x22, 0, 0, request.data[0], 2});
    else
      receive(request.data, request.size);
  }

  /// A remote has no reports on the control channel.
  void refuseGetReport(const uhid_get_report_req& request) const {
    uhid_event reply{};
    reply.type = UHID_GET_REPORT_REPLY;
    reply.u.get_report_reply.id = request.id;
    reply.u.get_report_reply.err = EIO;
    write(reply, offsetof(uhid_get_report_reply_req, data));
  }

  void handleEvents() {
    uhid_event event{};
    while (::read(uhid.get(), &event, sizeof(event)) > 0) {
      if (event.type == UHID_OUTPUT)
        receive(event.u.output.data, event.u.output.size);
      else if (event.type == UHID_SET_REPORT)
        setReport(event.u.set_report);
      else if (event.type == UHID_GET_REPORT)
        refuseGetReport(event.u.get_report);
    }
  }

  /// Time until the next report is due [ms, rounded up], at most kLongestWait.
  int timeout() const {
    const std::lock_guard<std::mutex> lock(owner.mutex_);
    if (in_transit.empty())
      return kLongestWait;
    const auto wait = std::chrono::duration_cast<std::chrono::milliseconds>(in_transit.front().due -
                                                                            Clock::now());
    return std::clamp(1 + static_cast<int>(wait.count()), 0, kLongestWait);
  }

  void run() {
    while (!stop) {
      pollfd fd{uhid.get(), POLLIN, 0};
      if (::poll(&fd, 1, timeout()) > 0)
        handleEvents();
      deliver();
    }
  }
};

UhidDevice::UhidDevice(const std::string& address, const Options& options)
    : HostedDevice(deviceOptions(options), false),
      state_(std::make_unique<State>(*this, address, options)) {
  setPresent(true);
  state_->thread = std::thread([this] { state_->run(); });
}

UhidDevice::~UhidDevice() {
  state_->stop = true;
  state_->thread.join();
  // Closing the descriptor unplugs the device.
}

void UhidDevice::send(const std::vector<Bytes>& reports) {
  for (const Bytes& report : reports)
    state_->send(report);
}

void UhidDevice::setReachable(bool reachable) {
  if (reachable == state_->plugged)
    return;
  if (reachable) {
    state_->create();
  } else {
    state_->destroy();
    state_->in_transit.clear();
  }
  state_->plugged = reachable;
}

}  // namespace wiimote_tracker::virtual_wiimote
