#pragma once

#include <cstddef>
#include <vector>

/// Time until a stream has recovered, from the arrival times of its images [s], in order.
namespace wiimote_tracker::real_kernel {

constexpr double kRecoveryWindow = 1.0;  ///< [s]
constexpr double kRecoveryRate = 90.0;   ///< [Hz] In the window, of a remote that sends 100.

/// How long after `since` the first image of the first window with images at `rate` [Hz] came [s];
/// negative when there is no such window yet.
double recoveryTime(const std::vector<double>& images, double since, double rate = kRecoveryRate);

/// The longest time without an image from `begin` to the last one before `end` [s].
double longestPause(const std::vector<double>& images, double begin, double end);

/// Number of images from `begin` to `end` [s].
std::size_t imagesBetween(const std::vector<double>& images, double begin, double end);

}  // namespace wiimote_tracker::real_kernel
