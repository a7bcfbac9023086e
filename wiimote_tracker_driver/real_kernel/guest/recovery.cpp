#include "recovery.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace wiimote_tracker::real_kernel {

double recoveryTime(const std::vector<double>& images, double since, double rate) {
  const auto wanted = static_cast<std::ptrdiff_t>(std::lround(rate * kRecoveryWindow));
  for (auto first = std::lower_bound(images.begin(), images.end(), since);
       images.end() - first >= wanted; ++first) {
    if (*(first + wanted - 1) < *first + kRecoveryWindow)
      return *first - since;
  }
  return -1.0;
}

double longestPause(const std::vector<double>& images, double begin, double end) {
  double last = begin;
  double longest = 0.0;
  for (auto image = std::lower_bound(images.begin(), images.end(), begin);
       image != images.end() && *image <= end; ++image) {
    longest = std::max(longest, *image - last);
    last = *image;
  }
  return longest;
}

std::size_t imagesBetween(const std::vector<double>& images, double begin, double end) {
  return static_cast<std::size_t>(std::upper_bound(images.begin(), images.end(), end) -
                                  std::lower_bound(images.begin(), images.end(), begin));
}

}  // namespace wiimote_tracker::real_kernel
