#ifndef WIIMOTE_TRACKER_DRIVER_WIIMOTE_IMAGE_ASSEMBLER_H
#define WIIMOTE_TRACKER_DRIVER_WIIMOTE_IMAGE_ASSEMBLER_H

#include "wiimote_tracker_driver/protocol/input_reports.h"

#include <cstdint>
#include <optional>

namespace wiimote_tracker::wiimote {

/// Makes images of the data reports of one infrared format. In the full format an image comes in
/// two halves; one without its partner gives none.
class ImageAssembler {
 public:
  /// Halves of one image are one period (10 ms) apart. When the two reports between a first and a
  /// second half were lost, these belong to different images and are three periods apart; the
  /// middle is where late reports and losses are confused least [s]. After a stall, when reports
  /// come all at once, a loss within it cannot be told.
  static constexpr double kLongestGap = 0.020;

  /// @throws std::invalid_argument for kNone.
  explicit ImageAssembler(protocol::IrFormat format);

  /// The report mode that carries the format.
  std::uint8_t reportMode() const { return mode_; }

  /// Whether a data report of this id is part of the format.
  bool expects(std::uint8_t id) const;

  /// Takes a data report that arrived at `now` [s]. @returns the image that it completes.
  std::optional<protocol::DataReport> add(const protocol::Report& report, double now);

 private:
  std::uint8_t mode_;
  protocol::Report first_;  ///< Half that waits for its second; empty when there is none.
  double first_arrival_ = 0.0;
};

}  // namespace wiimote_tracker::wiimote

#endif  // WIIMOTE_TRACKER_DRIVER_WIIMOTE_IMAGE_ASSEMBLER_H
