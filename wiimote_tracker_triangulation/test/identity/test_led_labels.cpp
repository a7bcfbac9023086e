// The labels of the LEDs: by order, by place, by blinking. More than 400 lines, because these ways
// are one class, and each test is short.
#include "identity/label_places_file.h"
#include "identity/led_labels.h"
#include "wiimote_tracker_triangulation/identity/schemes.h"

#include <gtest/gtest.h>
#include <wiimote_tracker_msgs/doubtful_label.h>

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace wiimote_tracker::identity {
namespace {

using tracking::TrackedLed;
using tracking::TrackState;

TrackedLed led(std::uint32_t id, TrackState state) {
  TrackedLed led;
  led.id = id;
  led.state = state;
  return led;
}

constexpr double kTime = 100.0;  // of snapshots [s]

TEST(LedLabels, AreGivenInTheOrderOfConfirmation) {
  LedLabels labels({"left", "right"});
  labels.update(kTime, {led(0, TrackState::kTentative), led(1, TrackState::kTentative)});
  EXPECT_EQ("led_0", labels.of(0).name);
  labels.update(kTime, {led(0, TrackState::kTentative), led(1, TrackState::kTracked)});
  EXPECT_EQ("led_0", labels.of(0).name);
  EXPECT_EQ("left", labels.of(1).name);
  labels.update(kTime, {led(0, TrackState::kTracked), led(1, TrackState::kPredicted),
                        led(2, TrackState::kTracked)});
  EXPECT_EQ("right", labels.of(0).name);
  EXPECT_EQ("left", labels.of(1).name) << "kept while hidden";
  EXPECT_EQ("led_2", labels.of(2).name);
}

TEST(LedLabels, OfALostTrackGoToTheNextNewOne) {
  LedLabels labels({"led"});
  labels.update(kTime, {led(3, TrackState::kTracked)});
  labels.update(kTime, {led(3, TrackState::kLost)});
  EXPECT_EQ("led", labels.of(3).name) << "in the message that says so";
  labels.update(kTime, {led(5, TrackState::kTentative)});
  EXPECT_EQ("led", labels.of(3).name) << "still known to what looks back one snapshot";
  labels.update(kTime, {led(5, TrackState::kTracked)});
  EXPECT_EQ("led", labels.of(5).name);
  EXPECT_EQ("led_3", labels.of(3).name);
}

/// An LED that was hidden may be found again before its old track is given up.
TEST(LedLabels, OfALostTrackGoToTheOldestThatHasNone) {
  LedLabels labels({"led"});
  labels.update(kTime, {led(3, TrackState::kPredicted), led(4, TrackState::kTentative)});
  labels.update(kTime, {led(2, TrackState::kTracked)});
  labels.update(kTime, {led(2, TrackState::kPredicted), led(4, TrackState::kTracked),
                        led(5, TrackState::kTracked)});
  EXPECT_EQ("led", labels.of(2).name);
  EXPECT_EQ("led_4", labels.of(4).name);
  labels.update(kTime, {led(2, TrackState::kLost), led(4, TrackState::kTracked),
                        led(5, TrackState::kTracked)});
  EXPECT_EQ("led", labels.of(2).name);
  EXPECT_EQ("led_4", labels.of(4).name) << "no two of one name in one snapshot";
  labels.update(kTime, {led(4, TrackState::kTracked), led(5, TrackState::kTracked)});
  EXPECT_EQ("led", labels.of(4).name);
  EXPECT_EQ("led_5", labels.of(5).name);
}

TEST(LedLabels, AreAllFreeWhenTimeStartsAnew) {
  LedLabels labels({"a", "b"});
  labels.update(kTime, {led(0, TrackState::kTracked), led(1, TrackState::kTracked)});
  labels.clear();
  EXPECT_EQ("a", labels.of(0).name);
  labels.update(kTime, {led(2, TrackState::kTracked)});
  EXPECT_EQ("a", labels.of(2).name);
}

TrackedLed at(std::uint32_t id, double x, TrackState state = TrackState::kTracked) {
  TrackedLed result = led(id, state);
  result.position = {x, 0.0, 0.0};
  return result;
}

/// Such as after a pause of this process.
TEST(LedLabels, ReturnByPlaceWithin10Seconds) {
  for (const double pause : {5.0, 11.0}) {
    LedLabels labels({"a", "b", "c"});
    labels.update(100.0, {at(0, 0.0), at(1, 1.0), at(2, 2.0)});
    const TrackState lost = TrackState::kLost;
    labels.update(100.1, {at(0, 0.0, lost), at(1, 1.0, lost), at(2, 2.0, lost)});
    labels.update(100.1, {});
    labels.update(100.0 + pause, {at(3, 2.2)});
    labels.update(100.1 + pause, {at(3, 2.2), at(4, 0.8), at(5, 0.7)});
    const bool by_place = pause < 10.0;
    EXPECT_EQ(by_place ? "c" : "a", labels.of(3).name);
    EXPECT_EQ("b", labels.of(4).name);
    EXPECT_EQ(by_place ? "a" : "c", labels.of(5).name);
  }
}

/// An LED that paused when it was seen last may have moved on.
TEST(LedLabels, ReturnToTheNearerPlaceWhateverTheSpeedThere) {
  LedLabels labels({"pauses", "moves"});
  TrackedLed pauses = led(1, TrackState::kTracked);
  TrackedLed moves = led(2, TrackState::kTracked);
  pauses.position = {0.0, 0.0, 1.0};
  pauses.velocity = Eigen::Vector3d::Zero();
  moves.position = {2.0, 0.0, 1.0};
  moves.velocity = Eigen::Vector3d(0.5, 0.0, 0.0);
  labels.update(kTime, {pauses, moves});
  labels.update(kTime + 0.5, {led(1, TrackState::kLost), led(2, TrackState::kLost)});
  labels.update(kTime + 5.0, {});
  TrackedLed again = led(3, TrackState::kTracked);
  again.position = {1.5, 0.0, 1.0};
  labels.update(kTime + 5.0, {again});
  EXPECT_EQ("moves", labels.of(3).name);
}

/// After a pause of this process the images that waited come camera by camera, each from the first
/// on: time jumps back several times, but only 5 s have passed.
TEST(LedLabels, ReturnByPlaceWhereTimeJumpsBackAgainAndAgain) {
  LedLabels labels({"a", "b", "c"});
  labels.update(100.0, {at(0, 0.0), at(1, 1.5), at(2, 3.0)});
  for (int camera = 0; camera < 4; ++camera) {
    if (camera > 0)
      labels.clear();
    labels.update(101.0, {});
    labels.update(105.0, {});
  }
  labels.update(105.0, {at(3, 2.6), at(4, 1.2), at(5, 0.4)});
  EXPECT_EQ("c", labels.of(3).name);
  EXPECT_EQ("b", labels.of(4).name);
  EXPECT_EQ("a", labels.of(5).name);
}

/// What was seen within the time that is repeated is not older for it.
TEST(LedLabels, ReturnByPlaceWhereRepeatedTimeHasSeenThem) {
  LedLabels labels({"a", "b"});
  labels.update(100.0, {at(0, 0.0), at(1, 2.0)});
  labels.update(108.0, {at(0, 0.0), at(1, 2.0)});
  for (int camera = 0; camera < 4; ++camera) {
    labels.clear();
    labels.update(101.0, {});
    labels.update(109.0, {});
  }
  labels.update(109.0, {at(3, 1.8), at(4, 0.2)});
  EXPECT_EQ("b", labels.of(3).name);
  EXPECT_EQ("a", labels.of(4).name);
  EXPECT_GT(labels.of(3).confidence, 0.9);
}

TEST(LedLabels, ReturnByPlaceAfterARestart) {
  LedLabels labels({"a", "b", "c", "d"});
  labels.update(kTime, {at(0, 0.0), at(1, 1.0), at(2, 2.0)});
  const std::string file = testing::TempDir() + "label_places_" + std::to_string(::getpid());
  ASSERT_FALSE(writePlaces(file, "rig", labels.places()));
  labels.clear();
  labels.clear();
  LedLabels of_another_process({"a", "b", "c", "d"});
  of_another_process.setFormerPlaces(readPlaces(file, "rig", std::chrono::seconds(60)));
  for (LedLabels* restarted : {&labels, &of_another_process}) {
    restarted->update(kTime, {at(3, 2.3)});
    restarted->update(kTime, {at(3, 2.2), at(4, 1.3), at(5, 0.3), at(6, 0.3)});
    EXPECT_EQ("c", restarted->of(3).name);
    EXPECT_EQ("b", restarted->of(4).name);
    EXPECT_EQ("a", restarted->of(5).name);
    EXPECT_EQ("d", restarted->of(6).name) << "the first that was not in use";
  }
  EXPECT_TRUE(readPlaces(file, "rig", std::chrono::seconds(-1)).empty()) << "too old";
  namespace fs = std::filesystem;
  fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::seconds(30));
  EXPECT_NEAR(30.0, readPlaces(file, "rig", std::chrono::seconds(60)).at("a").age, 5.0);
  fs::last_write_time(file, fs::file_time_type::clock::now() + std::chrono::seconds(30));
  EXPECT_GE(readPlaces(file, "rig", std::chrono::seconds(60)).at("a").age, 0.0)
      << "from the future";
  std::ofstream(file, std::ios::app) << "e 1.0 x";
  EXPECT_TRUE(readPlaces(file, "rig", std::chrono::seconds(60)).empty()) << "damaged";
  std::remove(file.c_str());
}

/// A tracker without images would give old places the age of its file, which is none.
TEST(LedLabels, KeepTheirPlacesOnlyAfterASnapshot) {
  LedLabels labels({"a"});
  labels.setFormerPlaces({{"a", {}}});
  EXPECT_FALSE(labels.placesToKeep());
  labels.update(kTime, {at(0, 1.0)});
  ASSERT_TRUE(labels.placesToKeep());
  EXPECT_FALSE(labels.placesToKeep());
  labels.update(kTime + 1.0, {});
  ASSERT_TRUE(labels.placesToKeep());
  EXPECT_EQ(1.0, labels.places().at("a").age);
}

/// All LEDs are lost for a while; then they return, each 0.1 m beside its place.
std::vector<LedLabel> afterLoss(const std::vector<double>& places, double pause) {
  LedLabels labels({"a", "b", "c"});
  std::vector<TrackedLed> leds;
  for (const double x : places)
    leds.push_back(at(static_cast<std::uint32_t>(leds.size()), x));
  labels.update(kTime, leds);
  for (TrackedLed& led : leds) {
    EXPECT_TRUE(std::isnan(labels.of(led.id).confidence)) << "given for the first time";
    led.state = TrackState::kLost;
  }
  labels.update(kTime, leds);
  labels.update(kTime, {});
  for (TrackedLed& led : leds)
    led = at(led.id + 10, led.position.x() + 0.1);
  labels.update(kTime + pause, leds);
  std::vector<LedLabel> result;
  for (const TrackedLed& led : leds) {
    result.push_back(labels.of(led.id));
    const auto& doubtful = labels.doubtful();
    EXPECT_EQ(result.back().confidence < kDoubtfulLabel,
              std::count(doubtful.begin(), doubtful.end(), result.back().name) == 1);
  }
  labels.update(kTime + pause, leds);
  EXPECT_TRUE(labels.doubtful().empty()) << "said once";
  return result;
}

TEST(LedLabels, StateTheirProbabilityWhenGivenAgain) {
  for (const LedLabel& label : afterLoss({0.0, 1.5, 3.0}, 1.0)) {
    EXPECT_GT(label.confidence, 0.95) << label.name << " returned to its place";
    EXPECT_EQ(kTime + 1.0, label.since);
  }
  for (const LedLabel& label : afterLoss({0.0, 0.3, 0.6}, 2.0))
    EXPECT_LT(label.confidence, kDoubtfulLabel) << label.name << " was near others";
  for (const LedLabel& label : afterLoss({0.0, 1.5, 3.0}, 60.0))
    EXPECT_NEAR(1.0 / 3.0, label.confidence, 0.12) << label.name << " may be anywhere";
  EXPECT_GT(afterLoss({0.0}, 1.0)[0].confidence, 0.95);
  EXPECT_NEAR(0.5, afterLoss({0.0}, 60.0)[0].confidence, 0.01) << "it may be a new one";
}

TEST(LedLabels, AreRightFromThenOnIfAPersonSaysSo) {
  LedLabels labels({"a", "b"});
  TrackedLed first = at(0, 0.0), second = at(1, 1.0), third = at(2, 2.0);
  labels.update(kTime, {first, second, third});
  first.same_led_probability = second.same_led_probability = third.same_led_probability = 0.6;
  labels.update(kTime + 0.1, {first, second, third});
  EXPECT_LT(labels.of(0).confidence, kDoubtfulLabel) << "it met the other one";
  const auto expect = [&](const LedLabel& label, const std::string& name, double confidence) {
    EXPECT_EQ(name, label.name);
    EXPECT_EQ(confidence, label.confidence) << name;
    EXPECT_EQ(confidence, labels.places().at(name).confidence) << name;
  };
  EXPECT_EQ("", labels.correct("a", "a"));
  expect(labels.of(0), "a", 1.0);
  expect(labels.of(1), "b", 0.6);
  EXPECT_EQ("", labels.correct("b", "a"));
  for (const double later : {0.2, 0.3}) {
    expect(labels.of(1), "a", 1.0);
    expect(labels.of(0), "b", 1.0);
    EXPECT_EQ(1.0, labels.places().at("a").position.x());
    EXPECT_EQ(0.0, labels.places().at("b").position.x());
    labels.update(kTime + later, {first, second, third});
  }
  EXPECT_EQ("", labels.correct("led_2", "a"));
  labels.update(kTime + 0.4, {first, second, third});
  expect(labels.of(2), "a", 1.0);
  EXPECT_EQ("led_1", labels.of(1).name);
  third.same_led_probability = 0.3;
  labels.update(kTime + 0.5, {first, second, third});
  expect(labels.of(2), "a", 0.5);  // it met another one again
  EXPECT_NE("", labels.correct("led_7", "a")) << "not tracked";
  EXPECT_EQ("'c' is no label of LEDs that do not blink: choose from a, b",
            labels.correct("a", "c"));
  LedLabels none(std::vector<std::string>{});
  none.update(kTime, {first});
  EXPECT_EQ("'a' is no label of LEDs that do not blink: list it in labels",
            none.correct("led_0", "a"));
}

TEST(LedLabels, AreNotDoubtfulForEverWhereThereIsNoOtherLed) {
  LedLabels labels({"led"});
  TrackedLed jumped = at(0, 0.0);
  labels.update(kTime, {jumped});
  jumped.same_led_probability = 0.0;
  labels.update(kTime, {jumped});
  EXPECT_EQ(0.0, labels.of(0).confidence);
  labels.update(kTime, {at(0, 0.0, TrackState::kLost)});
  labels.update(kTime + 9.0, {at(1, 0.0)});
  EXPECT_EQ(0.0, labels.of(1).confidence);
  labels.update(kTime + 9.0, {at(1, 0.0, TrackState::kLost)});
  labels.update(kTime + 20.0, {});
  labels.update(kTime + 20.0, {at(2, 0.0)});
  EXPECT_EQ(1.0, labels.of(2).confidence);
}

TEST(LedLabels, AreRightWhereThereIsNoOtherLed) {
  LedLabels labels({"led"});
  labels.update(kTime, {at(0, 0.0)});
  labels.update(kTime, {at(0, 0.0, TrackState::kLost)});
  labels.update(kTime + 60.0, {});
  labels.update(kTime + 60.0, {at(1, 2.0)});
  EXPECT_EQ(1.0, labels.of(1).confidence);
}

TEST(LedLabels, AreWrongOnAnLedThatWasSeenBesideTheLostOne) {
  LedLabels labels({"led"});
  labels.update(kTime, {at(0, 0.0), at(1, 3.0)});
  labels.update(kTime + 1.0, {at(0, 0.0, TrackState::kLost), at(1, 0.1)});
  labels.update(kTime + 1.0, {at(1, 0.1)});
  EXPECT_EQ("led", labels.of(1).name);
  EXPECT_EQ(0.0, labels.of(1).confidence);
}

TEST(LedLabels, AreWrongAlsoOnTheNextLedThatWasSeenBesideTheLostOne) {
  LedLabels labels({"led"});
  labels.update(kTime, {at(0, 0.0), at(1, 3.0), at(2, 6.0)});
  labels.update(kTime, {at(0, 0.0, TrackState::kLost), at(1, 3.0), at(2, 6.0)});
  labels.update(kTime, {at(1, 3.0), at(2, 6.0)});
  labels.update(kTime, {at(1, 3.0, TrackState::kLost), at(2, 6.0)});
  labels.update(kTime, {at(2, 6.0)});
  EXPECT_EQ("led", labels.of(2).name);
  EXPECT_EQ(0.0, labels.of(2).confidence);
}

TEST(LedLabels, ReturnToWhereTheLedWasSeenNotToWhereItWasPredicted) {
  LedLabels labels({"a", "b"});
  labels.update(kTime, {at(0, 0.0), at(1, 2.0)});
  labels.update(kTime + 0.5, {at(0, 1.9, TrackState::kPredicted), at(1, 2.0)});
  const TrackState lost = TrackState::kLost;
  labels.update(kTime + 0.6, {at(0, 1.9, lost), at(1, 2.0, lost)});
  labels.update(kTime + 0.6, {});
  labels.update(kTime + 0.7, {at(2, 1.9)});
  EXPECT_EQ("b", labels.of(2).name);
}

TEST(LedLabels, StayDoubtfulWhenTheyAreGivenAgain) {
  LedLabels labels({"a", "b"});
  const TrackState lost = TrackState::kLost;
  labels.update(100.0, {at(0, 0.0), at(1, 2.0)});
  labels.update(100.0, {at(0, 0.0, lost), at(1, 2.0, lost)});
  labels.update(160.0, {});
  labels.update(160.0, {at(2, 0.0), at(3, 2.0)});
  EXPECT_NEAR(0.5, labels.of(2).confidence, 0.01);
  labels.update(160.0, {at(2, 0.0, lost), at(3, 2.0)});
  labels.update(160.0, {at(3, 2.0)});
  labels.update(160.1, {at(4, 0.0), at(3, 2.0)});
  EXPECT_EQ("a", labels.of(4).name);
  EXPECT_NEAR(0.5, labels.of(4).confidence, 0.1) << "it may still be b";
  EXPECT_TRUE(labels.doubtful().empty()) << "said when it became so";
  labels.forgetPlaces();
  labels.update(160.2, {at(4, 0.0), at(3, 2.0)});
  EXPECT_NEAR(0.5, labels.places().at("a").confidence, 0.1) << "whatever the world";
}

TEST(LedLabels, AreNamedAgainWhenTheyBecomeDoubtfulOnceMore) {
  LedLabels labels({"a", "b"});
  std::vector<TrackedLed> leds = {at(0, 0.0), at(1, 2.0)};
  labels.update(kTime, leds);
  for (const double time : {160.0, 220.0, 280.0}) {
    for (TrackedLed& led : leds)
      led.state = TrackState::kLost;
    labels.update(time - 60.0, leds);
    labels.update(time, {});
    EXPECT_TRUE(labels.doubtfulNow().empty()) << "dark";
    for (TrackedLed& led : leds)
      led = at(led.id + 2, led.position.x());
    labels.update(time, leds);
    EXPECT_EQ(2u, labels.doubtfulNow().size()) << time;
    EXPECT_EQ(2u, labels.doubtful().size()) << time;
    labels.update(time, leds);
    EXPECT_TRUE(labels.doubtful().empty()) << "said once";
  }
}

/// One camera sees LED `id` for 2 s from `start` on: blinking as word 0 of two, or steady.
void see(Identifier* identifier, std::uint32_t id, double start, bool steady) {
  for (double time = start; time < start + 2.0; time += 0.01) {
    const double phase = std::fmod((time - start) / 0.184, 1.0);
    identifier->add(id, {0, time, 0.0, steady || phase >= 0.125});  // 01111111
  }
}

TEST(LedLabels, AreDoubtfulAfterTheLedsMayHaveChangedPlaces) {
  LedLabels labels({"left", "right"});
  std::vector<TrackedLed> leds = {led(0, TrackState::kTracked), led(1, TrackState::kTracked)};
  leds[0].same_led_probability = 0.9;  // before it had a label
  labels.update(kTime, leds);
  EXPECT_TRUE(std::isnan(labels.of(0).confidence));
  leds[0].same_led_probability = 0.45;
  labels.update(kTime, leds);
  EXPECT_NEAR(0.5, labels.of(0).confidence, 1e-9);
  EXPECT_NEAR(0.5, labels.places().at("left").confidence, 1e-9) << "kept for a restart";
  EXPECT_EQ(std::vector<std::string>{"left"}, labels.doubtful());
  labels.update(kTime, {leds[0], led(1, TrackState::kLost)});
  EXPECT_TRUE(labels.doubtful().empty()) << "said once";
  labels.update(kTime, {leds[0], led(2, TrackState::kTracked)});
  EXPECT_EQ("right", labels.of(2).name) << "or the left one";
  EXPECT_NEAR(0.67, labels.of(2).confidence, 0.01);
}

TEST(LedLabels, KeepTheirDoubtBeforeAMaskedLamp) {
  const auto is_lamp = [](const Eigen::Vector3d& place) { return place.x() > 0.5; };
  LedLabels labels({"left", "right"});
  TrackedLed moving = led(0, TrackState::kTracked);
  labels.update(kTime, {moving, led(1, TrackState::kTracked)});
  moving.same_led_probability = 0.5;
  labels.update(kTime, {moving, led(1, TrackState::kTracked)});
  moving.position.x() = 1.0;
  labels.update(kTime, {moving, led(1, TrackState::kTracked)});
  labels.forgetLamps(is_lamp);
  moving.position.x() = 0.0;
  labels.update(kTime, {moving, led(1, TrackState::kTracked)});
  EXPECT_NEAR(0.5, labels.places().at("left").confidence, 1e-9);
}

TEST(LedLabels, ComeFromBlinking) {
  Identifier identifier(cyclicCodes({{"left", "01111111"}, {"right", "01010111"}}, 0.023, 0.001),
                        {});
  LedLabels labels({"lamp"});
  const std::vector<TrackedLed> both = {led(0, TrackState::kTracked), led(1, TrackState::kTracked)};
  labels.update(kTime, both, &identifier);
  EXPECT_EQ("led_0", labels.of(0).name) << "it may yet turn out to blink";
  EXPECT_FALSE(labels.of(0).identified);

  see(&identifier, 0, 100.0, true);
  see(&identifier, 1, 100.0, false);
  identifier.decide(102.0);
  labels.update(kTime, both, &identifier);
  EXPECT_EQ("lamp", labels.of(0).name) << "this one does not";
  EXPECT_FALSE(labels.of(0).identified);
  EXPECT_EQ("left", labels.of(1).name);
  EXPECT_GT(labels.of(1).confidence, 0.999);
  EXPECT_EQ(102.0, labels.of(1).since);

  // A label from blinking is kept in the dark, and in the message that reports the loss.
  labels.update(kTime, {led(1, TrackState::kPredicted)}, &identifier);
  EXPECT_EQ("left", labels.of(1).name);
  identifier.forget(1);
  labels.update(kTime, {led(1, TrackState::kLost)}, &identifier);
  EXPECT_EQ("left", labels.of(1).name);
}

TEST(LedLabels, FollowTheEvidence) {
  Identifier identifier(cyclicCodes({{"left", "01111111"}, {"right", "01010111"}}, 0.023, 0.001),
                        {});
  LedLabels labels({"lamp"});
  see(&identifier, 0, 100.0, true);
  identifier.decide(102.0);
  labels.update(kTime, {led(0, TrackState::kTracked)}, &identifier);
  EXPECT_EQ("lamp", labels.of(0).name);
  see(&identifier, 0, 102.0, false);  // it has begun to blink
  see(&identifier, 1, 102.0, true);
  identifier.decide(104.0);
  labels.update(kTime, {led(0, TrackState::kTracked), led(1, TrackState::kTracked)}, &identifier);
  EXPECT_EQ("left", labels.of(0).name);
  EXPECT_EQ("lamp", labels.of(1).name) << "free again";
  see(&identifier, 0, 104.0, true);  // and stops
  identifier.decide(106.0);
  labels.update(kTime, {led(0, TrackState::kTracked), led(1, TrackState::kTracked)}, &identifier);
  EXPECT_EQ("led_0", labels.of(0).name);
  EXPECT_EQ("lamp", labels.of(1).name);
}

TEST(LedLabels, MayAllComeFromIds) {
  LedLabels labels({});
  labels.update(kTime, {led(7, TrackState::kTracked)});
  EXPECT_EQ("led_7", labels.of(7).name);
}

}  // namespace
}  // namespace wiimote_tracker::identity
