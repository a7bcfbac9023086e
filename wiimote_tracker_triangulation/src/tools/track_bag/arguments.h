#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_ARGUMENTS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_ARGUMENTS_H

#include <optional>
#include <string>

namespace wiimote_tracker {

/// The command line of track_bag.
struct Arguments {
  std::string input;
  std::string output;
  std::string mode;                       ///< Empty: as the parameters say.
  std::string parameters;                 ///< File; empty: the defaults.
  std::string rig;                        ///< File; empty: as recorded.
  std::string csv;                        ///< File; empty: none.
  std::string matlab;                     ///< File; empty: none.
  std::optional<std::string> name_space;  ///< With a slash at both ends; nothing: that of the rig.
  bool results_only = false;
  bool wants_help = false;
  unsigned threads = 0;  ///< 0: as many as are of use.
};

extern const char* const kUsage;

/// @throws std::invalid_argument: what is wrong with it.
Arguments readArguments(int argc, const char* const* argv);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_ARGUMENTS_H
