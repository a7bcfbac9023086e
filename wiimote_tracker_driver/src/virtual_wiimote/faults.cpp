#include "wiimote_tracker_driver/virtual_wiimote/faults.h"

#include <cmath>
#include <limits>
#include <locale>
#include <sstream>
#include <stdexcept>

namespace wiimote_tracker::virtual_wiimote {
namespace {

constexpr double kMost = 1e9;

struct Chance {
  const char* name;
  double Faults::*member;
};
constexpr Chance kChances[] = {
    {"lost_answers", &Faults::lost_answers},
    {"lost_data", &Faults::lost_data},
    {"late_answers", &Faults::late_answers},
    {"duplicated", &Faults::duplicated},
    {"truncated", &Faults::truncated},
    {"garbage", &Faults::garbage},
    {"stalls", &Faults::stalls},
};

struct Count {
  const char* name;
  int Faults::*member;
  int least;
};
constexpr Count kCounts[] = {
    {"late_by", &Faults::late_by, 1},
    {"stall_length", &Faults::stall_length, 1},
    {"unplug_every", &Faults::unplug_every, 0},
    {"unplug_for", &Faults::unplug_for, 1},
};

constexpr char kSeed[] = "seed";
constexpr char kSecondMaster[] = "second_master";

std::string allNames() {
  std::string names;
  for (const Chance& chance : kChances)
    names += std::string(chance.name) + ", ";
  for (const Count& count : kCounts)
    names += std::string(count.name) + ", ";
  return names + kSecondMaster + ", " + kSeed;
}

/// The number that `text` is as a whole; NaN when it is none.
double number(const std::string& text) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double value = 0.0;
  if (!(stream >> value) || stream.peek() != std::istringstream::traits_type::eof())
    return std::numeric_limits<double>::quiet_NaN();
  return value;
}

double inRange(const std::string& name, const std::string& text, double least, double most) {
  const double value = number(text);
  if (!(value >= least && value <= most)) {
    std::ostringstream message;
    message << "the fault " << name << " must be a number from " << least << " to " << most
            << ", not '" << text << "'";
    throw std::invalid_argument(message.str());
  }
  return value;
}

int wholeInRange(const std::string& name, const std::string& text, int least, double most) {
  const double value = inRange(name, text, least, most);
  if (value != std::floor(value))
    throw std::invalid_argument("the fault " + name + " must be a whole number, not '" + text +
                                "'");
  return static_cast<int>(value);
}

}  // namespace

void setFault(Faults& faults, const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos)
    throw std::invalid_argument("write a fault as NAME=VALUE, not as '" + text + "'");
  const std::string name = text.substr(0, equals);
  const std::string value = text.substr(equals + 1);
  for (const Chance& chance : kChances) {
    if (name == chance.name) {
      faults.*chance.member = inRange(name, value, 0.0, 1.0);
      return;
    }
  }
  for (const Count& count : kCounts) {
    if (name == count.name) {
      faults.*count.member = wholeInRange(name, value, count.least, kMost);
      return;
    }
  }
  if (name == kSecondMaster)
    faults.second_master = wholeInRange(name, value, 0, 1.0) == 1;
  else if (name == kSeed)
    faults.seed = static_cast<std::uint32_t>(wholeInRange(name, value, 0, kMost));
  else
    throw std::invalid_argument("there is no fault '" + name + "'; choose from " + allNames());
}

}  // namespace wiimote_tracker::virtual_wiimote
