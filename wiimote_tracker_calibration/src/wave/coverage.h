#pragma once

#include "capture/image.h"
#include "wiimote_tracker_calibration/wave/recording.h"

#include <wiimote_tracker_triangulation/geometry/camera.h>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker::wave {

/// When a wave is complete.
struct CoverageOptions {
  double seconds = 15.0;  ///< In which two cameras or more see the LED move [s, > 0].
  /// Of the cells of each camera's image [0 to 1]. The paper's cube fills 0.38 of its images.
  double image_share = 0.25;
  double image_speed = 100.0;  ///< Median of its spot in each image [px/s, >= 0].
  double volume = 1.0;         ///< Passed through; only with known cameras [m^3, >= 0].
  double speed = 0.5;          ///< Median; only with known cameras [m/s, >= 0].
  double distraction = 0.3;    ///< Largest share of images with other lights [0 to 1].
};

/// What one camera has seen.
struct CameraCoverage {
  std::string name;
  capture::ImageCells filled;  ///< By a moving spot.
  double image_share = 0.0;    ///< Filled cells [0 to 1].
  double seconds = 0.0;        ///< In which it saw the LED move [s].
  double together = 0.0;       ///< Of these, with another camera [s].
  double image_speed = 0.0;    ///< Median of the spot's speed [px/s]; 0: never moved.
  double distraction = 0.0;    ///< Share of its images with more spots than LEDs [0 to 1].
};

/// Progress of a wave.
struct CoverageReport {
  std::vector<CameraCoverage> cameras;
  double seconds = 0.0;              ///< In which two cameras or more saw the LED move [s].
  std::optional<double> volume;      ///< Passed through [m^3]; nothing: cameras not known.
  std::optional<double> speed;       ///< Median [m/s]; nothing: cameras not known, or no motion.
  std::vector<std::string> missing;  ///< What to do, most urgent first; one sentence each.
  bool enough() const { return missing.empty(); }
};

/// Measures the coverage of a wave while it is recorded; fast enough for every frame of every
/// camera.
class Coverage {
 public:
  /// @param cameras names and image sizes; poses are used only when `posed`.
  /// @param leds 1, or 2 for a wand.
  Coverage(std::vector<geometry::Camera> cameras,
           bool posed,
           std::size_t leds,
           const CoverageOptions& options);

  /// Frames of one camera in the order of their stamps, those of all cameras about so: the LED is
  /// located by what each camera saw last.
  void add(std::size_t camera, const Frame& frame);

  /// Forgets all frames.
  void restart() { *this = Coverage(cameras_, posed_, leds_, options_); }

  CoverageReport report() const;

 private:
  /// Spots of successive images that are one light [s], [px].
  using Track = std::deque<std::pair<double, Eigen::Vector2d>>;
  /// Counts of speeds in equal steps; the last step takes all beyond.
  struct Speeds {
    std::array<std::uint32_t, 256> counts{};
    std::uint32_t total = 0;
    void add(double speed, double step);
    double median(double step) const;
  };
  struct View {
    std::vector<Track> tracks;
    capture::ImageCells filled;
    Speeds speeds;
    std::size_t frames = 0;
    std::size_t distracted = 0;
    double time = 0.0;                      // of `middle`
    std::optional<Eigen::Vector2d> middle;  // of the moving LED or LEDs
  };

  static void follow(View* view, const Frame& frame);
  void locate(std::size_t camera);

  std::vector<geometry::Camera> cameras_;
  bool posed_;
  std::size_t leds_;
  CoverageOptions options_;
  std::vector<View> views_;
  std::map<std::int64_t, std::vector<bool>> seen_;  // by step of time: which cameras
  std::set<std::array<int, 3>> cells_;              // of the volume
  Speeds speeds_;
  std::optional<std::pair<double, Eigen::Vector3d>> last_;
};

}  // namespace wiimote_tracker::wave
