#ifndef WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_FRAME_TIMES_H
#define WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_FRAME_TIMES_H

#include <cstdint>
#include <random>

namespace wiimote_tracker::virtual_wiimote {

/// A camera's own clock, and how its reports come to be late. Times in s. By default all is ideal.
struct FrameTimesModel {
  double period = 0.010035;  ///< nominal, between exposures; > 0
  double phase = 0.0;        ///< of the first exposure
  double delay = 0.0;        ///< least time from exposure to arrival
  double jitter = 0.0;       ///< what `core` makes of it
  enum class Core {
    kHardEdge,  ///< least delay + exponential of mean `jitter`
    kBell       ///< least delay + normal of mean 3.4 jitter and standard deviation `jitter`, >= 0
  };
  Core core = Core::kHardEdge;
  /// The true period differs from the nominal one by up to this share (uniform).
  double period_tolerance = 0.0;
  /// Standard deviation of the random walk of the phase over 10 s.
  double wander = 0.0;
  /// Reports leave the device at the slots of the radio link, this far apart; 0: at any time.
  double slot = 0.0;
  /// Share of lost frames, < 1; each loss takes the next frame along with probability `burst`.
  double drops = 0.0;
  double burst = 0.0;
  /// Stalls per second; each holds all reports for up to `longest_stall` (uniform). Those that wait
  /// then come at once, in order.
  double stalls = 0.0;
  double longest_stall = 0.160;
};

struct FrameTime {
  std::int64_t frame = 0;
  double exposure = 0.0;  ///< [s]
  bool lost = false;      ///< no report of it arrives, and arrival means nothing
  double arrival = 0.0;   ///< not before that of the report before [s]
  /// Waited for an earlier report or for the end of a stall: the arrival says little.
  bool queued = false;
};

/// When the frames of a simulated camera are exposed and their reports arrive, frame after frame.
/// The same model and seed give the same times.
class FrameTimes {
 public:
  FrameTimes(const FrameTimesModel& model, std::uint64_t seed);

  FrameTime next();
  /// The true one of this session [s].
  double period() const { return period_; }

 private:
  double uniform();
  double delay();

  FrameTimesModel model_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  double period_, wander_per_frame_, slot_phase_;
  double wandered_ = 0.0;
  std::int64_t frame_ = 0;
  bool losing_ = false;
  double stall_end_, last_arrival_;
};

}  // namespace wiimote_tracker::virtual_wiimote

#endif
