// Blink codes, their file, and the table and sketch for a microcontroller.
#include "arduino.h"
#include "refusal_of.h"
#include "tools/blink_codes/listing.h"
#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/identity/codes_file.h"
#include "wiimote_tracker_triangulation/identity/schemes.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

namespace arduino {
namespace cyclic {
#include "blink_codes.ino"
}
namespace paper {
#include "blink_codes_paper.ino"
}
}  // namespace arduino

namespace wiimote_tracker::identity {
namespace {

namespace fs = std::filesystem;

TEST(Waveform, LightDarknessAndDifference) {
  const Waveform waveform = {{0.0, 0.1}, {0.4, 0.5}, {0.7, 1.0}};
  EXPECT_EQ(1.0, litShare(waveform, 0.05, 0.0));
  EXPECT_EQ(0.0, litShare(waveform, 0.1, 0.0));
  EXPECT_EQ(1.0, litShare(waveform, -3.3, 0.0));
  EXPECT_NEAR(0.5, litShare(waveform, 0.0, 1.0), 1e-12);
  EXPECT_NEAR(0.5, litShare(waveform, 17.3, 2.0), 1e-12);
  EXPECT_NEAR(0.5, litShare(waveform, 0.35, 0.1), 1e-12);
  EXPECT_NEAR(1.0, litShare(waveform, -0.2, 0.3), 1e-12);
  EXPECT_NEAR(0.3, longestDark(waveform), 1e-12);
  EXPECT_NEAR(0.1, shortestRun(waveform), 1e-12);
  EXPECT_NEAR(0.4, shortestRun({{0.0, 0.2}, {0.6, 1.0}}), 1e-12) << "the dark one";
  EXPECT_NEAR(0.2, shortestRun({{0.0, 0.1}, {0.4, 0.6}, {0.9, 1.0}}), 1e-12) << "across the end";
  EXPECT_NEAR(0.2, difference({{0.0, 0.5}}, {{0.1, 0.6}}, 0.0), 1e-12);
  EXPECT_NEAR(0.0, difference({{0.0, 0.5}}, {{0.1, 0.6}}, 0.1), 1e-12);
  EXPECT_NEAR(0.0, differenceInAnyRotation({{0.0, 0.5}}, {{0.25, 0.75}}), 1e-12);
  EXPECT_NEAR(0.3, differenceInAnyRotation({{0.0, 0.5}}, {{0.1, 0.9}}), 1e-12);
}

TEST(Waveform, TheDifferenceIsTheLeastOfManyShifts) {
  const Waveform one = {{0.05, 0.2}, {0.3, 0.75}};
  const Waveform other = {{0.0, 0.33}, {0.4, 0.5}, {0.81, 0.9}};
  double least = 1.0;
  for (int shift = 0; shift < 1000; ++shift) {
    double sum = 0.0;
    for (int i = 0; i < 1000; ++i)
      sum += 1e-3 * std::abs(litShare(one, (i + 0.5) * 1e-3, 0.0) -
                             litShare(other, (i + 0.5) * 1e-3 + shift * 1e-3, 0.0));
    least = std::min(least, sum);
  }
  EXPECT_NEAR(least, differenceInAnyRotation(one, other), 0.004);
}

TEST(Schemes, ThePapersLedsSwitchOnInOrderAndOffInReverse) {
  const BlinkCodes codes = dutyCodes({{"a", 0.9}, {"b", 0.6}, {"c", 0.4}, {"d", 0.2}}, 0.1, 0.3);
  EXPECT_TRUE(codes.synchronous);
  const double shares[] = {0.9, 0.6, 0.4, 0.2};
  for (std::size_t i = 0; i < 4; ++i) {
    const Waveform& waveform = codes.codes[i].waveform;
    EXPECT_NEAR(shares[i], litShare(waveform, 0.0, 1.0), 1e-12);
    if (i > 0) {
      EXPECT_GT(waveform[0].from, codes.codes[i - 1].waveform[0].from);
      EXPECT_LT(waveform[0].to, codes.codes[i - 1].waveform[0].to);
    }
  }
  EXPECT_NEAR(0.8 * 0.3, codes.longestDark(), 1e-12);
}

TEST(Schemes, WordsAreOnAndOffChipByChip) {
  const BlinkCodes codes = cyclicCodes({{"a", "0110"}, {"b", "1101"}}, 0.025, 0.01);
  EXPECT_FALSE(codes.synchronous);
  EXPECT_NEAR(0.099, codes.shortest_period, 1e-12);
  EXPECT_NEAR(0.101, codes.longest_period, 1e-12);
  for (std::size_t led = 0; led < 2; ++led) {
    const std::string word = led == 0 ? "0110" : "1101";
    for (std::size_t chip = 0; chip < 4; ++chip)
      EXPECT_EQ(word[chip] == '1' ? 1.0 : 0.0,
                litShare(codes.codes[led].waveform, (static_cast<double>(chip) + 0.5) / 4.0, 0.0));
  }
  EXPECT_NEAR(2 * 0.25 * 0.101, codes.longestDark(), 1e-12);
}

/// Least Hamming distance of two words of equal length over all rotations.
std::size_t rotationDistance(const std::string& one, const std::string& other) {
  std::size_t least = one.size();
  for (std::size_t shift = 0; shift < one.size(); ++shift) {
    std::size_t differing = 0;
    for (std::size_t i = 0; i < one.size(); ++i)
      differing += one[i] != other[(i + shift) % other.size()];
    least = std::min(least, differing);
  }
  return least;
}

std::size_t longestRunOfZeros(const std::string& word) {
  std::size_t longest = 0, run = 0;
  for (const char chip : word + word) {
    run = chip == '0' ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  return longest;
}

TEST(Schemes, ChosenWordsFollowTheRules) {
  for (const std::size_t count : {1, 2, 3, 4, 5, 8, 10, 16, 33, 100}) {
    const std::vector<std::string> words = chooseWords(count);
    ASSERT_EQ(count, words.size());
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_LE(longestRunOfZeros(words[i]), count <= 4 ? 1u : 2u);
      for (std::size_t j = 0; j < i; ++j)
        EXPECT_GE(rotationDistance(words[i], words[j]), 2u) << words[i] << ' ' << words[j];
    }
    std::vector<CyclicLed> leds;
    for (const std::string& word : words)
      leds.push_back({"led" + std::to_string(leds.size()), word});
    EXPECT_NO_THROW(cyclicCodes(leds, 0.02, 0.01));
  }
  EXPECT_EQ(8u, chooseWords(4)[0].size());
  const std::vector<std::string> far = chooseWords(4, WordRules{2, 3, 20});
  ASSERT_EQ(4u, far.size());
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GE(rotationDistance(far[i], far[j]), 3u);
  }
  EXPECT_TRUE(chooseWords(3, WordRules{1, 2, 5}).empty());
  EXPECT_THROW(chooseWords(1000000), Error);
}

TEST(BlinkCodes, IndistinguishableCodesAreRefusedByName) {
  const auto cyclic = [](const std::string& one, const std::string& other) {
    return refusalOf([&] { cyclicCodes({{"hand", one}, {"head", other}}, 0.02, 0.01); });
  };
  EXPECT_NE(std::string::npos, cyclic("0011", "1001").find("hand and head blink alike"));
  EXPECT_NE(std::string::npos, cyclic("0011", "1111").find("head is always on"));
  EXPECT_NE(std::string::npos, cyclic("0011", "0000").find("head is never on"));
  EXPECT_NE(std::string::npos, cyclic("0011", "01011").find("head has another length"));
  EXPECT_NE(std::string::npos, cyclic("0011", "01x1").find("'01x1'"));
  EXPECT_EQ("not refused", cyclic("0011", "0101"));
  const auto duty = [](double share, double shortest, double longest) {
    return refusalOf([&] { dutyCodes({{"hand", 0.5}, {"head", share}}, shortest, longest); });
  };
  EXPECT_NE(std::string::npos, duty(0.52, 0.1, 0.1).find("hand and head blink alike"));
  EXPECT_NE(std::string::npos, duty(1.0, 0.1, 0.1).find("share of head"));
  EXPECT_NE(std::string::npos, duty(std::nan(""), 0.1, 0.1).find("share of head"));
  EXPECT_NE(std::string::npos, duty(0.7, 0.2, 0.1).find("period"));
  EXPECT_NE(std::string::npos, duty(0.7, 0.1, std::nan("")).find("period"));
  EXPECT_NE(std::string::npos, duty(0.7, 0.02, 0.5).find("ten times"));
  EXPECT_EQ("not refused", duty(0.56, 0.1, 0.5));
  EXPECT_NE(std::string::npos, refusalOf([] {
                                 dutyCodes({{"a b", 0.5}}, 0.1, 0.1);
                               }).find("'a b' is no label"));
  EXPECT_NE(std::string::npos, refusalOf([] {
                                 dutyCodes({{"a", 0.5}, {"a", 0.7}}, 0.1, 0.1);
                               }).find("a is there twice"));
  EXPECT_NE(std::string::npos, refusalOf([] { dutyCodes({}, 0.1, 0.1); }).find("no LEDs"));
  std::vector<DutyLed> nine;
  for (int i = 0; i < 9; ++i)
    nine.push_back({"led" + std::to_string(i), 0.1 + 0.1 * i - 0.05});
  EXPECT_NE(std::string::npos, refusalOf([&] { dutyCodes(nine, 0.1, 0.1); }).find("at most 8"));
}

class CodesFile : public testing::Test {
 protected:
  void SetUp() override {
    file_ = (fs::path(testing::TempDir()) /
             (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + "_" +
              std::to_string(::getpid()) + ".yaml"))
                .string();
  }
  void TearDown() override { fs::remove(file_); }

  BlinkCodes read(const std::string& content) {
    std::ofstream(file_) << content;
    return readBlinkCodes(file_);
  }
  std::string refusal(const std::string& content) {
    return refusalOf([&] { read(content); });
  }

  std::string file_;
};

const std::string kHead = "format: wiimote_tracker_blink_codes\nversion: 1\n";

TEST_F(CodesFile, BothSchemesAreRead) {
  const BlinkCodes cyclic = read(kHead +
                                 "scheme: cyclic\nchip: 0.02\ntolerance: 0\nleds:\n"
                                 "  - {label: hand, word: \"0011\"}\n"
                                 "  - {label: head, word: \"0101\"}\n");
  EXPECT_EQ("head", cyclic.codes.at(1).label);
  EXPECT_NEAR(0.08, cyclic.shortest_period, 1e-12);
  EXPECT_FALSE(cyclic.synchronous);
  const BlinkCodes duty = read(kHead +
                               "scheme: duty\nperiod: [0.1, 0.2]\nleds:\n"
                               "  - {label: hand, share: 0.7}\n");
  EXPECT_TRUE(duty.synchronous);
  EXPECT_EQ(0.2, duty.longest_period);
}

TEST_F(CodesFile, ItsFaultsAreNamed) {
  const std::string leds = "leds:\n  - {label: hand, share: 0.7}\n";
  const auto fault = [&](const std::string& content, const std::string& part) {
    const std::string said = refusal(content);
    EXPECT_EQ(0u, said.find(file_)) << said;
    EXPECT_NE(std::string::npos, said.find(part)) << said;
  };
  fault("format: rig\nversion: 1\n", "format is not wiimote_tracker_blink_codes");
  fault("format: wiimote_tracker_blink_codes\nversion: 2\n", "version is 2");
  fault(kHead + "scheme: morse\n", "scheme is neither duty nor cyclic");
  fault(kHead + "scheme: duty\n" + leds, "period is missing");
  fault(kHead + "scheme: duty\nperiod: [0.1]\n" + leds, "period is not [shortest, longest]");
  fault(kHead + "scheme: duty\nperiod: [0.1, 0.2]\nchip: 0.1\n" + leds, "chip is an unknown key");
  fault(kHead + "scheme: duty\nperiod: [0.1, 0.2]\nleds:\n  - {label: a, share: 0.5, on: 1}\n",
        "leds[0]/on is an unknown key");
  fault(kHead + "scheme: duty\nperiod: [0.1, 0.2]\nleds:\n  - {label: a, share: 1.5}\n",
        "share of a");
  fault(kHead + "scheme: cyclic\nchip: 0.02\ntolerance: 0.5\nleds:\n  - {label: a, word: \"01\"}\n",
        "tolerance");
  fault("[1, 2", "is not YAML");
}

TEST_F(CodesFile, ChosenCodesAreAFile) {
  const std::string text =
      blink_codes_tool::cyclicFile({"hand", "head", "foot", "knee", "hip"}, 0.021, 0.005);
  const BlinkCodes codes = read(text);
  ASSERT_EQ(5u, codes.codes.size());
  EXPECT_EQ("hip", codes.codes[4].label);
  EXPECT_THROW(blink_codes_tool::cyclicFile({"hand", "hand"}, 0.02, 0.01), Error);
}

TEST(Listing, TheTableListsSwitchingTimes) {
  const std::string text =
      blink_codes_tool::table(dutyCodes({{"hand", 0.9}, {"head", 0.2}}, 0.2, 0.3), 0.2);
  EXPECT_NE(std::string::npos, text.find("period 200.000 ms, synchronous"));
  EXPECT_NE(std::string::npos, text.find(" 10.000-190.000\n")) << text;
  EXPECT_NE(std::string::npos, text.find(" 80.000-120.000\n")) << text;
}

TEST(Listing, RemarksNameWhatCamerasMiss) {
  const std::string text =
      blink_codes_tool::remarks(dutyCodes({{"hand", 0.9}, {"head", 0.2}}, 0.08, 0.3));
  EXPECT_NE(std::string::npos, text.find("hand and head, which differ for 70.0 %")) << text;
  EXPECT_NE(std::string::npos, text.find("dark for up to 240.0 ms")) << text;
  EXPECT_NE(std::string::npos, text.find("shortest pulse or gap is 8.0 ms")) << text;
  EXPECT_EQ(std::string::npos,
            blink_codes_tool::remarks(dutyCodes({{"hand", 0.9}, {"head", 0.2}}, 0.11, 0.3))
                .find("shortest"));
}

/// Runs a sketch for ten periods and samples its pins.
void checkSketch(void (*setup)(), void (*loop)(), const BlinkCodes& codes, double period) {
  arduino::outputs.clear();
  arduino::changes.clear();
  // The counter of microseconds overflows meanwhile, as an Arduino's does after 71 minutes.
  arduino::clock =
      std::numeric_limits<unsigned long>::max() - static_cast<unsigned long>(3.5e6 * period);
  const unsigned long start = arduino::clock;
  setup();
  for (int i = 0; i < 10; ++i)
    loop();
  EXPECT_NEAR(10e6 * period, static_cast<double>(arduino::clock - start), 20.0);
  for (std::size_t led = 0; led < codes.codes.size(); ++led) {
    const int pin = static_cast<int>(led) + 2;
    EXPECT_EQ(1u, arduino::outputs.count(pin));
    double error = 0.0;
    int level = 0;
    auto next = arduino::changes.begin();
    for (unsigned long time = 50; time < static_cast<unsigned long>(10e6 * period); time += 100) {
      for (; next != arduino::changes.end() && next->time - start <= time; ++next)
        level = next->pin == pin ? next->level : level;
      const double phase = 1e-6 * static_cast<double>(time) / period;
      error += 1e-4 * std::abs(level - litShare(codes.codes[led].waveform, phase, 0.0));
    }
    // An edge is off by less than 20 us; one sample every 100 us, at most 16 edges per period.
    EXPECT_LT(error, 160 * 1e-4 * 0.5) << codes.codes[led].label;
  }
}

TEST(Listing, TheSketchBlinksAsTheCodesSay) {
  const std::string config = BLINK_CODES_CONFIG;
  const BlinkCodes cyclic = readBlinkCodes(config + "/blink_codes.yaml");
  checkSketch(arduino::cyclic::setup, arduino::cyclic::loop, cyclic,
              0.5 * (cyclic.shortest_period + cyclic.longest_period));
  const BlinkCodes paper = readBlinkCodes(config + "/blink_codes_paper.yaml");
  checkSketch(arduino::paper::setup, arduino::paper::loop, paper, paper.shortest_period);
}

}  // namespace
}  // namespace wiimote_tracker::identity
