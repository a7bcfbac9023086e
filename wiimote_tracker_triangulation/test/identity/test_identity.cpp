// Labels of blinking LEDs: when they are given, kept, changed and refused.
#include "allocation_counter.h"
#include "identity/blinking.h"
#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/identity/identifier.h"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

namespace wiimote_tracker::identity {
namespace {

using geometry::test::Random;
using test::BlinkingOptions;
using test::fourWords;
using test::LedSighting;
using test::paperCodes;

/// Blinking LEDs whose sightings go to an Identifier.
class Blinking {
 public:
  Blinking(const BlinkingOptions& options, unsigned seed)
      : options_(options), random_(seed), identifier_(options.codes, {}) {}

  /// Continues for `duration` [s]; calls `look` after every decision.
  template <typename Look>
  void run(double duration, Look look) {
    options_.duration = duration;
    for (const LedSighting& s : test::simulateBlinking(options_, &random_)) {
      identifier_.add(static_cast<std::uint32_t>(s.led), s.sighting);
      identifier_.decide(s.sighting.time);
      look(s.sighting.time);
    }
    options_.start += duration;
  }
  void run(double duration) {
    run(duration, [](double) {});
  }

  std::optional<std::size_t> labelOf(std::uint32_t led) const {
    return identifier_.identityOf(led)->label;
  }

  BlinkingOptions& options() { return options_; }
  Identifier& identifier() { return identifier_; }

 private:
  BlinkingOptions options_;
  Random random_;
  Identifier identifier_;
};

BlinkingOptions cyclicOptions(const std::vector<std::size_t>& leds, std::size_t cameras) {
  BlinkingOptions options;
  options.codes = fourWords();
  options.period = 0.184;
  options.leds = leds;
  options.cameras = cameras;
  options.drop = 0.02;
  options.flip = 0.01;
  return options;
}

TEST(Identifier, LabelsComeWithConfidenceAndTime) {
  Blinking blinking(cyclicOptions({3, 1, 0, 2}, 2), 1);
  EXPECT_EQ(nullptr, blinking.identifier().identityOf(0));
  blinking.run(0.05);
  for (std::uint32_t led = 0; led < 4; ++led)
    EXPECT_FALSE(blinking.labelOf(led));
  blinking.run(0.5);
  for (std::uint32_t led = 0; led < 4; ++led) {
    const Identity identity = *blinking.identifier().identityOf(led);
    EXPECT_EQ(blinking.options().leds[led], identity.label);
    EXPECT_GT(identity.confidence, 0.999);
    EXPECT_GT(identity.since, 1000.05);
    EXPECT_LT(identity.since, 1000.5);
  }
}

TEST(Identifier, ALightThatDoesNotBlinkHasNoLabel) {
  Blinking blinking(cyclicOptions({7, 1}, 1), 2);
  blinking.run(2.0, [&](double) { EXPECT_FALSE(blinking.labelOf(0)); });
  EXPECT_TRUE(blinking.identifier().identityOf(0)->steady);
  EXPECT_LT(blinking.identifier().identityOf(0)->since, 1001.0) << "of the first decision";
  EXPECT_EQ(1u, blinking.labelOf(1));
  EXPECT_FALSE(blinking.identifier().identityOf(1)->steady);
}

TEST(Identifier, LabelsChangeOnlyOnEvidence) {
  Blinking blinking(cyclicOptions({1}, 2), 3);
  blinking.run(1.0);
  ASSERT_EQ(1u, blinking.labelOf(0));
  const double since = blinking.identifier().identityOf(0)->since;
  blinking.options().flip = 0.1;
  blinking.run(1.0, [&](double) { EXPECT_EQ(1u, blinking.labelOf(0)); });
  EXPECT_EQ(since, blinking.identifier().identityOf(0)->since);
  // The track has switched to another LED.
  blinking.options().flip = 0.01;
  blinking.options().leds = {2};
  blinking.run(0.1, [&](double) { EXPECT_EQ(1u, blinking.labelOf(0)); });
  blinking.run(2.9);
  EXPECT_EQ(2u, blinking.labelOf(0));
  EXPECT_GT(blinking.identifier().identityOf(0)->since, 1002.1);
}

TEST(Identifier, OcclusionIsNotDarkness) {
  // Camera 1 sees the LED only once; camera 0 misses it for 0.3 s of each second.
  Blinking blinking(cyclicOptions({2}, 2), 4);
  blinking.options().hidden = [](std::size_t camera, std::size_t, double time) {
    return camera == 1 || std::fmod(time, 1.0) > 0.7;
  };
  blinking.identifier().add(0, {1, 1000.0, 0.001, true});
  blinking.run(5.6, [&](double time) {
    if (time > 1000.5) {
      EXPECT_EQ(2u, blinking.labelOf(0)) << time;
    }
  });
}

TEST(Identifier, TheFirstOfTwoEqualLedsKeepsTheLabel) {
  Blinking blinking(cyclicOptions({1}, 2), 5);
  blinking.run(0.5);
  ASSERT_EQ(1u, blinking.labelOf(0));
  blinking.options().leds = {1, 1};  // the second is its mirror image
  blinking.run(2.0, [&](double) {
    EXPECT_EQ(1u, blinking.labelOf(0));
    if (blinking.identifier().identityOf(1)) {
      EXPECT_FALSE(blinking.labelOf(1));
    }
  });
  // When the first is gone, the label is free.
  blinking.identifier().forget(0);
  EXPECT_EQ(nullptr, blinking.identifier().identityOf(0));
  blinking.identifier().decide(blinking.options().start + 0.1);
  EXPECT_EQ(1u, blinking.labelOf(1));
}

TEST(Identifier, AfterAResetTimeMayBeEarlier) {
  Blinking blinking(cyclicOptions({1}, 2), 6);
  blinking.run(0.5);
  blinking.identifier().reset();
  EXPECT_EQ(nullptr, blinking.identifier().identityOf(0));
  // Sightings with later times are no evidence.
  blinking.options().start = 800.0;
  blinking.options().leds = {2};
  blinking.run(2.0);
  EXPECT_EQ(2u, blinking.labelOf(0));
}

TEST(Identifier, ANewLedInheritsNothing) {
  Blinking blinking(cyclicOptions({1}, 2), 9);
  blinking.run(0.5);
  ASSERT_EQ(1u, blinking.labelOf(0));
  Identifier& identifier = blinking.identifier();
  identifier.forget(0);
  identifier.add(5, {0, 1000.5, 0.001, true});
  EXPECT_FALSE(identifier.identityOf(5)->label);
  identifier.decide(1000.6);
  EXPECT_FALSE(identifier.identityOf(5)->label);
}

TEST(Identifier, RespectsTheIntervalOfDecisions) {
  BlinkingOptions options = cyclicOptions({1}, 2);
  options.duration = 0.5;
  Random random(10);
  IdentifierOptions seldom;
  seldom.interval = 0.9;
  Identifier identifier(options.codes, seldom);
  identifier.decide(options.start);
  for (const LedSighting& s : test::simulateBlinking(options, &random))
    identifier.add(0, s.sighting);
  identifier.decide(options.start + 0.6);
  EXPECT_FALSE(identifier.identityOf(0)->label);
  identifier.decide(options.start + 0.95);
  EXPECT_EQ(1u, identifier.identityOf(0)->label);
}

TEST(Identifier, ThePapersSchemeWithSomeInView) {
  BlinkingOptions options = cyclicOptions({2, 0}, 2);
  options.codes = paperCodes(0.11, 0.25);
  options.period = 0.16;
  Blinking blinking(options, 7);
  blinking.run(1.0);
  EXPECT_EQ(2u, blinking.labelOf(0));
  EXPECT_EQ(0u, blinking.labelOf(1));
}

TEST(Identifier, RefusesToWorkWithoutCodes) {
  EXPECT_THROW(Identifier(BlinkCodes(), {}), Error);
}

TEST(NoAllocation, OnceWarm) {
  for (const bool synchronous : {false, true}) {
    BlinkingOptions options = cyclicOptions({0, 1, 2, 3}, 3);
    if (synchronous)
      options.codes = paperCodes(0.12, 0.16);
    options.period = 0.14;
    options.duration = 1.5;
    Random random(8);
    const std::vector<LedSighting> sightings = test::simulateBlinking(options, &random);
    Identifier identifier(options.codes, {});
    int before = 0;
    for (std::size_t i = 0; i < sightings.size(); ++i) {
      if (i == sightings.size() / 2) {
        identifier.forget(0);
        before = g_allocations;
      }
      identifier.add(static_cast<std::uint32_t>(sightings[i].led), sightings[i].sighting);
      identifier.decide(sightings[i].sighting.time);
    }
    EXPECT_EQ(before, g_allocations);
    EXPECT_GT(before, 0);
  }
}

}  // namespace
}  // namespace wiimote_tracker::identity
