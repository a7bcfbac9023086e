#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace wiimote_tracker {

/// Of an even number of values the mean of the middle two. @param values not empty; reordered
inline double medianOf(std::vector<double>* values) {
  const auto middle = values->begin() + static_cast<std::ptrdiff_t>(values->size() / 2);
  std::nth_element(values->begin(), middle, values->end());
  if (values->size() % 2 == 1)
    return *middle;
  return 0.5 * (*std::max_element(values->begin(), middle) + *middle);
}

}  // namespace wiimote_tracker
