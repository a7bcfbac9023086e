#pragma once

#include "scene.h"

#include <cstddef>
#include <mutex>
#include <string>

namespace wiimote_tracker::real_kernel {

/// Totals over all published images of a scenario. Thread-safe.
class ImageTotals {
 public:
  /// Records an image; `problem` is empty if it is right.
  void add(const std::string& problem);

  bool right() const;
  std::string text() const;

 private:
  mutable std::mutex mutex_;  // guards the next
  std::size_t images_ = 0;
  std::size_t wrong_ = 0;
  std::string first_problem_;
};

/// Compares the images of one driver with what was in front of its camera.
class ImageRecord {
 public:
  explicit ImageRecord(const Scene& scene) : scene_(scene) {}

  /// Whether the image shows any light.
  static bool showsLights(const protocol::DataReport& image);

  /// What is wrong with an image that shows lights and has just been published; empty if it shows
  /// the lights of one of the last frames, no earlier than that of the image before. (The virtual
  /// remote repeats its last report when a program sets the mode.)
  std::string problemOf(const protocol::DataReport& image);

 private:
  const Scene& scene_;
  long last_frame_ = 0;
};

}  // namespace wiimote_tracker::real_kernel
