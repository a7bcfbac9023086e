#include "wiimote_tracker_driver/virtual_wiimote/faults.h"

#include <wiimote_tracker_msgs/text.h>
#include <boost/lexical_cast/try_lexical_convert.hpp>

#include <cmath>
#include <stdexcept>
#include <type_traits>
#include <variant>

namespace wiimote_tracker::virtual_wiimote {
namespace {

constexpr double kMaximum = 1e9;

/// A member, and the numbers that it may have; only a double may have fractions.
struct Fault {
  const char* name;
  std::variant<double Faults::*, int Faults::*, std::uint32_t Faults::*, bool Faults::*> member;
  double minimum = 0.0, maximum = 1.0;
};

const Fault kFaults[] = {
    {"lost_answers", &Faults::lost_answers},
    {"lost_data", &Faults::lost_data},
    {"late_answers", &Faults::late_answers},
    {"duplicated", &Faults::duplicated},
    {"truncated", &Faults::truncated},
    {"garbage", &Faults::garbage},
    {"stalls", &Faults::stalls},
    {"late_by", &Faults::late_by, 1.0, kMaximum},
    {"stall_length", &Faults::stall_length, 1.0, kMaximum},
    {"unplug_every", &Faults::unplug_every, 0.0, kMaximum},
    {"unplug_for", &Faults::unplug_for, 1.0, kMaximum},
    {"second_master", &Faults::second_master},
    {"seed", &Faults::seed, 0.0, kMaximum},
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
    const bool whole = !std::holds_alternative<double Faults::*>(fault.member);
    if (!is_number || !(value >= fault.minimum && value <= fault.maximum) ||
        (whole && value != std::floor(value)))
      throw std::invalid_argument(format("the fault %s must be a %snumber from %g to %g, not '%s'",
                                         fault.name, whole ? "whole " : "", fault.minimum,
                                         fault.maximum, given.c_str()));
    std::visit(
        [&](auto member) {
          faults.*member = static_cast<std::decay_t<decltype(faults.*member)>>(value);
        },
        fault.member);
    return;
  }
  throw std::invalid_argument("there is no fault '" + name + "'; choose from " + names);
}

}  // namespace wiimote_tracker::virtual_wiimote
