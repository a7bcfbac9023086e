#ifndef WIIMOTE_TRACKER_DRIVER_TOOLS_RECORDING_INFO_SUMMARY_H
#define WIIMOTE_TRACKER_DRIVER_TOOLS_RECORDING_INFO_SUMMARY_H

#include "recording/reader.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace wiimote_tracker::recording_info {

/// Intervals between successive data reports of a connection.
class Intervals {
 public:
  /// [s]
  void add(double interval);

  std::uint64_t count() const { return count_; }
  /// [s]; 0 without any.
  double mean() const { return count_ == 0 ? 0.0 : sum_ / static_cast<double>(count_); }
  double longest() const { return longest_; }   ///< [s]; 0 without any.
  std::uint64_t gaps() const { return gaps_; }  ///< Longer than kGap.
  double quantile(double share) const;          ///< [s], to 0.1 ms, at most 1 s; 0 without any.

  static constexpr double kGap = 0.05;  ///< [s] About five lost reports.

 private:
  std::array<std::uint64_t, 10000>
      histogram_{};  ///< In steps of 0.1 ms; the last one includes all longer ones.
  std::uint64_t count_ = 0;
  std::uint64_t gaps_ = 0;
  double sum_ = 0.0;
  double longest_ = 0.0;
};

struct Connection {
  transport::Remote remote;
  double begin = 0.0;  ///< Since the start of the recording [s].
  double end = 0.0;
  bool ended = false;      ///< False: the recording ended first.
  std::string end_reason;  ///< Empty: the driver released the remote.
};

struct Summary {
  recording::FileHeader header;
  double duration = 0.0;  ///< Up to the last record [s].
  std::vector<Connection> connections;
  std::array<std::uint64_t, 256> received{};  ///< Reports per id.
  std::array<std::uint64_t, 256> sent{};
  Intervals intervals;
  std::string damage;  ///< Empty: none.
};

/// Reads to the end.
Summary summarize(recording::Reader& reader);

/// Several lines for the user.
std::string describe(const Summary& summary);

}  // namespace wiimote_tracker::recording_info

#endif  // WIIMOTE_TRACKER_DRIVER_TOOLS_RECORDING_INFO_SUMMARY_H
