#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace wiimote_tracker::tracking {

/// Which cameras to trust, since the clocks of their computers agree with most others'.
///
/// No clock is read: images are compared as they come, so the newest images of two cameras have
/// about the same arrival time if their clocks agree. Delays make this true of some images only,
/// and of a few whose clocks disagree. So two clocks agree if more than a quarter of the recent
/// comparisons are within kTolerance. Images of a camera that come together after a pause count as
/// one. The largest group of cameras that agree is trusted; none if two groups are equally large.
/// Two that disagree but both agree with a third are not yet of two groups.
class ComputerClocks {
 public:
  static constexpr double kTolerance = 0.04;  ///< Between clocks that agree [s].

  explicit ComputerClocks(std::size_t cameras);

  /// @param arrival of the camera's next image by its own clock, finite [s].
  /// @returns whether it can be used: the camera is trusted, and the image fits its time.
  bool add(std::size_t camera, double arrival);

  bool isTrusted(std::size_t camera) const { return cameras_[camera].trusted; }

  /// Arrival of a camera's newest image [s]; nothing before the first.
  const std::optional<double>& newestOf(std::size_t camera) const {
    return cameras_[camera].newest;
  }

  /// Whether both cameras send images; false for one camera and itself.
  bool areActive(std::size_t a, std::size_t b) const { return activePair(a, b) != nullptr; }

  /// How far the clock of a camera that is not trusted is ahead of those that are [s]; NaN when
  /// none is trusted. Nothing for a trusted camera.
  std::optional<double> ahead(std::size_t camera) const;

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
  };

  struct Camera {
    std::optional<double> newest;  // arrival of its newest image [s]
    std::optional<double> used;    // of the last one that can be used [s]
    bool was_behind = false;       // its last image was older than `newest`
    std::vector<int> unanswered;   // per other camera: images of this one since the other's last
    std::size_t votes = 0;         // cameras that agree with it, and itself
    bool trusted = true;
  };

  static constexpr int kWindow = 25;  ///< Comparisons of two cameras; there are two windows.
  static constexpr int kLeast = 8;    ///< Comparisons before they may change whether two agree.

  /// Images of one camera after which another is silent; more than come together after a pause.
  static constexpr int kSilence = 100;

  /// A camera is compared with another's last image until as many came from it alone since.
  static constexpr int kRecent = 10;

  std::size_t indexOf(std::size_t a, std::size_t b) const;
  const Pair* activePair(std::size_t a, std::size_t b) const;
  bool doAgree(std::size_t a, std::size_t b) const;
  bool someAgreesWith(std::size_t a, std::size_t b) const;
  bool comparePairs(std::size_t camera, double arrival);
  void vote();
  bool isOutlier(std::size_t camera, double arrival) const;
  static void noteNewest(double arrival, Camera* camera);

  std::vector<Camera> cameras_;
  std::vector<Pair> pairs_;  // [a, b] with a < b: of a's newest image ahead of b's
};

}  // namespace wiimote_tracker::tracking
