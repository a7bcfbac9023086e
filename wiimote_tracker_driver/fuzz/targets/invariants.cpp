#include "invariants.h"

namespace wiimote_tracker::fuzz {
namespace {

using protocol::IrFormat;

bool within(int value, int low, int high) {
  return value >= low && value <= high;
}

void requireInRange(const protocol::IrSpot& spot, IrFormat format) {
  require(within(spot.x, 0, protocol::kSensorWidth - 1), "x is on the sensor");
  require(within(spot.y, 0, protocol::kSensorHeight - 1), "y is on the sensor");
  require(within(spot.size, 0, 15), "the size has four bits");
  require(within(spot.intensity, 0, 255), "the intensity is a byte");
  for (const int edge : spot.box)
    require(within(edge, 0, 127), "the box is in cells");
  const bool boxed = spot.intensity != 0 || spot.box != std::array<int, 4>{};
  if (!spot.seen)
    require(spot.x == 0 && spot.y == 0 && spot.size == 0 && !boxed, "an unseen spot is blank");
  if (format == IrFormat::kNone)
    require(!spot.seen, "a report without infrared data shows no spot");
  if (format == IrFormat::kBasic)
    require(spot.size == 0, "the basic format has no size");
  if (format != IrFormat::kFull)
    require(!boxed, "only the full format has boxes");
}

}  // namespace

void requireInRange(const protocol::DataReport& data) {
  require((data.buttons & ~0x1f9f) == 0, "only buttons are in the buttons");
  for (const protocol::IrSpot& spot : data.spots)
    requireInRange(spot, data.ir_format);
  if (!data.acceleration)
    return;
  for (const int value : *data.acceleration)
    require(within(value, 0, 1023), "the converter has ten bits");
}

void requireImage(const protocol::DataReport& image, IrFormat format) {
  const int id = format == IrFormat::kBasic ? 0x37 : format == IrFormat::kExtended ? 0x33 : 0x3e;
  require(image.id == id && image.ir_format == format, "images are of the configured format");
  require(image.acceleration.has_value(), "an image comes with the acceleration");
  requireInRange(image);
}

void requireWellFormed(const protocol::Report& output) {
  const auto& bytes = output.bytes;
  switch (output.id()) {
    case 0x10:
    case 0x11:
    case 0x13:
    case 0x15:
    case 0x1a:
      require(output.size == 2, "a switch has two bytes");
      break;
    case 0x12:
      require(output.size == 3, "a report mode has three bytes");
      break;
    case 0x16:
      require(output.size == 22 && within(bytes[5], 1, 16), "a write has 1 to 16 bytes");
      break;
    case 0x17:
      require(output.size == 7 && (bytes[5] != 0 || bytes[6] != 0), "a read has a size");
      break;
    default:
      throw Broken("the driver sends reports that it knows");
  }
}

}  // namespace wiimote_tracker::fuzz
