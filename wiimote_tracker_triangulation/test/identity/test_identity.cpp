// Which LED is which: against an exhaustive computation, by counting errors, and in odd situations.
#include "allocation_counter.h"
#include "identity/blinking.h"
#include "identity/exhaustive_labels.h"
#include "tracking/scene.h"
#include "wiimote_tracker_triangulation/identity/blinking_tracks.h"
#include "wiimote_tracker_triangulation/identity/error.h"
#include "wiimote_tracker_triangulation/identity/identifier.h"
#include "wiimote_tracker_triangulation/identity/schemes.h"
#include "wiimote_tracker_triangulation/identity/snapshot_sightings.h"
#include "wiimote_tracker_triangulation/tracking/tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace wiimote_tracker::identity {
namespace {

using geometry::test::Random;
using test::BlinkingOptions;
using test::LedSighting;

BlinkCodes paperCodes(double shortest, double longest) {
  return dutyCodes({{"a", 0.9}, {"b", 0.6}, {"c", 0.4}, {"d", 0.2}}, shortest, longest);
}

BlinkCodes fourWords() {
  std::vector<CyclicLed> leds;
  for (const std::string& word : chooseWords(4))
    leds.push_back({"led_" + std::to_string(leds.size()), word});
  return cyclicCodes(leds, 0.023, 0.0);
}

Eigen::MatrixXd posteriorOf(const Hypotheses& hypotheses,
                            const std::vector<LedSighting>& sightings,
                            std::size_t leds,
                            double origin) {
  std::vector<Evidence> evidence(leds, Evidence(hypotheses));
  std::vector<const Evidence*> pointers;
  for (Evidence& led : evidence) {
    led.reset(origin);
    pointers.push_back(&led);
  }
  for (const LedSighting& s : sightings)
    evidence[s.led].add(s.sighting);
  return LabelPosterior(hypotheses, 0.01).compute(pointers);
}

/// Largest difference of the probabilities to those of the exhaustive computation in some runs.
/// @param raster on which the times of sightings lie [s]; 0: anywhere.
double errorAgainstExhaustive(BlinkingOptions options, int runs, double raster) {
  const Hypotheses hypotheses(options.codes, {}, 1.0);
  test::ExhaustiveLabels exhaustive;
  exhaustive.codes = options.codes;
  exhaustive.memory = hypotheses.memory();
  exhaustive.exposure = options.exposure;
  exhaustive.phases = static_cast<int>(hypotheses.phases());
  exhaustive.phase_doubt = 1.0 / static_cast<double>(hypotheses.phases());
  if (hypotheses.frequencies().size() > 1)
    exhaustive.phase_doubt += 0.03;
  for (const double frequency : hypotheses.frequencies())
    exhaustive.periods.push_back(1.0 / frequency);
  double error = 0.0;
  for (int run = 0; run < runs; ++run) {
    Random random(static_cast<unsigned>(100 + run));
    std::vector<LedSighting> sightings = test::simulateBlinking(options, &random);
    if (raster > 0.0) {
      for (LedSighting& s : sightings)
        s.sighting.time = raster * (std::floor(s.sighting.time / raster) + 0.5);
    }
    const Eigen::MatrixXd ours =
        posteriorOf(hypotheses, sightings, options.leds.size(), options.start);
    const Eigen::MatrixXd theirs = exhaustive.posterior(sightings, options.leds.size());
    EXPECT_NEAR(1.0, ours.col(0).sum(), 1e-6);
    error = std::max(error, (ours - theirs).cwiseAbs().maxCoeff());
  }
  return error;
}

TEST(LabelPosterior, EachForItselfIsAsTheExhaustiveComputation) {
  BlinkingOptions options;
  options.codes = fourWords();
  options.period = 0.184;
  options.leds = {2, 3, 9};  // the last does not blink
  options.cameras = 2;
  options.start = 0.0;
  options.exposure = options.period / 32.0;
  options.drop = 0.05;
  options.flip = 0.03;
  // Phases are rounded to a quarter of the grid's step, 32 of them here, and exposures to a 32nd of
  // the period. These need no rounding.
  const double raster = options.period / (4 * 32);
  ASSERT_EQ(32u, Hypotheses(options.codes, {}, 1.0).phases());
  double error = 0.0;
  for (const double duration : {0.06, 0.12, 0.2}) {
    options.duration = duration;
    error = std::max(error, errorAgainstExhaustive(options, 10, raster));
  }
  EXPECT_LT(error, 1e-3);
}

TEST(LabelPosterior, TogetherIsAsTheExhaustiveComputation) {
  BlinkingOptions options;
  options.codes = paperCodes(0.125, 0.137);
  options.period = 0.131;
  options.leds = {0, 1, 2, 3};
  options.start = 0.0;
  options.drop = 0.05;
  options.flip = 0.03;
  options.duration = 0.15;
  const double four = errorAgainstExhaustive(options, 3, 0.0);
  options.leds = {2, 0, 7};
  options.cameras = 2;
  const double some = errorAgainstExhaustive(options, 3, 0.0);
  options.leds = {1};
  const double one = errorAgainstExhaustive(options, 3, 0.0);
  // With many periods phases must be rounded.
  EXPECT_LT(four, 0.1);
  EXPECT_LT(some, 0.1);
  EXPECT_LT(one, 0.1);
}

/// Runs whose likeliest labels are not all right.
int wrongRuns(const BlinkingOptions& options, const Hypotheses& hypotheses, int runs) {
  int wrong_runs = 0;
  for (int run = 0; run < runs; ++run) {
    Random random(static_cast<unsigned>(run));
    const Eigen::MatrixXd posterior = posteriorOf(
        hypotheses, test::simulateBlinking(options, &random), options.leds.size(), options.start);
    bool wrong = false;
    for (std::size_t led = 0; led < options.leds.size(); ++led) {
      Eigen::Index label = 0;
      posterior.col(static_cast<Eigen::Index>(led)).maxCoeff(&label);
      wrong |= static_cast<std::size_t>(label) != options.leds[led];
    }
    wrong_runs += wrong;
  }
  return wrong_runs;
}

/// More than this happen by chance in one test of a thousand, when `expected` do on average.
int poissonBound(double expected) {
  double term = std::exp(-expected);
  double sum = term;
  int count = 0;
  while (sum < 0.999) {
    term *= expected / ++count;
    sum += term;
  }
  return count;
}

TEST(LabelPosterior, ThePapersSchemeIsReadWithinTwoPeriods) {
  BlinkingOptions options;
  options.codes = paperCodes(0.11, 0.25);
  options.leds = {0, 1, 2, 3};
  options.drop = 0.05;
  options.flip = 0.01;
  const Hypotheses hypotheses(options.codes, {}, 1.0);
  constexpr int kRuns = 40;
  int wrong = 0, runs = 0;
  for (const std::size_t cameras : {1, 3}) {
    for (const double period : {0.11, 0.12, 0.137, 0.2}) {
      options.cameras = cameras;
      options.period = period;
      options.duration = 2.0 * period;
      wrong += wrongRuns(options, hypotheses, kRuns);
      runs += kRuns;
    }
  }
  EXPECT_LE(wrong, poissonBound(0.001 * runs));
}

TEST(LabelPosterior, CyclicCodesAreReadIn200And400Milliseconds) {
  BlinkingOptions options;
  options.codes = fourWords();
  options.period = 0.184;
  options.flip = 0.01;
  const Hypotheses hypotheses(options.codes, {}, 1.0);
  constexpr int kRuns = 500;
  int wrong_200 = 0, wrong_400 = 0;
  for (std::size_t led = 0; led < 4; ++led) {
    options.leds = {led};
    options.duration = 0.2;
    wrong_200 += wrongRuns(options, hypotheses, kRuns);
    options.duration = 0.4;
    wrong_400 += wrongRuns(options, hypotheses, kRuns);
  }
  EXPECT_LE(wrong_200, poissonBound(0.003 * 4 * kRuns));
  EXPECT_LE(wrong_400, poissonBound(0.0003 * 4 * kRuns));
}

/// LEDs that blink before an Identifier, from time to time looked at.
class Blinking {
 public:
  Blinking(const BlinkingOptions& options, unsigned seed)
      : options_(options), random_(seed), identifier_(options.codes, {}) {}

  /// Goes on for `duration` [s]; calls `look` after every decision.
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
  EXPECT_EQ(1u, blinking.labelOf(1));
  EXPECT_FALSE(blinking.identifier().identityOf(1)->steady);
}

TEST(Identifier, TheMindIsChangedOnlyOnEvidence) {
  Blinking blinking(cyclicOptions({1}, 2), 3);
  blinking.run(1.0);
  ASSERT_EQ(1u, blinking.labelOf(0));
  const double since = blinking.identifier().identityOf(0)->since;
  blinking.options().flip = 0.1;
  blinking.run(1.0, [&](double) { EXPECT_EQ(1u, blinking.labelOf(0)); });
  EXPECT_EQ(since, blinking.identifier().identityOf(0)->since);
  // The track has gone over to another LED.
  blinking.options().flip = 0.01;
  blinking.options().leds = {2};
  blinking.run(0.1, [&](double) { EXPECT_EQ(1u, blinking.labelOf(0)); });
  blinking.run(2.9);
  EXPECT_EQ(2u, blinking.labelOf(0));
  EXPECT_GT(blinking.identifier().identityOf(0)->since, 1002.1);
}

TEST(Identifier, SomethingInTheWayIsNotDarkness) {
  // One camera sees the LED once and never again, the other one not for a while, now and then.
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

TEST(Identifier, TheFirstOfTwoAlikeKeepsTheLabel) {
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

TEST(Identifier, TimeMayJumpBack) {
  Blinking blinking(cyclicOptions({1}, 2), 6);
  blinking.run(0.5);
  blinking.options().start = 900.0;
  blinking.run(2.0, [&](double) { EXPECT_EQ(1u, blinking.labelOf(0)); });
  EXPECT_GT(blinking.identifier().identityOf(0)->confidence, 0.999);
  blinking.identifier().reset();
  EXPECT_EQ(nullptr, blinking.identifier().identityOf(0));
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

TEST(Identifier, OptionsOutOfRangeAreRefused) {
  IdentifierOptions options;
  options.decide_at = 0.3;
  EXPECT_THROW(Identifier(fourWords(), options), IdentityError);
  options = {};
  options.seeing.seen_when_off = 0.0;
  EXPECT_THROW(Identifier(fourWords(), options), IdentityError);
  options = {};
  options.memory = std::nan("");
  EXPECT_THROW(Identifier(fourWords(), options), IdentityError);
  EXPECT_THROW(Identifier(BlinkCodes(), {}), IdentityError);
}

/// Two cameras that look at the origin, and one that looks away.
geometry::Rig threeCameras() {
  geometry::Rig rig;
  for (const Eigen::Vector3d& position :
       {Eigen::Vector3d(3, 0, 0), Eigen::Vector3d(0, 3, 0), Eigen::Vector3d(-3, 0, 0)}) {
    geometry::RigCamera camera;
    camera.camera.name = "camera_" + std::to_string(rig.cameras.size());
    const Eigen::Vector3d target =
        position.x() < 0 ? Eigen::Vector3d(-6, 0, 0) : Eigen::Vector3d(0, 0, 0);
    camera.camera.world_from_camera = geometry::lookAt(position, target, {0, 0, 1});
    rig.cameras.push_back(camera);
  }
  return rig;
}

class Sightings : public testing::Test {
 protected:
  Sightings() {
    snapshot_.time = 10.0;
    snapshot_.views.resize(3);
    for (tracking::CameraView& view : snapshot_.views)
      view.time = 9.995;
    tracking::TrackedLed led;
    led.id = 7;
    led.state = tracking::TrackState::kPredicted;
    snapshot_.leds.push_back(led);
  }

  void see(std::size_t camera, const Eigen::Vector2d& offset, std::optional<std::uint32_t> led) {
    tracking::SeenSpot spot;
    spot.pixel = *rig_.cameras[camera].camera.project(Eigen::Vector3d::Zero()) + offset;
    spot.use = led ? tracking::SpotUse::kAssigned : tracking::SpotUse::kUnassigned;
    spot.led = led.value_or(0);
    snapshot_.views[camera].spots.push_back(spot);
  }

  /// Per camera: s(een), u(nseen), or nothing.
  std::string collect() {
    std::string text;
    for (const TrackSighting& s : sightings_.collect(rig_, snapshot_)) {
      EXPECT_EQ(7u, s.led);
      EXPECT_EQ(9.995, s.sighting.time);
      EXPECT_EQ(0.002, s.sighting.exposure);
      text += (s.sighting.seen ? "s" : "u") + std::to_string(s.sighting.camera);
    }
    return text;
  }

  geometry::Rig rig_ = threeCameras();
  tracking::Snapshot snapshot_;
  SnapshotSightings sightings_{{0.002, 24.0}};
};

TEST_F(Sightings, SeenAndNotSeenByThoseThatLookThere) {
  see(0, {0, 0}, 7);
  see(1, {100, 0}, 8);
  EXPECT_EQ("s0u1", collect());
  EXPECT_EQ("", collect()) << "the same images again";
}

TEST_F(Sightings, AnImageThatNeedNotShowItSaysNothing) {
  see(0, {9, 0}, 8);               // perhaps both in one spot
  snapshot_.views[1].full = true;  // perhaps crowded out
  EXPECT_EQ("", collect());
}

TEST_F(Sightings, ASpotThatMayBeAnotherLedsSaysNothing) {
  see(0, {9, 0}, 7);
  tracking::TrackedLed other = snapshot_.leds[0];
  other.id = 8;
  snapshot_.leds.push_back(other);
  snapshot_.views[1].time.reset();
  EXPECT_EQ("", collect()) << "either LED's light";
  snapshot_.views[0].time = 9.996;
  snapshot_.leds[1].state = tracking::TrackState::kTentative;
  EXPECT_EQ(1u, sightings_.collect(rig_, snapshot_).size())
      << "not that of one that is not believed";
}

TEST_F(Sightings, WhereLightIsIgnoredNothingIsSeen) {
  rig_.cameras[1].masks.push_back({*rig_.cameras[1].camera.project(Eigen::Vector3d::Zero()), 20.0});
  EXPECT_EQ("u0", collect());
}

TEST_F(Sightings, LostLedsAreForgotten) {
  see(0, {0, 0}, 7);
  Identifier identifier(fourWords(), {});
  sightings_.add(rig_, snapshot_, &identifier);
  EXPECT_NE(nullptr, identifier.identityOf(7));
  snapshot_.leds[0].state = tracking::TrackState::kLost;
  snapshot_.time += 0.01;
  snapshot_.views[0].time = 10.005;
  sightings_.add(rig_, snapshot_, &identifier);
  EXPECT_EQ(nullptr, identifier.identityOf(7));
}

/// An LED with a label of the codes, among the first `cameras` of the paper's rig: how often it was
/// tracked, under which ids, and what it was called in the end.
struct Followed {
  std::set<std::uint32_t> ids;
  std::size_t tracked = 0, predicted = 0, lost = 0;
  std::optional<std::size_t> label;
};

Followed follow(const BlinkCodes& codes, double period, std::size_t label, std::size_t cameras) {
  tracking::test::SceneOptions scene_options;
  scene_options.dropout = 0.02;
  scene_options.hidden = [&](std::size_t, std::size_t, double time) {
    return litShare(codes.codes[label].waveform, (time - 0.0005) / period, 0.001 / period) < 0.5;
  };
  geometry::Rig rig = tracking::test::paperRig();
  rig.cameras.resize(cameras);
  tracking::test::Scene scene(rig, {tracking::test::still({1.2, 1.3, 1.0})}, scene_options, 5);
  tracking::Tracker tracker(rig, forBlinking(codes, tracking::TrackerOptions()));
  Identifier identifier(codes, {});
  SnapshotSightings sightings({});
  Followed followed;
  while (true) {
    const tracking::test::SceneImage& image = scene.next();
    if (image.true_time > scene_options.start + 4.0)
      return followed;
    tracker.add(image.camera, image.image);
    while (const tracking::Snapshot* snapshot = tracker.next()) {
      sightings.add(rig, *snapshot, &identifier);
      for (const tracking::TrackedLed& led : snapshot->leds) {
        followed.tracked += led.state == tracking::TrackState::kTracked;
        followed.predicted += led.state == tracking::TrackState::kPredicted;
        followed.lost += led.state == tracking::TrackState::kLost && followed.ids.count(led.id);
        if (led.state == tracking::TrackState::kTracked)
          followed.ids.insert(led.id);
        if (identifier.identityOf(led.id))
          followed.label = identifier.identityOf(led.id)->label;
      }
    }
  }
}

TEST(BlinkingTracks, LiveThroughDarkness) {
  const BlinkCodes paper = paperCodes(0.11, 0.25);
  const BlinkCodes words = fourWords();
  for (const std::size_t cameras : {2, 4}) {
    for (std::size_t label = 0; label < 4; ++label) {
      const Followed blinks = follow(words, 0.184, label, cameras);
      EXPECT_EQ(1u, blinks.ids.size()) << "word " << label << ", cameras " << cameras;
      EXPECT_EQ(0u, blinks.lost);
      EXPECT_GT(blinks.predicted, 0u) << "it is dark for longer than an image";
      EXPECT_EQ(label, blinks.label);
      const Followed together = follow(paper, 0.15, label, cameras);
      EXPECT_EQ(0u, together.lost);
      EXPECT_EQ(1u, together.ids.size()) << "share " << label << ", cameras " << cameras;
      EXPECT_EQ(label, together.label) << "cameras " << cameras;
    }
  }
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
