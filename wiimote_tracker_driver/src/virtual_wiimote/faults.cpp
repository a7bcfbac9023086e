#include "wiimote_tracker_driver/virtual_wiimote/faults.h"

#include <wiimote_tracker_msgs/text.h>
#include <boost/lexical_cast/try_lexical_convert.hpp>

#include <cmath>
#include <stdexcept>

namespace wiimote_tracker::virtual_wiimote {
namespace {

constexpr double kMaximum = 1e9;

struct Fault {
  const char* name;
  bool whole;  ///< Accepts only whole numbers.
  double minimum;
  double maximum;
  void (*set)(Faults&, double);
};

const Fault kFaults[] = {
    {"lost_answers", false, 0, 1, [](Faults& f, double v) { f.lost_answers = v; }},
    {"lost_data", false, 0, 1, [](Faults& f, double v) { f.lost_data = v; }},
    {"late_answers", false, 0, 1, [](Faults& f, double v) { f.late_answers = v; }},
    {"duplicated", false, 0, 1, [](Faults& f, double v) { f.duplicated = v; }},
    {"truncated", false, 0, 1, [](Faults& f, double v) { f.truncated = v; }},
    {"garbage", false, 0, 1, [](Faults& f, double v) { f.garbage = v; }},
    {"stalls", false, 0, 1, [](Faults& f, double v) { f.stalls = v; }},
    {"late_by", true, 1, kMaximum, [](Faults& f, double v) { f.late_by = static_cast<int>(v); }},
    {"stall_length", true, 1, kMaximum,
     [](Faults& f, double v) { f.stall_length = static_cast<int>(v); }},
    {"unplug_every", true, 0, kMaximum,
     [](Faults& f, double v) { f.unplug_every = static_cast<int>(v); }},
    {"unplug_for", true, 1, kMaximum,
     [](Faults& f, double v) { f.unplug_for = static_cast<int>(v); }},
    {"second_master", true, 0, 1, [](Faults& f, double v) { f.second_master = v == 1; }},
    {"seed", true, 0, kMaximum,
     [](Faults& f, double v) { f.seed = static_cast<std::uint32_t>(v); }},
};

}  // namespace

void setFault(Faults& faults, const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos)
    throw std::invalid_argument("write a fault as NAME=VALUE, not as '" + text + "'");
  const std::string name = text.substr(0, equals);
  const std::string given = text.substr(equals + 1);
  double value = 0.0;
  const bool is_number = boost::conversion::try_lexical_convert(given, value);
  std::string names;
  for (const Fault& fault : kFaults) {
    names += (names.empty() ? "" : ", ") + std::string(fault.name);
    if (name != fault.name)
      continue;
    if (!is_number || !(value >= fault.minimum && value <= fault.maximum) ||
        (fault.whole && value != std::floor(value)))
      throw std::invalid_argument(format("the fault %s must be a %snumber from %g to %g, not '%s'",
                                         fault.name, fault.whole ? "whole " : "", fault.minimum,
                                         fault.maximum, given.c_str()));
    fault.set(faults, value);
    return;
  }
  throw std::invalid_argument("there is no fault '" + name + "'; choose from " + names);
}

}  // namespace wiimote_tracker::virtual_wiimote
