#include "air.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>

namespace wiimote_tracker::real_kernel {
namespace {

// Longest wait for packets [s]: then new timers and adapters are looked at.
constexpr double kTurn = 0.005;
constexpr std::uint8_t kConnectionTimeout = 0x08;
constexpr std::size_t kLongestPacket = 2048;
constexpr double kCallInterval = 0.64;  // [s] Between two calls of a remote that nobody answers.
constexpr double kCalls = 10.0;         // [s] For how long a remote calls after a button.

}  // namespace

Air::Air() : thread_([this] { run(); }) {}

Air::~Air() {
  stop_ = true;
  thread_.join();
}

void Air::addAdapter(const std::string& address) {
  const std::lock_guard<std::mutex> lock(mutex_);
  adapters_.emplace_back(address, remotes_, timers_);
}

void Air::addRemote(const std::string& address, Scene& scene, bool plus) {
  const std::lock_guard<std::mutex> lock(mutex_);
  remotes_.emplace_back(address, plus, scene, timers_);
}

void Air::press(const std::string& address, Press press) {
  const std::lock_guard<std::mutex> lock(mutex_);
  Remote& pressed = remote(address);
  pressed.press(press);
  if (press == Press::kOther)
    call(pressed, now() + kCalls);
}

/// Calls the computer that the remote is paired with until it answers, at most until `end` [s].
void Air::call(Remote& remote, double end) {
  const auto bond = remote.bondedTo();
  if (!bond || remote.connected() || now() > end)
    return;
  for (Adapter& adapter : adapters_) {
    if (adapter.address() == *bond && adapter.call(remote))
      return;
  }
  timers_.after(kCallInterval, [this, &remote, end] { call(remote, end); });
}

void Air::cutPower(const std::string& address) {
  const std::lock_guard<std::mutex> lock(mutex_);
  remote(address).lose(kConnectionTimeout);
}

Remote& Air::remote(const std::string& address) {
  const auto found = std::find_if(remotes_.begin(), remotes_.end(), [&](const Remote& remote) {
    return remote.address() == addressFrom(address);
  });
  if (found == remotes_.end())
    throw std::invalid_argument("no such remote: " + address);
  return *found;
}

void Air::run() {
  while (!stop_) {
    double wait = 0.0;
    std::vector<pollfd> fds;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      wait = timers_.run(kTurn);
      for (const Adapter& adapter : adapters_)
        fds.push_back({adapter.fd(), POLLIN, 0});
    }
    const timespec timeout{0, static_cast<long>(1e9 * wait)};
    if (::ppoll(fds.data(), fds.size(), &timeout, nullptr) <= 0)
      continue;
    const std::lock_guard<std::mutex> lock(mutex_);
    for (std::size_t i = 0; i < fds.size(); ++i) {
      Bytes packet(kLongestPacket);
      const ssize_t size =
          fds[i].revents & POLLIN ? ::read(fds[i].fd, packet.data(), packet.size()) : 0;
      packet.resize(static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
      if (!packet.empty())
        adapters_[i].handle(packet);
    }
  }
}

}  // namespace wiimote_tracker::real_kernel
