#pragma once

#include "capture/image.h"

#include <limits>
#include <map>
#include <string>
#include <vector>

namespace wiimote_tracker::capture {

/// What the cameras see of an LED that somebody carries through the volume. No camera needs to be
/// calibrated.
class Walk {
 public:
  /// An image with one spot shows the LED; others are ignored. @param width, height of the image
  /// [px, > 0].
  void add(const Image& image, int width, int height);

  /// Forgets all, since the cameras stand differently.
  void restart() { views_.clear(); }

  /// Share of the cells of a camera's image in which the LED was seen [0..1].
  double share(const std::string& camera) const;
  /// Cameras that saw it at the same time.
  std::vector<std::string> seenWith(const std::string& camera) const;
  /// Which cameras saw it together, and which alone; empty while nothing was seen.
  std::string sentence() const;

 private:
  struct View {
    ImageCells cells;
    double last = -std::numeric_limits<double>::infinity();  // stamp of the last sight [s]
    std::map<std::string, int> together;                     // images, by the other camera
  };
  std::map<std::string, View> views_;
};

}  // namespace wiimote_tracker::capture
