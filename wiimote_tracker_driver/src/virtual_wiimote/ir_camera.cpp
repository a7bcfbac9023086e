#include "ir_camera.h"

#include "data_report.h"

#include <algorithm>

namespace wiimote_tracker::virtual_wiimote {
namespace {

constexpr std::size_t kMaximumSize = 0x06;
constexpr std::size_t kGain = 0x08;
constexpr std::size_t kGainLimit = 0x1a;
constexpr std::size_t kMinimumSize = 0x1b;
constexpr std::size_t kControl = 0x30;
constexpr std::size_t kModeRegister = 0x33;
constexpr std::size_t kData = 0x37;

constexpr std::uint8_t kRunning = 8;
constexpr std::uint8_t kBasic = 1;
constexpr std::uint8_t kExtended = 3;
constexpr std::uint8_t kFull = 5;

// A light that moves farther between two images counts as a new one [px].
constexpr int kMaximumStep = 100;

}  // namespace

std::array<std::uint8_t, 10> basicFormat(const FactoryPoints& points) {
  std::array<std::uint8_t, 10> bytes{};
  for (std::size_t pair = 0; pair < 2; ++pair) {
    const auto& [x0, y0] = points[2 * pair];
    const auto& [x1, y1] = points[2 * pair + 1];
    std::uint8_t* out = &bytes[5 * pair];
    out[0] = byte(x0 % 256);
    out[1] = byte(y0 % 256);
    out[2] = byte(y0 / 256 * 64 + x0 / 256 * 16 + y1 / 256 * 4 + x1 / 256);
    out[3] = byte(x1 % 256);
    out[4] = byte(y1 % 256);
  }
  return bytes;
}

IrCamera::IrCamera(const std::optional<std::uint32_t>& slot_seed)
    : draws_slots_(slot_seed.has_value()), random_(slot_seed.value_or(0)) {}

bool IrCamera::works() const {
  const std::uint8_t mode = registers_[kModeRegister];
  const bool has_mode = mode == kBasic || mode == kExtended || mode == kFull;
  // Without its sensitivity blocks the camera detects nothing.
  const bool sensitive = registers_[kMaximumSize] > 0 && registers_[kGainLimit] > 0 &&
                         registers_[kGainLimit] < registers_[kGain];
  return clock_ && logic_ && registers_[kControl] == kRunning && has_mode && sensitive;
}

void IrCamera::takeImage(const std::vector<Light>& lights) {
  if (!works()) {
    for (Slot& slot : slots_)
      slot.lit = false;
    return;
  }
  assignSlots(
      findBlobs(lights, brightnessThreshold(registers_[kGainLimit], registers_[kMinimumSize])));

  std::fill_n(registers_.begin() + kData, kDataSize, 0xff);
  if (registers_[kModeRegister] == kBasic)
    fillBasic();
  else if (registers_[kModeRegister] == kExtended)
    fillExtended();
  else
    fillFull();
}

// Nearest pairs first, then new blobs to free slots.
void IrCamera::assignSlots(const std::vector<Blob>& seen) {
  struct Pair {
    int squared_distance;
    std::size_t slot, blob;
  };
  std::vector<Pair> pairs;
  for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
    for (std::size_t blob = 0; blob < seen.size() && slots_[slot].lit; ++blob) {
      const int dx = slots_[slot].blob.x - seen[blob].x;
      const int dy = slots_[slot].blob.y - seen[blob].y;
      if (dx * dx + dy * dy <= kMaximumStep * kMaximumStep)
        pairs.push_back({dx * dx + dy * dy, slot, blob});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
    return a.squared_distance < b.squared_distance;
  });
  std::array<bool, 4> taken{};
  std::vector<bool> placed(seen.size(), false);
  for (const Pair& pair : pairs) {
    if (taken[pair.slot] || placed[pair.blob])
      continue;
    slots_[pair.slot].blob = seen[pair.blob];
    taken[pair.slot] = placed[pair.blob] = true;
  }
  for (std::size_t blob = 0; blob < seen.size(); ++blob) {
    if (placed[blob])
      continue;
    const std::size_t slot = chooseFree(taken);
    slots_[slot].blob = seen[blob];
    taken[slot] = true;
  }
  for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
    slots_[slot].lit = taken[slot];
    slots_[slot].ever_lit |= taken[slot];
  }
}

/// There are at most as many blobs as slots, so one is free.
std::size_t IrCamera::chooseFree(const std::array<bool, 4>& taken) {
  const auto free = std::count(taken.begin(), taken.end(), false);
  std::size_t skip = draws_slots_ ? random_() % static_cast<std::size_t>(free) : 0;
  std::size_t slot = 0;
  while (taken[slot] || skip-- > 0)
    ++slot;
  return slot;
}

// In all formats a slot that has lost its light reads ff; newer remotes send zeros for a slot that
// never had one.

void IrCamera::fillBasic() {
  FactoryPoints points{};
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (slots_[i].lit)
      points[i] = {slots_[i].blob.x, slots_[i].blob.y};
    else if (slots_[i].ever_lit)
      points[i] = {0x3ff, 0x3ff};
  }
  const std::array<std::uint8_t, 10> bytes = basicFormat(points);
  std::copy(bytes.begin(), bytes.end(), registers_.begin() + kData);
}

void IrCamera::fillExtended() {
  for (std::size_t i = 0; i < slots_.size(); ++i)
    fillSlot(slots_[i], 3, &registers_[kData + 3 * i]);
}

void IrCamera::fillFull() {
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    std::uint8_t* out = &registers_[kData + 9 * i];
    fillSlot(slots_[i], 9, out);
    if (!slots_[i].lit)
      continue;
    const Blob& blob = slots_[i].blob;
    std::transform(blob.box.begin(), blob.box.end(), out + 3, byte);
    out[7] = 0;
    out[8] = byte(blob.intensity);
  }
}

/// The first three bytes of both formats with a size, or `size` bytes for a slot without a light.
void IrCamera::fillSlot(const Slot& slot, std::size_t size, std::uint8_t* out) {
  if (!slot.lit) {
    std::fill_n(out, size, slot.ever_lit ? 0xff : 0x00);
    return;
  }
  const Blob& blob = slot.blob;
  out[0] = byte(blob.x % 256);
  out[1] = byte(blob.y % 256);
  out[2] = byte(blob.y / 256 * 64 + blob.x / 256 * 16 + blob.size);
}

IrCamera::Data IrCamera::data() const {
  Data data;
  if (works())
    std::copy_n(registers_.begin() + kData, kDataSize, data.begin());
  else
    data.fill(0xff);
  return data;
}

}  // namespace wiimote_tracker::virtual_wiimote
