#ifndef WIIMOTE_TRACKER_TRIANGULATION_TRACKING_ARRIVAL_CLOCKS_H
#define WIIMOTE_TRACKER_TRIANGULATION_TRACKING_ARRIVAL_CLOCKS_H

#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/tracking/camera_image.h"

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace wiimote_tracker::tracking {

/// When an image was exposed and when it arrived, both with the rig's time offset [s].
struct ImageTimes {
  double exposure;
  double arrival;
};

ImageTimes timesOf(const geometry::RigCamera& camera, const CameraImage& image);

/// Judges each camera's clock by the others', and detects that time jumped back for all, as when a
/// bag is played in a loop.
///
/// No clock is read: images are checked as they come, so the newest images of two cameras have
/// about the same arrival time if their computers' clocks agree. Delays make this true of some
/// images only, and of a few whose clocks disagree. So two clocks agree if more than a quarter of
/// the recent comparisons are within kTolerance. Images of a camera that come together after a
/// pause count as one. The largest group of cameras that agree is trusted; none if two groups are
/// equally large. Two that disagree but both agree with a third are not yet of two groups.
class ArrivalClocks {
 public:
  static constexpr double kTolerance = 0.04;  ///< Between clocks that agree [s].
  static constexpr double kJump = 0.1;        ///< Least jump back [s].

  /// @param newest_used newestUsed() of those that these follow, of other cameras. A jump
  /// back behind it is recognised when each camera had time for two images.
  explicit ArrivalClocks(std::size_t cameras,
                         double newest_used = -std::numeric_limits<double>::infinity());

  enum class Result {
    kUsable,
    kWrongClock,  ///< Do not use: its clock, or the time of this image, is not that of the others.
    kJumpedBack   ///< Usable, after a reset.
  };

  /// Checks an image, whose arrival is by the clock of its camera's computer. One whose times are
  /// not finite is of a wrong clock, too.
  Result check(std::size_t camera, const ImageTimes& times);

  /// How far the clock of a camera that is not trusted is ahead of those that are [s]; NaN when
  /// none is trusted. Nothing for a trusted camera.
  std::optional<double> ahead(std::size_t camera) const;

  /// Arrival of the newest image that is used [s]; before the first, as given or minus infinity.
  double newestUsed() const { return newest_used_; }

  /// Whether the last image arrived before an earlier used one.
  bool isDisordered() const { return disordered_; }

 private:
  /// Recent leads of one camera over another: by how much its newest image is ahead [s].
  struct Pair {
    struct Leads {
      int count = 0;
      int near = 0;  // within kTolerance
      double sum = 0.0;
    };
    void add(double lead);
    double meanLead() const {
      return (recent[0].sum + recent[1].sum) / (recent[0].count + recent[1].count);
    }

    std::array<Leads, 2> recent;  // the present and the former kWindow
    bool agrees = true;
    std::array<int, 2> unanswered{};  // images of either one since the other's last
  };
  struct Camera {
    std::optional<double> newest;  // arrival of its newest image [s]
    std::optional<double> used;    // of the last one that was used [s]
    // Of its newest image since the last jump that was at most kJump behind the newest of all [s].
    double in_step_until = -std::numeric_limits<double>::infinity();
    int images_behind = 0;    // since that one
    bool was_behind = false;  // its last image was older than `newest`
    bool trusted = true;
  };

  static constexpr int kWindow = 25;  ///< Comparisons of two cameras; there are two windows.
  static constexpr int kLeast = 8;    ///< Comparisons before they may change whether two agree.
  /// Images of one camera after which another is silent; more than come together after a pause.
  static constexpr int kSilence = 100;
  /// A camera is compared with another's last image until as many came from it alone since.
  static constexpr int kRecent = 10;
  /// More images of one camera do not wait in a network: about half a minute.
  static constexpr int kLongestBacklog = 3000;

  std::size_t indexOf(std::size_t a, std::size_t b) const;
  const Pair* activePair(std::size_t a, std::size_t b) const;
  bool doAgree(std::size_t a, std::size_t b) const;
  static void noteNewest(double arrival, Camera* camera);
  static void noteStep(double arrival, bool is_in_step, Camera* camera);
  static bool isBacklog(const Camera& camera);
  bool comparePairs(std::size_t camera, double arrival);
  void vote();
  bool someAgreesWith(std::size_t a, std::size_t b) const;
  bool isOutlier(std::size_t camera, double arrival) const;
  bool hasJumpedBack(std::size_t camera) const;

  std::vector<Camera> cameras_;
  std::vector<Pair> pairs_;  // [a, b] with a < b: of a's newest image ahead of b's
  std::vector<std::size_t> votes_;
  double newest_used_;             // arrival [s]
  std::size_t newest_camera_ = 0;  // whose it is
  std::size_t awaited_;            // images before a jump back is recognised
  bool disordered_ = false;
};

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_TRACKING_ARRIVAL_CLOCKS_H
