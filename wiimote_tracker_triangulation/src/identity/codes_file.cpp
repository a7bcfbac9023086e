#include "wiimote_tracker_triangulation/identity/codes_file.h"

#include "wiimote_tracker_triangulation/geometry/atomic_file.h"
#include "wiimote_tracker_triangulation/geometry/yaml_map.h"
#include "wiimote_tracker_triangulation/identity/error.h"
#include "wiimote_tracker_triangulation/identity/schemes.h"

#include <yaml-cpp/yaml.h>

namespace wiimote_tracker::identity {
namespace {

constexpr const char* kFormat = "wiimote_tracker_blink_codes";
constexpr int kFormatVersion = 1;
constexpr const char* kAdvice = "compare it with config/blink_codes.yaml";

BlinkCodes readDuty(geometry::YamlMap& map) {
  const std::vector<double> period = map.numbers("period");
  if (period.size() != 2)
    throw IdentityError(map.at("period") + " is not [shortest, longest]; correct it");
  std::vector<DutyLed> leds;
  for (geometry::YamlMap& led : map.maps("leds")) {
    leds.push_back({led.get<std::string>("label"), led.get<double>("share")});
    led.refuseUnknown();
  }
  map.refuseUnknown();
  return dutyCodes(leds, period[0], period[1]);
}

BlinkCodes readCyclic(geometry::YamlMap& map) {
  const double chip = map.get<double>("chip");
  const double tolerance = map.get<double>("tolerance");
  std::vector<CyclicLed> leds;
  for (geometry::YamlMap& led : map.maps("leds")) {
    leds.push_back({led.get<std::string>("label"), led.get<std::string>("word")});
    led.refuseUnknown();
  }
  map.refuseUnknown();
  return cyclicCodes(leds, chip, tolerance);
}

}  // namespace

BlinkCodes readBlinkCodes(const std::string& file) {
  YAML::Node node;
  try {
    node = YAML::Load(geometry::readFile(file));
  } catch (const YAML::Exception& e) {
    throw IdentityError(file + " is not YAML (" + e.what() + "); " + kAdvice);
  }
  geometry::YamlMap map(node, file, kAdvice);
  if (map.get<std::string>("format") != kFormat)
    throw IdentityError(map.at("format") + " is not " + kFormat + "; give a file of blink codes");
  const int version = map.get<int>("version");
  if (version != kFormatVersion)
    throw IdentityError(map.at("version") + " is " + std::to_string(version) +
                        ", which this program does not know; update it");
  const std::string scheme = map.get<std::string>("scheme");
  if (scheme != "duty" && scheme != "cyclic")
    throw IdentityError(map.at("scheme") + " is neither duty nor cyclic; " + kAdvice);
  try {
    return scheme == "duty" ? readDuty(map) : readCyclic(map);
  } catch (const IdentityError& e) {
    const std::string what = e.what();
    throw IdentityError(what.rfind(file, 0) == 0 ? what : file + ": " + what);
  }
}

}  // namespace wiimote_tracker::identity
