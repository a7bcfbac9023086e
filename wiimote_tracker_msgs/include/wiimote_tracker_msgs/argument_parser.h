#pragma once

#include "wiimote_tracker_msgs/error.h"
#include "wiimote_tracker_msgs/interruption.h"

#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace wiimote_tracker {

/// Wrong arguments of a program. what() names the argument, and says what is allowed.
struct BadArguments : Error {
  using Error::Error;
};

/// The arguments of a program, each with the variable that it sets; what is left out keeps its
/// value. Options are declared as --help shows them: "--runs N".
class ArgumentParser {
 public:
  using Words = std::vector<std::string>;

  /// @param program its name or path. @param purpose for --help, with its line breaks.
  ArgumentParser(const std::string& program, const std::string& purpose);
  ~ArgumentParser();

  /// An argument that is needed, without a name before it: "IN.bag".
  void positional(const std::string& name, std::string* value);

  /// All further arguments, at least one: "FILE...".
  void positional(const std::string& name, Words* values);

  void flag(const std::string& words, bool* value, const std::string& description);

  void option(const std::string& words, std::string* value, const std::string& description);

  /// One value or more; the option may be repeated.
  void option(const std::string& words, Words* values, const std::string& description);

  /// One of the words in `allowed`.
  void option(const std::string& words,
              std::string* value,
              const Words& allowed,
              const std::string& description);

  /// A number from `low` to `high`. A default that is not stands for an option left out.
  template <typename Number>
  void option(const std::string& words,
              Number* value,
              std::common_type_t<Number> low,
              std::common_type_t<Number> high,
              const std::string& description) {
    // Read as a type with a sign, since Boost turns -1 into a large unsigned number.
    using Wide = std::conditional_t<std::is_integral<Number>::value, long long, double>;
    std::ostringstream range;
    range << low << " to " << high;
    const std::function<void(Wide)> take = [=, allowed = range.str()](Wide given) {
      if (given >= static_cast<Wide>(low) && given <= static_cast<Wide>(high))
        *value = static_cast<Number>(given);
      else
        refuse(words, "must be from " + allowed);
    };
    if (*value >= low && *value <= high)
      range << ", default " << *value;
    addNumber(words, take, description + " (" + range.str() + ")");
  }

  /// A program's main(): sets the variables and calls `program`; --help prints the help instead.
  /// An exception, also of `program`, becomes one sentence on stderr, but Interrupted ends the
  /// process. @returns the exit status: of `program`, 2 for BadArguments, 1 for another exception.
  int run(int argc, char** argv, const std::function<int()>& program);

  /// The same for the words after the program's name.
  int run(const Words& words, const std::function<int()>& program);

 private:
  struct Options;  // of Boost, whose headers take long to compile

  void addNumber(const std::string& words,
                 const std::function<void(long long)>& take,
                 const std::string& description);
  void addNumber(const std::string& words,
                 const std::function<void(double)>& take,
                 const std::string& description);
  void addPositional(const std::string& name, std::function<void(Words*)> take);
  void refuse(const std::string& words, const std::string& why);
  void parse(const Words& words);
  void takePositionals(Words words);

  std::string program_, usage_, purpose_;
  std::string refusal_;  // of a value outside its range
  std::unique_ptr<Options> options_;
  std::vector<std::pair<std::string, std::function<void(Words*)>>> positionals_;
};

}  // namespace wiimote_tracker
