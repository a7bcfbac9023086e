#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace wiimote_tracker::capture {

/// Spots of one image [px], lens distortion still in them.
using Blobs = std::vector<Eigen::Vector2d>;

/// A spot is not interpolated between images further apart [s].
constexpr double kLongestGap = 0.05;

/// The spot of a light moves less from image to image; farther is another light [px].
constexpr double kLongestJump = 80.0;

/// Of samples of a moving LED [s].
constexpr double kSamplePeriod = 0.05;

/// Standard deviation of a camera's time offset that was not estimated, as in
/// tracking/clock_offsets.cpp: assumed [s].
constexpr double kUnknownOffset = 0.005;

/// Removes spots that no image can have: not finite, or outside of `width` x `height` [px].
inline void removeImpossible(double width, double height, Blobs* spots) {
  spots->erase(std::remove_if(spots->begin(), spots->end(),
                              [&](const Eigen::Vector2d& spot) {
                                return !(spot.x() >= -1.0 && spot.x() <= width &&
                                         spot.y() >= -1.0 && spot.y() <= height);
                              }),
               spots->end());
}

/// What one camera saw at one time.
struct Image {
  std::string camera;
  double stamp = 0.0;             ///< Exposure time by the camera's clock [s].
  std::uint32_t clock_epoch = 0;  ///< As in IrBlobArray.msg.
  Blobs spots;                    ///< Without the masked ones.
  Blobs masked;                   ///< Spots that lie in a masked region.
  std::string identity{};         ///< Of the device; empty: unknown.
};

constexpr std::size_t kCellColumns = 8;
constexpr std::size_t kCellRows = 6;

/// Cells of an image, row by row, in which the LED was seen.
struct ImageCells : std::bitset<kCellColumns * kCellRows> {
  /// @param width, height of the image [px, > 0]. A pixel beyond its edge counts as on the edge.
  void add(const Eigen::Vector2d& pixel, int width, int height) {
    const auto cellAt = [](double coordinate, int size, std::size_t cells) {
      const double cell = coordinate / size * static_cast<double>(cells);
      return std::min(static_cast<std::size_t>(std::max(cell, 0.0)), cells - 1);
    };
    set(cellAt(pixel.y(), height, kCellRows) * kCellColumns +
        cellAt(pixel.x(), width, kCellColumns));
  }

  /// [0..1]
  double share() const { return static_cast<double>(count()) / static_cast<double>(size()); }
};

}  // namespace wiimote_tracker::capture
