#include "capture/image_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace wiimote_tracker::capture {
namespace {

/// Adds images in the given order. @returns the stamps handed on, camera by camera unless equal.
std::vector<std::pair<double, std::string>> ordered(const std::vector<Image>& images) {
  ImageOrder order;
  std::vector<std::pair<double, std::string>> result;
  for (const Image& image : images)
    order.add(image, [&](const Image& next) { result.emplace_back(next.stamp, next.camera); });
  return result;
}

Image at(const std::string& camera, double stamp) {
  Image image;
  image.camera = camera;
  image.stamp = stamp;
  return image;
}

TEST(ImageOrder, AnyOrderOfArrivalGivesTheOrderOfStamps) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> delay(0.0, 0.15);
  std::vector<std::pair<double, std::string>> first;
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<std::pair<double, Image>> arrivals;  // a camera's own images keep their order
    for (const char* camera : {"a", "b", "c"}) {
      double arrival = 0.0;
      for (int i = 0; i < 300; ++i) {
        const double stamp = 100.0 + 0.01 * i + (camera[0] == 'b' ? 0.003 : 0.0);
        arrival = std::max(arrival, stamp + delay(random));
        arrivals.emplace_back(arrival, at(camera, stamp));
      }
    }
    std::stable_sort(arrivals.begin(), arrivals.end(),
                     [](const auto& x, const auto& y) { return x.first < y.first; });
    std::vector<Image> images = {at("a", 99.9), at("b", 99.9), at("c", 99.9)};
    for (const auto& arrival : arrivals)
      images.push_back(arrival.second);
    const auto result = ordered(images);
    EXPECT_TRUE(std::is_sorted(result.begin(), result.end()));
    // All but the last, which a camera could still precede.
    EXPECT_GE(result.size(), 900U);
    if (trial == 0)
      first = result;
    const std::size_t common = std::min(first.size(), result.size());
    EXPECT_TRUE(std::equal(first.begin(), first.begin() + static_cast<std::ptrdiff_t>(common),
                           result.begin()));
  }
}

TEST(ImageOrder, ASilentCameraDelaysNoOther) {
  std::vector<Image> images = {at("silent", 1.0)};
  for (int i = 0; i < 100; ++i)
    images.push_back(at("a", 1.0 + 0.01 * i));
  const auto result = ordered(images);
  // All but the newest: from a newly appeared camera an equal stamp could come.
  EXPECT_EQ(result.size(), 100U);
}

TEST(ImageOrder, AtTheEndNothingWaits) {
  ImageOrder order;
  std::vector<double> stamps;
  const auto take = [&](const Image& image) { stamps.push_back(image.stamp); };
  for (const double stamp : {1.2, 1.1, 1.3})
    order.add(at(stamp == 1.1 ? "b" : "a", stamp), take);
  order.flush(take);
  EXPECT_EQ(stamps, (std::vector<double>{1.1, 1.2, 1.3}));
  order.flush(take);
  EXPECT_EQ(stamps.size(), 3U);
}

TEST(ImageOrder, ALateImageIsNotLostAndOneFromAClockSetBackBeginsAnew) {
  EXPECT_EQ(ordered({at("a", 1.0), at("b", 1.0), at("a", 2.0), at("b", 0.5)}).size(), 3U);
  const auto result = ordered({at("a", 100.0), at("b", 100.0), at("a", 10.0), at("b", 10.0),
                               at("a", 10.01), at("b", 10.01)});
  ASSERT_EQ(result.size(), 4U);
  EXPECT_EQ(result[1].first, 100.0);
  EXPECT_EQ(result[3].first, 10.0);
}

}  // namespace
}  // namespace wiimote_tracker::capture
