// What the programs' arguments set, and what is said of wrong ones.

#include "wiimote_tracker_msgs/argument_parser.h"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdint>
#include <stdexcept>

namespace wiimote_tracker {
namespace {

using Words = ArgumentParser::Words;

class ArgumentParserTest : public testing::Test {
 protected:
  ArgumentParserTest() {
    parser_.positional("IN.bag", &in_);
    parser_.positional("FILE...", &files_);
    parser_.flag("--fast", &fast_, "in a hurry");
    parser_.option("--json FILE", &json_, "write a file");
    parser_.option("--name NAME", &name_, "of the camera");
    parser_.option("--socket PATH...", &sockets_, "of remotes");
    parser_.option("--mode MODE", &mode_, {"tracks", "instant"}, "how to track");
    parser_.option("--runs N", &runs_, 1, 100, "repetitions");
    parser_.option("--seed N", &seed_, 0, 4294967295, "of random numbers");
    parser_.option("--period S", &period_, 0.5, 100.0, "of the LEDs [s]");
  }

  int run(
      Words words,
      const std::function<int()>& program = [] { return 0; }) {
    words.insert(words.begin(), "program");
    std::vector<char*> arguments;
    for (std::string& word : words)
      arguments.push_back(word.data());
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int status = parser_.run(static_cast<int>(arguments.size()), arguments.data(), program);
    output_ = testing::internal::GetCapturedStdout();
    errors_ = testing::internal::GetCapturedStderr();
    return status;
  }

  /// With these words behind those that are needed. @returns the sentence.
  std::string refusal(const Words& words) {
    Words all{"a.bag", "b"};
    all.insert(all.end(), words.begin(), words.end());
    EXPECT_EQ(run(all), 2);
    EXPECT_EQ(errors_.rfind("program: ", 0), 0U);
    EXPECT_NE(errors_.find("\nusage: program [options] IN.bag FILE...\n"), std::string::npos);
    return errors_.substr(0, errors_.find('\n'));
  }

  ArgumentParser parser_{"/lib/program", "Does all."};
  std::string in_, json_, mode_, name_ = "door", output_, errors_;
  Words files_, sockets_;
  bool fast_ = false;
  int runs_ = 20;
  std::uint32_t seed_ = 1;
  double period_ = 0.0;
};

TEST_F(ArgumentParserTest, sets_what_is_given_and_leaves_the_rest) {
  EXPECT_EQ(
      run({"a.bag", "--runs", "7", "--socket", "c", "d", "--socket=e", "--fast", "b", "--", "--f"}),
      0);
  EXPECT_EQ(in_, "a.bag");
  EXPECT_EQ(files_, (Words{"b", "--f"}));
  EXPECT_EQ(sockets_, (Words{"c", "d", "e"}));
  EXPECT_TRUE(fast_);
  EXPECT_EQ(runs_, 7);
  EXPECT_EQ(json_ + mode_, "");
  EXPECT_EQ(seed_, 1U);
  EXPECT_EQ(run({"a.bag", "b", "--mode", "instant", "--seed", "4294967295", "--period=0.5"}), 0);
  EXPECT_EQ(mode_, "instant");
  EXPECT_EQ(seed_, 4294967295U);
  EXPECT_EQ(period_, 0.5);
}

TEST_F(ArgumentParserTest, help_says_what_is_allowed) {
  EXPECT_EQ(run({"--wrong", "-h"}, [] { return 3; }), 0);
  for (const char* words : {"usage: program [options] IN.bag FILE...\nDoes all.\n", "--json FILE ",
                            "of the camera (default door)", "how to track (tracks, instant)",
                            "repetitions (1 to 100, default 20)", "of the LEDs [s] (0.5 to 100)\n"})
    EXPECT_NE(output_.find(words), std::string::npos) << words << output_;
}

TEST_F(ArgumentParserTest, a_refusal_names_the_argument_and_what_is_allowed) {
  EXPECT_EQ(run({}), 2);
  EXPECT_EQ(errors_.rfind("program: IN.bag is missing\n", 0), 0U);
  EXPECT_EQ(run({"a.bag"}), 2);
  EXPECT_EQ(errors_.rfind("program: FILE... is missing\n", 0), 0U);
  for (const char* number : {"0", "101", "-1"})
    EXPECT_EQ(refusal({"--runs", number}), "program: --runs must be from 1 to 100");
  for (const char* number : {"2.5", "many", ""})
    EXPECT_NE(refusal({"--runs", number}).find("--runs: repetitions (1 to 100"), std::string::npos);
  EXPECT_EQ(refusal({"--seed", "-1"}), "program: --seed must be from 0 to 4294967295");
  EXPECT_EQ(refusal({"--period", "nan"}), "program: --period must be from 0.5 to 100");
  EXPECT_EQ(refusal({"--mode", "x"}), "program: --mode must be tracks or instant");
  EXPECT_NE(refusal({"--json"}).find("--json: write a file"), std::string::npos);
  EXPECT_EQ(refusal({"--json", "--fast"}), "program: --json needs a value");
  EXPECT_NE(refusal({"--json", "a", "--json", "b"}).find("'--json'"), std::string::npos);
  EXPECT_NE(refusal({"--jso", "a"}).find("'--jso'"), std::string::npos);
  EXPECT_NE(refusal({"-x"}).find("'-x'"), std::string::npos);
}

TEST_F(ArgumentParserTest, ends_by_the_signal_that_interrupts_the_program) {
  const auto program = [] {
    std::signal(SIGINT, SIG_DFL);  // a script's background ignores it
    deferInterruption();
    std::raise(SIGINT);
    throwIfInterrupted();
    return 0;
  };
  EXPECT_EXIT(parser_.run(Words{"a", "b"}, program), testing::KilledBySignal(SIGINT), "");
}

TEST_F(ArgumentParserTest, a_program_ends_with_its_own_status) {
  EXPECT_EQ(run({"a", "b"}, [] { return 3; }), 3);
  EXPECT_EQ(errors_, "");
  EXPECT_EQ(run({"a", "b"}, []() -> int { throw std::runtime_error("no room"); }), 1);
  EXPECT_EQ(errors_, "program: no room\n");
  EXPECT_EQ(run({"a", "b"}, []() -> int { throw BadArguments("--fast or --json"); }), 2);
  EXPECT_EQ(errors_.rfind("program: --fast or --json\n", 0), 0U);
}

}  // namespace
}  // namespace wiimote_tracker
