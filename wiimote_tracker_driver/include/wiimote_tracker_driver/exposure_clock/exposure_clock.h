#ifndef WIIMOTE_TRACKER_DRIVER_EXPOSURE_CLOCK_EXPOSURE_CLOCK_H
#define WIIMOTE_TRACKER_DRIVER_EXPOSURE_CLOCK_EXPOSURE_CLOCK_H

#include "wiimote_tracker_driver/exposure_clock/clock_filter.h"
#include "wiimote_tracker_driver/exposure_clock/frame_counter.h"

#include <array>
#include <cstdint>

namespace wiimote_tracker::exposure_clock {

struct ExposureClockOptions {
  double period = 0.010035;          ///< nominal period of the frames [s]
  double period_stddev = 300e-6;     ///< its standard deviation, relative
  double stale_age = 0.030;          ///< a report later than this is stale [s]
};

/// What one report's arrival says.
struct Estimate {
  double exposure = 0.0;   ///< exposure time, apart from the link's least delay [s]
  double stddev = 0.0;     ///< of exposure, with doubts about the frame's number [s]
  double clock_stddev = 0.0;  ///< the part of it that would remain if the frame's number were certain [s]
  std::int64_t frame = 0;  ///< number of the frame since the start of the epoch; gaps are lost frames
  int dropped = 0;         ///< frames lost between the previous report and this one
  bool stale = false;      ///< the report was queued: it is more than stale_age older than usual
  bool restarted = false;  ///< the clock was lost and starts anew with this report
};

struct Statistics {
  double period = 0.0;        ///< [s]
  double period_stddev = 0.0; ///< [s]
  double jitter = 0.0;        ///< standard deviation of the delay, without stalls [s]
  double hard_edge = 0.0;     ///< probability that the delay has a hard lower edge
  std::uint64_t reports = 0, dropped = 0, stale = 0, restarts = 0;
};

class ExposureClock {
 public:
  explicit ExposureClock(const ExposureClockOptions& options = {});

  Estimate update(double arrival);
  void reset();
  Statistics statistics() const;

  static constexpr int kModels = 9;
  double weight(int i) const { return weight_[i]; }
  const ClockFilter& filter(int i) const { return filters_[i]; }

 private:
  void start(double arrival);

  ExposureClockOptions options_;
  std::array<ClockFilter, kModels> filters_;
  std::array<double, kModels> weight_;
  FrameCounter counter_;
  bool running_ = false;
  std::int64_t base_ = 0;  // frame number at which the filters stand
  double origin_ = 0.0;
  double last_arrival_ = 0.0;
  double last_exposure_ = 0.0;
  std::int64_t last_frame_ = -1;
  Statistics statistics_;
};

}  // namespace wiimote_tracker::exposure_clock

#endif
