#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_SESSION_NUMBER_TEXT_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_SESSION_NUMBER_TEXT_H

#include <locale.h>

#include <string>

namespace wiimote_tracker::session {

/// While it lives, this thread writes and reads numbers with a decimal point in every locale.
class ClassicLocale {
 public:
  ClassicLocale();
  ~ClassicLocale();
  ClassicLocale(const ClassicLocale&) = delete;
  ClassicLocale& operator=(const ClassicLocale&) = delete;

 private:
  locale_t classic_;
  locale_t before_;
};

/// Appends the shortest text of a finite number that reads back bit for bit. Needs a ClassicLocale.
void appendNumber(double value, std::string* text);

}  // namespace wiimote_tracker::session

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_SESSION_NUMBER_TEXT_H
