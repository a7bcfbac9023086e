#include "intrinsics/board_run.h"

#include "intrinsics/board_sequence.h"

namespace wiimote_tracker::intrinsics {

namespace {

constexpr double kPeriod = 0.25;  // between two readings [s]

}  // namespace

BoardRun::BoardRun(const Board& board, int width, int height, int minimum_views)
    : collector_(board, width, height, minimum_views) {}

bool BoardRun::add(double time, const std::vector<Eigen::Vector2d>& spots) {
  decoder_.add(time, spots);
  const bool set_back = time < next_reading_ - sequence::kCycle - kPeriod;
  if (time < next_reading_ && !set_back)
    return false;
  next_reading_ = time + kPeriod;
  const BoardReading reading = decoder_.read();
  message_ = reading.message;
  if (!reading.view)
    return true;
  const std::string refusal = collector_.add(*reading.view);
  if (!refusal.empty()) {
    message_ = refusal;
    return true;
  }
  message_ = "view " + std::to_string(samples().views.size()) + " is kept (" + reading.message +
             "): hold the board still somewhere else";
  // Keep this message: the next view takes a whole cycle.
  decoder_.clear();
  next_reading_ = time + sequence::kCycle;
  return true;
}

void BoardRun::undo() {
  collector_.undo();
  message_ = std::to_string(samples().views.size()) + " views are left";
}

}  // namespace wiimote_tracker::intrinsics
