#ifndef WIIMOTE_TRACKER_MSGS_MEDIAN_H
#define WIIMOTE_TRACKER_MSGS_MEDIAN_H

#include <algorithm>
#include <cstddef>
#include <vector>

namespace wiimote_tracker {

/// The median, of an even count the upper one. @param values not empty; they are reordered
inline double medianOf(std::vector<double>* values) {
  const auto middle = values->begin() + static_cast<std::ptrdiff_t>(values->size() / 2);
  std::nth_element(values->begin(), middle, values->end());
  return *middle;
}

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_MSGS_MEDIAN_H
