#pragma once

#include <clocale>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace wiimote_tracker {

/// While it lives, the C library writes and reads numbers as in German, "0,5". A machine that has
/// no German locale gets one from the sources of the package locales.
class GermanLocale {
 public:
  GermanLocale() {
    if (std::setlocale(LC_ALL, kName))
      return;
    std::string pattern = (std::filesystem::temp_directory_path() / "locale_XXXXXX").string();
    if (!mkdtemp(&pattern[0]))
      return;
    folder_ = pattern;
    const std::string made = folder_ + "/" + kName;
    // Its status tells warnings and errors not apart.
    if (std::system(("localedef -i de_DE -f UTF-8 '" + made + "' >/dev/null 2>&1").c_str()) >= 0) {
      setenv("LOCPATH", folder_.c_str(), 1);
      std::setlocale(LC_ALL, kName);
    }
  }
  ~GermanLocale() {
    std::setlocale(LC_ALL, "C");
    if (folder_.empty())
      return;
    unsetenv("LOCPATH");
    std::filesystem::remove_all(folder_);
  }
  GermanLocale(const GermanLocale&) = delete;
  GermanLocale& operator=(const GermanLocale&) = delete;

  bool isSet() const { return std::localeconv()->decimal_point == std::string(","); }

  /// Why it may not be set.
  static constexpr char kMissing[] = "no German locale: install the package locales";

 private:
  static constexpr char kName[] = "de_DE.UTF-8";

  std::string folder_;
};

}  // namespace wiimote_tracker
