#include "number_text.h"

#include <cstdio>
#include <cstdlib>
#include <limits>

namespace wiimote_tracker::session {

ClassicLocale::ClassicLocale()
    : classic_(newlocale(LC_ALL_MASK, "C", nullptr)), before_(uselocale(classic_)) {}

ClassicLocale::~ClassicLocale() {
  uselocale(before_);
  freelocale(classic_);
}

void appendNumber(double value, std::string* text) {
  char digits[32];
  for (int precision = std::numeric_limits<double>::digits10;
       precision <= std::numeric_limits<double>::max_digits10; ++precision) {
    std::snprintf(digits, sizeof digits, "%.*g", precision, value);
    if (std::strtod(digits, nullptr) == value)
      break;
  }
  *text += digits;
}

}  // namespace wiimote_tracker::session
