#include "virtual_remotes.h"

#include "wiimote_tracker_driver/virtual_wiimote/server.h"

#include <wiimote_tracker_msgs/text.h>

#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <exception>
#include <memory>
#include <system_error>
#include <thread>
#include <vector>

namespace wiimote_tracker {

using SteadyClock = std::chrono::steady_clock;

namespace {

std::size_t sharedSize(int count) {
  return sizeof(std::atomic<double>) * static_cast<std::size_t>(count) *
         VirtualRemotes::kMostSamples;
}

/// All zeros.
std::atomic<double>* sharedMemory(int count) {
  static_assert(std::atomic<double>::is_always_lock_free, "it is shared between processes");
  void* memory =
      ::mmap(nullptr, sharedSize(count), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED)
    throw std::system_error(errno, std::generic_category(),
                            "memory shared with the virtual remotes");
  return static_cast<std::atomic<double>*>(memory);
}

}  // namespace

VirtualRemotes::VirtualRemotes(int count, const std::string& folder)
    : count_(count), folder_(folder), sent_(sharedMemory(count)), process_([this] { serve(); }) {}

VirtualRemotes::~VirtualRemotes() {
  ::munmap(sent_, sharedSize(count_));
}

std::atomic<double>& VirtualRemotes::sent(int remote, std::uint32_t sample) const {
  return sent_[static_cast<std::size_t>(remote) * kMostSamples + sample];
}

void VirtualRemotes::serve() {
  ::signal(SIGINT, SIG_IGN);  // the benchmark ends this process
  try {
    std::vector<std::unique_ptr<virtual_wiimote::Server>> servers;
    for (int i = 0; i < count_; ++i) {
      const std::string address = format("00:1f:32:00:00:%02x", static_cast<unsigned>(i) & 0xffu);
      servers.push_back(std::make_unique<virtual_wiimote::Server>(
          socket(i), address, virtual_wiimote::Device::Options()));
    }
    virtual_wiimote::Senses senses;
    senses.lights.resize(1);
    const auto step = std::chrono::duration_cast<SteadyClock::duration>(
        std::chrono::duration<double>(kPeriod / count_));
    auto due = SteadyClock::now();
    for (std::uint32_t sample = 1; sample < kMostSamples; ++sample) {
      const std::uint32_t column = sample % 1024, row = sample / 1024;
      senses.lights[0].x = column;
      senses.lights[0].y = row;
      for (int i = 0; i < count_; ++i, due += step) {
        std::this_thread::sleep_until(due);
        const double before = steadyNow();
        if (servers[static_cast<std::size_t>(i)]->sample(senses))
          sent(i, sample) = before;
      }
    }
    ::pause();
  } catch (const std::exception& e) {
    std::fprintf(stderr, "the virtual remotes: %s\n", e.what());
  }
  ::_exit(1);
}

}  // namespace wiimote_tracker
