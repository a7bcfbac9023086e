#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace wiimote_tracker::intrinsics {

constexpr int kBoardRows = 4;
constexpr int kBoardColumns = 4;
constexpr int kBoardLeds = kBoardRows * kBoardColumns;

/// A flat grid of 4 x 4 LEDs. Seen from its front, LED 0 is at the top left; numbers run along the
/// rows. Board frame: x along the rows, y down the columns, z into the board, origin in LED 0.
struct Board {
  double column_spacing = 0.1;  ///< From one column to the next, along x [m, > 0].
  double row_spacing = 0.1;     ///< From one row to the next, along y [m, > 0].

  /// Place of an LED in the board frame [m].
  Eigen::Vector3d position(int led) const {
    const int column = led % kBoardColumns, row = led / kBoardColumns;
    return {column * column_spacing, row * row_spacing, 0.0};
  }
};

/// One view of the board, held still.
struct BoardView {
  /// By the number of the LED: distorted pixel [px], or nothing: not seen.
  std::array<std::optional<Eigen::Vector2d>, kBoardLeds> pixels;

  std::size_t count() const {
    return static_cast<std::size_t>(
        std::count_if(pixels.begin(), pixels.end(), [](const auto& p) { return p.has_value(); }));
  }
};

/// Input of solveIntrinsics().
struct Samples {
  Board board;
  int width = 1024;  ///< Image size [px].
  int height = 768;  ///< Image size [px].
  std::vector<BoardView> views;
};

}  // namespace wiimote_tracker::intrinsics
