#pragma once

#include "process.h"

#include "ros/remote_source.h"

#include <atomic>
#include <cstdint>
#include <string>

namespace wiimote_tracker {

using driver::steadyNow;  // the clock that both processes share

/// Virtual remotes in their own process, so that their work does not count as the driver's. Each
/// samples 100 times a second, evenly spread over the period; the place of one light encodes the
/// sample.
class VirtualRemotes {
 public:
  static constexpr double kPeriod = 0.01;  ///< [s]
  /// Samples of a remote: about ten minutes. After them it sends nothing.
  static constexpr std::uint32_t kMostSamples = 1u << 16;

  /// Forks; call it while this process has one thread. The sockets are made in `folder`.
  /// @throws std::runtime_error.
  VirtualRemotes(int count, const std::string& folder);
  ~VirtualRemotes();
  VirtualRemotes(const VirtualRemotes&) = delete;
  VirtualRemotes& operator=(const VirtualRemotes&) = delete;

  int count() const { return count_; }
  std::string socket(int remote) const { return folder_ + "/" + std::to_string(remote); }

  /// When this sample's data report was given to the link [s]; 0 when there was none (yet).
  double sentAt(int remote, std::uint32_t sample) const { return sent(remote, sample); }

  /// The sample that a light at this place (y up) encodes.
  static std::uint32_t sampleAt(int x, int y) { return static_cast<std::uint32_t>(1024 * y + x); }

 private:
  std::atomic<double>& sent(int remote, std::uint32_t sample) const;
  [[noreturn]] void serve();

  const int count_;
  const std::string folder_;
  std::atomic<double>* const sent_;  ///< [s] A row for each remote; both processes see it.
  const Process process_;
};

}  // namespace wiimote_tracker
