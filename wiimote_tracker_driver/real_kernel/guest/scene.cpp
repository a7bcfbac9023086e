#include "scene.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::real_kernel {
namespace {

constexpr int kSide = 64;  // [px]
constexpr int kPeriod = 4 * kSide;

/// Distance along one axis after `step` pixels around the square.
int along(int step) {
  return std::clamp(std::abs((step + kPeriod) % kPeriod - 2 * kSide) - kSide / 2, 0, kSide);
}

bool shows(const protocol::DataReport& image, const virtual_wiimote::Light& light, int tolerance) {
  return std::any_of(image.spots.begin(), image.spots.end(), [&](const protocol::IrSpot& spot) {
    return spot.seen && std::abs(spot.x - std::lround(light.x)) <= tolerance &&
           std::abs(spot.y - std::lround(light.y)) <= tolerance &&
           (image.ir_format == protocol::IrFormat::kBasic || spot.size == std::lround(*light.size));
  });
}

}  // namespace

std::vector<virtual_wiimote::Light> Scene::lightsAt(long frame) const {
  const int step = static_cast<int>(frame % kPeriod);
  std::vector<virtual_wiimote::Light> lights;
  lights.reserve(4);
  for (int i = 0; i < 4; ++i)
    lights.push_back({60.0 + 240.0 * i + along(step), 95.0 * number_ - 65.0 + along(step - kSide),
                      2.0 + i, 1.0});
  return lights;
}

std::vector<virtual_wiimote::Light> Scene::next() {
  return lightsAt(++frame_);
}

std::optional<long> Scene::frameOf(const protocol::DataReport& image, int tolerance) const {
  const long last = frame_;
  for (long frame = last; frame > 0 && frame > last - kPeriod; --frame) {
    const std::vector<virtual_wiimote::Light> lights = lightsAt(frame);
    if (std::all_of(lights.begin(), lights.end(),
                    [&](const auto& light) { return shows(image, light, tolerance); }))
      return frame;
  }
  return std::nullopt;
}

}  // namespace wiimote_tracker::real_kernel
