#include "wiimote_tracker_driver/protocol/ir_camera.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace wiimote_tracker::protocol {
namespace {

// From wiibrew.org/wiki/Wiimote.
const std::vector<std::pair<std::string, IrSensitivity>>& allSensitivities() {
  static const std::vector<std::pair<std::string, IrSensitivity>> sensitivities{
      {"wii_1", {{{0x02, 0x00, 0x00, 0x71, 0x01, 0x00, 0x64, 0x00, 0xfe}}, {{0xfd, 0x05}}}},
      {"wii_2", {{{0x02, 0x00, 0x00, 0x71, 0x01, 0x00, 0x96, 0x00, 0xb4}}, {{0xb3, 0x04}}}},
      {"wii_3", {{{0x02, 0x00, 0x00, 0x71, 0x01, 0x00, 0xaa, 0x00, 0x64}}, {{0x63, 0x03}}}},
      {"wii_4", {{{0x02, 0x00, 0x00, 0x71, 0x01, 0x00, 0xc8, 0x00, 0x36}}, {{0x35, 0x03}}}},
      {"wii_5", {{{0x07, 0x00, 0x00, 0x71, 0x01, 0x00, 0x72, 0x00, 0x20}}, {{0x1f, 0x03}}}},
      {"marcan", {{{0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x90, 0x00, 0xc0}}, {{0x40, 0x00}}}},
      {"max", {{{0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x90, 0x00, 0x41}}, {{0x40, 0x00}}}}};
  return sensitivities;
}

}  // namespace

std::optional<IrSensitivity> irSensitivity(const std::string& name) {
  for (const auto& entry : allSensitivities()) {
    if (entry.first == name)
      return entry.second;
  }
  return std::nullopt;
}

std::vector<std::string> irSensitivityNames() {
  std::vector<std::string> names;
  for (const auto& entry : allSensitivities())
    names.push_back(entry.first);
  return names;
}

IrSensitivity parseIrSensitivity(const std::string& text) {
  if (const auto named = irSensitivity(text))
    return *named;
  const std::string quoted = "the infrared sensitivity '" + text + "'";
  std::vector<std::uint8_t> bytes;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (word == "/" && bytes.size() == 9)
      continue;
    const bool hexadecimal =
        word.size() <= 2 && word.find_first_not_of("0123456789abcdefABCDEF") == std::string::npos;
    if (!hexadecimal || bytes.size() == 11) {
      bytes.clear();
      break;
    }
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(word, nullptr, 16)));
  }
  if (bytes.size() != 11)
    throw std::invalid_argument(quoted + " must be one of " + joined(irSensitivityNames()) +
                                ", or eleven bytes such as '07 00 00 71 01 00 72 00 20 / 1f 03'");
  IrSensitivity sensitivity;
  std::copy_n(bytes.begin(), 9, sensitivity.block1.begin());
  std::copy_n(bytes.begin() + 9, 2, sensitivity.block2.begin());
  if (sensitivity.block2[0] >= sensitivity.block1[8])
    throw std::invalid_argument(quoted +
                                " would blind the camera: its tenth byte, the gain limit, must be "
                                "less than its ninth, the gain");
  return sensitivity;
}

}  // namespace wiimote_tracker::protocol
