#pragma once

#include "recording/reader.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace wiimote_tracker::recording_info {

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
  /// Between successive data reports of a connection [s], in increasing order.
  std::vector<double> intervals;
  std::string damage;  ///< Empty: none.
};

/// Reads to the end.
Summary summarize(recording::Reader& reader);

/// Several lines for the user.
std::string describe(const Summary& summary);

}  // namespace wiimote_tracker::recording_info
