#pragma once

#include <cstdint>
#include <random>

namespace wiimote_tracker::virtual_wiimote {

/// Clock of a camera and delays of its reports. Times in s. The default is ideal.
struct FrameTimesModel {
  double period = 0.010035;  ///< nominal, between exposures; > 0
  double phase = 0.0;        ///< of the first exposure
  double delay = 0.0;        ///< least time from exposure to arrival
  double jitter = 0.0;       ///< meaning: see `core`
  enum class Core {
    kExponential,  ///< least delay + exponential of mean `jitter`
    kNormal  ///< least delay + normal of mean 3.4 jitter and standard deviation `jitter`, >= 0
  };
  Core core = Core::kExponential;
  /// Greatest relative deviation of the true period from the nominal one (uniform).
  double period_tolerance = 0.0;
  /// Standard deviation of the random walk of the phase over 10 s.
  double wander = 0.0;
  /// Interval of the radio link's slots, at which reports leave the device; 0: at any time.
  double slot = 0.0;
  /// Share of lost frames, < 1; after a loss, the next frame is lost with probability `burst`.
  double drops = 0.0;
  double burst = 0.0;
  /// Stalls per second; each delays all reports by up to `longest_stall` (uniform). They then
  /// arrive together, in order.
  double stalls = 0.0;
  double longest_stall = 0.160;
};

struct FrameTime {
  std::int64_t frame = 0;
  double exposure = 0.0;  ///< [s]
  bool lost = false;      ///< its report does not arrive; `arrival` is undefined
  double arrival = 0.0;   ///< never before that of the previous report [s]
  /// Delayed by an earlier report or a stall: the arrival is uninformative.
  bool queued = false;
};

/// Exposure and arrival times of the frames of a simulated camera. The same model and seed give the
/// same times.
class FrameTimes {
 public:
  FrameTimes(const FrameTimesModel& model, std::uint64_t seed);

  FrameTime next();
  /// The true period of this session [s].
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
