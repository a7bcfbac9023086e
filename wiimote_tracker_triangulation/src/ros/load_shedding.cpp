#include "load_shedding.h"

namespace wiimote_tracker {
namespace {

// An image that waited longer is late [s].
constexpr double kLongestWait = 0.05;
// Images that are late for no longer than this are worked off [s]: the backlog of a pause of a
// second takes less, since one image takes a fraction of the time between two.
constexpr double kLongestBacklog = 0.5;
// After the last dropped image, late ones are dropped at once for this long [s].
constexpr double kOverloaded = 5.0;

}  // namespace

bool LoadShedding::drops(double wait, double now) {
  if (wait <= kLongestWait) {
    late_since_.reset();
    return false;
  }
  if (!late_since_)
    late_since_ = now;
  if (!overloaded(now) && now - *late_since_ < kLongestBacklog)
    return false;
  overloaded_until_ = now + kOverloaded;
  ++dropped_;
  return true;
}

}  // namespace wiimote_tracker
