#pragma once

#include "wiimote_tracker_driver/protocol/input_reports.h"

#include <cstdint>
#include <limits>
#include <optional>

namespace wiimote_tracker::wiimote {

/// Makes images from the data reports of one infrared format. In the full format an image has two
/// halves; a half without its partner is dropped. So is a repeated report, which would mislead the
/// exposure clock: after it has acknowledged a report mode, a remote may repeat its last data
/// report at once (the virtual remote does).
class ImageAssembler {
 public:
  /// Longest time between two halves of an image [s]. They are one period (10 ms) apart. If the two
  /// reports between a first and a second half were lost, these are three periods apart. Of 32,000
  /// intervals of two recorded remotes 1.9 % were longer than 20 ms and 0.7 % than 25 ms; at most
  /// 0.2 % were three periods long and shorter than 25 ms. A loss within a burst cannot be
  /// detected.
  static constexpr double kLongestGap = 0.025;

  /// @throws std::invalid_argument for kNone.
  explicit ImageAssembler(protocol::IrFormat format);

  /// The report mode that carries the format.
  std::uint8_t reportMode() const { return mode_; }

  /// Whether a data report of this id is part of the format.
  bool expects(std::uint8_t id) const;

  /// The remote has acknowledged a report mode at `now` [s].
  void modeAcknowledged(double now) { acknowledged_ = now; }

  /// Takes a data report that arrived at `now` [s]. @returns the image that it completes.
  std::optional<protocol::DataReport> add(const protocol::Report& report, double now);

 private:
  bool isRepeated(const protocol::Report& report, double now);

  std::uint8_t mode_;
  protocol::Report first_;  ///< Half that waits for its second; empty when there is none.
  double first_arrival_ = 0.0;
  std::optional<double> acknowledged_;  ///< [s] Nothing once a data report has followed.
  protocol::Report last_;
  double last_arrival_ = -std::numeric_limits<double>::infinity();  ///< [s]
};

}  // namespace wiimote_tracker::wiimote
