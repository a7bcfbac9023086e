#include "wiimote_tracker_msgs/argument_parser.h"

#include "wiimote_tracker_msgs/text.h"

#include <boost/program_options.hpp>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>

namespace wiimote_tracker {

namespace po = boost::program_options;

namespace {

std::string nameOf(const std::string& words) {
  return words.substr(0, words.find(' '));
}

}  // namespace

struct ArgumentParser::Options {
  template <typename Value>
  void add(const std::string& words, Value* value, const std::string& description) {
    const std::string name = nameOf(words);
    if (name.size() < words.size())
      value->value_name(words.substr(name.size() + 1));
    all.add_options()(name.substr(2).c_str(), value, description.c_str());
  }

  po::options_description all{"Options", 100};
};

ArgumentParser::ArgumentParser(const std::string& program, const std::string& purpose)
    : program_(program.substr(program.rfind('/') + 1)),
      usage_("usage: " + program_ + " [options]"),
      purpose_(purpose),
      options_(std::make_unique<Options>()) {
  options_->all.add_options()("help,h", "print this help");
}

ArgumentParser::~ArgumentParser() = default;

void ArgumentParser::positional(const std::string& name, std::string* value) {
  addPositional(name, [value](Words* words) {
    *value = words->front();
    words->erase(words->begin());
  });
}

void ArgumentParser::positional(const std::string& name, Words* values) {
  addPositional(name, [values](Words* words) { *values = std::exchange(*words, {}); });
}

void ArgumentParser::flag(const std::string& words, bool* value, const std::string& description) {
  options_->add(words, po::bool_switch(value), description);
}

void ArgumentParser::option(const std::string& words,
                            std::string* value,
                            const std::string& description) {
  options_->add(words, po::value(value),
                description + (value->empty() ? "" : " (default " + *value + ")"));
}

void ArgumentParser::option(const std::string& words,
                            Words* values,
                            const std::string& description) {
  options_->add(words, po::value(values)->multitoken(), description);
}

void ArgumentParser::option(const std::string& words,
                            std::string* value,
                            const Words& allowed,
                            const std::string& description) {
  const auto check = [=](const std::string& given) {
    if (std::find(allowed.begin(), allowed.end(), given) == allowed.end())
      refuse(words, "must be " + joined(allowed, " or "));
  };
  options_->add(words, po::value(value)->notifier(check),
                description + " (" + joined(allowed) + ")");
}

void ArgumentParser::addNumber(const std::string& words,
                               const std::function<void(long long)>& take,
                               const std::string& description) {
  options_->add(words, po::value<long long>()->notifier(take), description);
}

void ArgumentParser::addNumber(const std::string& words,
                               const std::function<void(double)>& take,
                               const std::string& description) {
  options_->add(words, po::value<double>()->notifier(take), description);
}

void ArgumentParser::addPositional(const std::string& name, std::function<void(Words*)> take) {
  usage_ += " " + name;
  positionals_.emplace_back(name, std::move(take));
}

void ArgumentParser::refuse(const std::string& words, const std::string& why) {
  refusal_ = nameOf(words) + " " + why;
}

int ArgumentParser::run(int argc, char** argv, const std::function<int()>& program) {
  return run(Words(argv + std::min(argc, 1), argv + argc), program);
}

int ArgumentParser::run(const Words& words, const std::function<int()>& program) {
  const auto given = [&](const char* word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  try {
    if (given("--help") || given("-h")) {
      std::ostringstream help;
      help << usage_ << "\n" << purpose_ << "\n\n" << options_->all;
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

void ArgumentParser::parse(const Words& words) {
  using Style = po::command_line_style::style_t;
  try {
    const auto parsed = po::command_line_parser(words)
                            .options(options_->all)
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
        name.size() > 2 ? options_->all.find_nothrow(name.substr(2), false) : nullptr;
    throw BadArguments(e.what() + (known ? "; " + name + ": " + known->description()
                                         : "; --help lists the options"));
  }
}

void ArgumentParser::takePositionals(Words words) {
  for (const auto& [name, take] : positionals_) {
    if (words.empty())
      throw BadArguments(name + " is missing");
    take(&words);
  }
  if (!words.empty())
    throw BadArguments("'" + words.front() + "' is one argument too many");
}

}  // namespace wiimote_tracker
