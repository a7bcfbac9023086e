#include "wiimote_tracker_triangulation/identity/codes_file.h"

#include "wiimote_tracker_triangulation/geometry/yaml_map.h"
#include "wiimote_tracker_triangulation/identity/schemes.h"

namespace wiimote_tracker::identity {
namespace {

constexpr const char* kFormat = "wiimote_tracker_blink_codes";
constexpr int kFormatVersion = 1;
constexpr const char* kAdvice = "compare it with config/blink_codes.yaml";

BlinkCodes readDuty(geometry::YamlMap& map) {
  const std::vector<double> period = map.numbers("period");
  if (period.size() != 2)
    throw map.error("period", "is not [shortest, longest]");
  std::vector<DutyLed> leds;
  for (geometry::YamlMap& led : map.maps("leds"))
    leds.push_back({led.get<std::string>("label"), led.get<double>("share")});
  map.refuseUnknown();
  return dutyCodes(leds, period[0], period[1]);
}

BlinkCodes readCyclic(geometry::YamlMap& map) {
  const double chip = map.get<double>("chip");
  const double tolerance = map.get<double>("tolerance");
  std::vector<CyclicLed> leds;
  for (geometry::YamlMap& led : map.maps("leds"))
    leds.push_back({led.get<std::string>("label"), led.get<std::string>("word")});
  map.refuseUnknown();
  return cyclicCodes(leds, chip, tolerance);
}

}  // namespace

BlinkCodes readBlinkCodes(const std::string& file) {
  geometry::YamlMap map = geometry::YamlMap::load(file, kAdvice);
  map.checkFormat(kFormat, kFormatVersion);
  const std::string scheme = map.get<std::string>("scheme");
  if (scheme != "duty" && scheme != "cyclic")
    throw map.error("scheme", "is neither duty nor cyclic");
  try {
    return scheme == "duty" ? readDuty(map) : readCyclic(map);
  } catch (const FileError&) {
    throw;
  } catch (const Error& e) {
    throw FileError(file + ": " + e.what());
  }
}

}  // namespace wiimote_tracker::identity
