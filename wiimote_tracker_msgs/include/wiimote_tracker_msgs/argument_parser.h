#pragma once

#include "wiimote_tracker_msgs/error.h"
#include "wiimote_tracker_msgs/interruption.h"
#include "wiimote_tracker_msgs/text.h"

#include <boost/program_options.hpp>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <functional>
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
/// value. Options are declared as --help shows them: "--runs N". Link Boost::program_options.
class ArgumentParser {
 public:
  using Words = std::vector<std::string>;

  /// @param program its name or path. @param purpose for --help, with its line breaks.
  ArgumentParser(const std::string& program, const std::string& purpose)
      : program_(program.substr(program.rfind('/') + 1)),
        usage_("usage: " + program_ + " [options]"),
        purpose_(purpose) {
    options_.add_options()("help,h", "print this help");
  }

  /// An argument that is needed, without a name before it: "IN.bag".
  void positional(const std::string& name, std::string* value) {
    addPositional(name, [value](Words* words) {
      *value = words->front();
      words->erase(words->begin());
    });
  }

  /// All further arguments, at least one: "FILE...".
  void positional(const std::string& name, Words* values) {
    addPositional(name, [values](Words* words) { *values = std::exchange(*words, {}); });
  }

  void flag(const std::string& words, bool* value, const std::string& description) {
    add(words, boost::program_options::bool_switch(value), description);
  }

  void option(const std::string& words, std::string* value, const std::string& description) {
    add(words, boost::program_options::value(value),
        description + (value->empty() ? "" : " (default " + *value + ")"));
  }

  /// One value or more; the option may be repeated.
  void option(const std::string& words, Words* values, const std::string& description) {
    add(words, boost::program_options::value(values)->multitoken(), description);
  }

  /// One of the words in `allowed`.
  void option(const std::string& words,
              std::string* value,
              const Words& allowed,
              const std::string& description) {
    const auto check = [=](const std::string& given) {
      if (std::find(allowed.begin(), allowed.end(), given) == allowed.end())
        refusal_ = nameOf(words) + " must be " + joined(allowed, " or ");
    };
    add(words, boost::program_options::value(value)->notifier(check),
        description + " (" + joined(allowed) + ")");
  }

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
    const auto take = [=, allowed = range.str()](Wide given) {
      if (given >= static_cast<Wide>(low) && given <= static_cast<Wide>(high))
        *value = static_cast<Number>(given);
      else
        refusal_ = nameOf(words) + " must be from " + allowed;
    };
    if (*value >= low && *value <= high)
      range << ", default " << *value;
    add(words, boost::program_options::value<Wide>()->notifier(take),
        description + " (" + range.str() + ")");
  }

  /// A program's main(): sets the variables and calls `program`; --help prints the help instead.
  /// An exception, also of `program`, becomes one sentence on stderr, but Interrupted ends the
  /// process. @returns the exit status: of `program`, 2 for BadArguments, 1 for another exception.
  int run(int argc, char** argv, const std::function<int()>& program) {
    return run(Words(argv + std::min(argc, 1), argv + argc), program);
  }

  /// The same for the words after the program's name.
  int run(const Words& words, const std::function<int()>& program) {
    const auto given = [&](const char* word) {
      return std::find(words.begin(), words.end(), word) != words.end();
    };
    try {
      if (given("--help") || given("-h")) {
        std::ostringstream help;
        help << usage_ << "\n" << purpose_ << "\n\n" << options_;
        std::fputs(help.str().c_str(), stdout);
        return 0;
      }
      parse(words);
      return program();
    } catch (const BadArguments& e) {
      std::fprintf(stderr, "%s: %s\n%s\n", program_.c_str(), e.what(), usage_.c_str());
      return 2;
    } catch (const Interrupted& e) {
      std::signal(e.signal, SIG_DFL);
      std::raise(e.signal);
      return 1;
    } catch (const std::exception& e) {
      std::fprintf(stderr, "%s: %s\n", program_.c_str(), e.what());
      return 1;
    }
  }

 private:
  static std::string nameOf(const std::string& words) { return words.substr(0, words.find(' ')); }

  template <typename Value>
  void add(const std::string& words, Value* value, const std::string& description) {
    const std::string name = nameOf(words);
    if (name.size() < words.size())
      value->value_name(words.substr(name.size() + 1));
    options_.add_options()(name.substr(2).c_str(), value, description.c_str());
  }

  void addPositional(const std::string& name, std::function<void(Words*)> take) {
    usage_ += " " + name;
    positionals_.emplace_back(name, std::move(take));
  }

  void parse(const Words& words) {
    namespace po = boost::program_options;
    using Style = po::command_line_style::style_t;
    try {
      const auto parsed = po::command_line_parser(words)
                              .options(options_)
                              .style(Style::unix_style & ~Style::allow_guessing)
                              .run();
      for (const po::option& option : parsed.options) {
        // Boost takes the name of the next option for the value.
        if (option.original_tokens.size() > 1 && option.original_tokens[1].rfind("--", 0) == 0)
          throw BadArguments(option.original_tokens[0] + " needs a value");
      }
      takePositionals(po::collect_unrecognized(parsed.options, po::include_positional));
      po::variables_map values;
      po::store(parsed, values);
      po::notify(values);
      if (!refusal_.empty())
        throw BadArguments(refusal_);
    } catch (const po::error_with_option_name& e) {
      const std::string name = e.get_option_name();  // with its dashes
      const po::option_description* known =
          name.size() > 2 ? options_.find_nothrow(name.substr(2), false) : nullptr;
      throw BadArguments(e.what() + (known ? "; " + name + ": " + known->description()
                                           : "; --help lists the options"));
    }
  }

  void takePositionals(Words words) {
    for (const auto& [name, take] : positionals_) {
      if (words.empty())
        throw BadArguments(name + " is missing");
      take(&words);
    }
    if (!words.empty())
      throw BadArguments("'" + words.front() + "' is one argument too many");
  }

  std::string program_, usage_, purpose_;
  std::string refusal_;  // of a value outside its range
  boost::program_options::options_description options_{"Options", 100};
  std::vector<std::pair<std::string, std::function<void(Words*)>>> positionals_;
};

}  // namespace wiimote_tracker
