#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_SESSION_FRAME_LINES_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_SESSION_FRAME_LINES_H

#include "wiimote_tracker_calibration/wave/recording.h"

#include <cstddef>
#include <string>
#include <vector>

namespace wiimote_tracker::session {

/// Appends one line per frame, indented by two spaces: stamp [s], then x and y [px] of every spot.
void appendFrames(const std::vector<wave::Frame>& frames, std::string* text);

/// Reads a text line by line.
class Lines {
 public:
  /// @param text outlives this; @param begin where to start in it; @param where names the file.
  Lines(const std::string& text, std::size_t begin, const std::string& where);

  /// @throws Error naming the line: the next line is different.
  void expect(const std::string& line);

  /// Reads what appendFrames() wrote.
  /// @throws Error naming the line: the next `count` lines are not frames.
  std::vector<wave::Frame> frames(std::size_t count);

  /// @throws Error: there are more lines.
  void expectEnd();

 private:
  std::string next();
  [[noreturn]] void refuse(const std::string& what) const;

  const std::string& text_;
  std::size_t position_;
  std::string where_;
  std::size_t number_;  // of the line read last, as an editor counts
};

}  // namespace wiimote_tracker::session

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_SESSION_FRAME_LINES_H
