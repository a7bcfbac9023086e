#include "capture/walk.h"

#include <wiimote_tracker_msgs/text.h>

#include <cmath>
#include <cstddef>

namespace wiimote_tracker::capture {
namespace {

// Stamps this far apart are of one time, though no clock is known yet [s].
constexpr double kSameTime = 0.1;
// So many images at the same time are no accident.
constexpr int kEnough = 25;
constexpr std::size_t kMostPairs = 8;  // in the sentence

}  // namespace

void Walk::add(const Image& image, int width, int height) {
  if (image.spots.size() != 1)
    return;
  View& own = views_[image.camera];
  own.cells.add(image.spots.front(), width, height);
  own.last = image.stamp;
  for (auto& [name, other] : views_) {
    if (name == image.camera || !(std::abs(image.stamp - other.last) < kSameTime))
      continue;
    if (own.together[name] < kEnough)
      ++own.together[name];
    other.together[image.camera] = own.together[name];
  }
}

double Walk::share(const std::string& camera) const {
  const auto view = views_.find(camera);
  return view == views_.end() ? 0.0 : view->second.cells.share();
}

std::vector<std::string> Walk::seenWith(const std::string& camera) const {
  std::vector<std::string> names;
  const auto view = views_.find(camera);
  if (view == views_.end())
    return names;
  for (const auto& [name, images] : view->second.together) {
    if (images >= kEnough)
      names.push_back(name);
  }
  return names;
}

std::string Walk::sentence() const {
  std::vector<std::string> shares, pairs, alone;
  for (const auto& [name, view] : views_) {
    shares.push_back(name + format(" %.0f %%", 100.0 * share(name)));
    const std::vector<std::string> others = seenWith(name);
    if (others.empty())
      alone.push_back(name);
    for (const std::string& other : others) {
      if (name < other)
        pairs.push_back(name + " + " + other);
    }
  }
  if (shares.empty())
    return "";
  if (alone.empty() && 2 * pairs.size() == views_.size() * (views_.size() - 1)) {
    pairs = {"every two of them"};
  } else if (pairs.size() > kMostPairs) {
    const std::size_t more = pairs.size() - kMostPairs;
    pairs.resize(kMostPairs);
    pairs.push_back(counted(more, "other pair"));
  }
  return "share of the image in which the LED was seen: " + joined(shares) +
         (pairs.empty() ? "" : "; seen together: " + joined(pairs)) +
         (alone.empty() ? ""
                        : "; cameras that saw it alone: " + joined(alone) +
                              "; turn them towards what the others see");
}

}  // namespace wiimote_tracker::capture
