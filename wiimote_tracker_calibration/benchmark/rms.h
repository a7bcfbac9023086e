#pragma once

#include <cmath>
#include <functional>

namespace wiimote_tracker {

/// Root of the mean square of what `value` gives of each item, without NaN; NaN: nothing is left.
template <typename Items, typename Value>
double rms(const Items& items, const Value& value) {
  double sum = 0.0;
  int count = 0;
  for (const auto& item : items) {
    const double x = std::invoke(value, item);
    if (std::isnan(x))
      continue;
    sum += x * x;
    ++count;
  }
  return std::sqrt(sum / count);
}

}  // namespace wiimote_tracker
