#include "ir_camera.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::virtual_wiimote {
namespace {

constexpr std::size_t kMaximumSize = 0x06;
constexpr std::size_t kGain = 0x08;
constexpr std::size_t kGainLimit = 0x1a;
constexpr std::size_t kControl = 0x30;
constexpr std::size_t kMode = 0x33;
constexpr std::size_t kData = 0x37;
constexpr std::size_t kDataSize = 36;

constexpr std::uint8_t kRunning = 8;
constexpr std::uint8_t kBasic = 1;
constexpr std::uint8_t kExtended = 3;
constexpr std::uint8_t kFull = 5;

// A light that moves farther than this between two images is taken for another one [px].
constexpr int kMaximumStep = 100;

std::uint8_t byte(int value) {
  return static_cast<std::uint8_t>(value);
}

}  // namespace

bool IrCamera::seeing() const {
  const std::uint8_t mode = registers_[kMode];
  const bool has_mode = mode == kBasic || mode == kExtended || mode == kFull;
  // Without its sensitivity blocks the camera lets no spot pass.
  const bool sensitive = registers_[kMaximumSize] > 0 && registers_[kGainLimit] > 0 &&
                         registers_[kGainLimit] < registers_[kGain];
  return clock_ && logic_ && registers_[kControl] == kRunning && has_mode && sensitive;
}

void IrCamera::look(const std::vector<Light>& lights) {
  if (!seeing()) {
    for (Spot& slot : slots_)
      slot.lit = false;
    return;
  }
  std::vector<Light> brightest(lights);
  std::stable_sort(brightest.begin(), brightest.end(),
                   [](const Light& a, const Light& b) { return a.brightness > b.brightness; });
  std::vector<Spot> seen;
  for (const Light& light : brightest) {
    if (!(light.x > -0.5 && light.x < 1023.5 && light.y > -0.5 && light.y < 767.5))
      continue;
    Spot spot;
    spot.lit = spot.ever_lit = true;
    spot.x = static_cast<int>(std::lround(light.x));
    spot.y = static_cast<int>(std::lround(light.y));
    spot.size = static_cast<int>(std::lround(std::clamp(light.size, 0.0, 15.0)));
    spot.intensity = std::min(255, 16 * spot.size + 15);
    seen.push_back(spot);
    if (seen.size() == slots_.size())
      break;
  }
  follow(seen);

  std::fill_n(registers_.begin() + kData, kDataSize, 0xff);
  if (registers_[kMode] == kBasic)
    fillBasic();
  else if (registers_[kMode] == kExtended)
    fillExtended();
  else
    fillFull();
}

// Hands the spots to the slots: nearest pairs first, then what is new to the first free slot.
void IrCamera::follow(std::vector<Spot>& seen) {
  const std::array<Spot, 4> before = slots_;
  std::array<bool, 4> taken{};
  std::vector<bool> placed(seen.size(), false);
  for (;;) {
    int best = kMaximumStep * kMaximumStep + 1;
    std::size_t best_slot = 0;
    std::size_t best_spot = 0;
    for (std::size_t slot = 0; slot < before.size(); ++slot) {
      for (std::size_t spot = 0; spot < seen.size(); ++spot) {
        if (!before[slot].lit || taken[slot] || placed[spot])
          continue;
        const int dx = before[slot].x - seen[spot].x;
        const int dy = before[slot].y - seen[spot].y;
        const int distance = dx * dx + dy * dy;
        if (distance < best) {
          best = distance;
          best_slot = slot;
          best_spot = spot;
        }
      }
    }
    if (best > kMaximumStep * kMaximumStep)
      break;
    slots_[best_slot] = seen[best_spot];
    taken[best_slot] = placed[best_spot] = true;
  }
  for (std::size_t spot = 0; spot < seen.size(); ++spot) {
    for (std::size_t slot = 0; slot < slots_.size() && !placed[spot]; ++slot) {
      if (taken[slot])
        continue;
      slots_[slot] = seen[spot];
      taken[slot] = placed[spot] = true;
    }
  }
  for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
    if (!taken[slot])
      slots_[slot].lit = false;
  }
}

// In all formats a slot that has lost its light reads ff; newer remotes have zeros in a slot that
// never had one.

void IrCamera::fillBasic() {
  for (std::size_t pair = 0; pair < 2; ++pair) {
    int x[2];
    int y[2];
    for (std::size_t i = 0; i < 2; ++i) {
      const Spot& spot = slots_[2 * pair + i];
      x[i] = spot.lit ? spot.x : spot.ever_lit ? 0x3ff : 0;
      y[i] = spot.lit ? spot.y : spot.ever_lit ? 0x3ff : 0;
    }
    std::uint8_t* out = &registers_[kData + 5 * pair];
    out[0] = byte(x[0] % 256);
    out[1] = byte(y[0] % 256);
    out[2] = byte(y[0] / 256 * 64 + x[0] / 256 * 16 + y[1] / 256 * 4 + x[1] / 256);
    out[3] = byte(x[1] % 256);
    out[4] = byte(y[1] % 256);
  }
}

void IrCamera::fillExtended() {
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    const Spot& spot = slots_[i];
    std::uint8_t* out = &registers_[kData + 3 * i];
    if (spot.lit) {
      out[0] = byte(spot.x % 256);
      out[1] = byte(spot.y % 256);
      out[2] = byte(spot.y / 256 * 64 + spot.x / 256 * 16 + spot.size);
    } else {
      std::fill_n(out, 3, spot.ever_lit ? 0xff : 0x00);
    }
  }
}

void IrCamera::fillFull() {
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    const Spot& spot = slots_[i];
    std::uint8_t* out = &registers_[kData + 9 * i];
    if (!spot.lit) {
      std::fill_n(out, 9, spot.ever_lit ? 0xff : 0x00);
      continue;
    }
    out[0] = byte(spot.x % 256);
    out[1] = byte(spot.y % 256);
    out[2] = byte(spot.y / 256 * 64 + spot.x / 256 * 16 + spot.size);
    // The box is in the sensor's own pixels, eight times as coarse.
    out[3] = byte(std::max(0, spot.x / 8 - spot.size / 2));
    out[4] = byte(std::max(0, spot.y / 8 - spot.size / 2));
    out[5] = byte(std::min(127, spot.x / 8 + spot.size / 2));
    out[6] = byte(std::min(95, spot.y / 8 + spot.size / 2));
    out[7] = 0;
    out[8] = byte(spot.intensity);
  }
}

void IrCamera::appendData(std::size_t size, Bytes& report) const {
  const auto data = registers_.begin() + kData;
  if (seeing())
    report.insert(report.end(), data, data + static_cast<std::ptrdiff_t>(size));
  else
    report.insert(report.end(), size, 0xff);
}

}  // namespace wiimote_tracker::virtual_wiimote
