#include "capture/mask_learner.h"
#include "capture/masks.h"

#include "expect_says.h"

#include <gtest/gtest.h>

#include <random>

namespace wiimote_tracker::capture {
namespace {

Image image(const Blobs& spots) {
  return {"a", 0.0, 0, spots, {}};
}

TEST(MaskLearner, StillAndFlickeringLampsAreMaskedWithAllTheirPlaces) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 1.0);
  std::bernoulli_distribution flicker(0.1);
  MaskLearner learner({"a", "blind"}, MaskOptions());
  Blobs all;
  for (int i = 0; i < 400; ++i) {
    Blobs spots = {{100.0 + noise(random), 100.0 + noise(random)}};
    if (flicker(random))
      spots.emplace_back(700.0 + noise(random), 500.0 + noise(random));
    all.insert(all.end(), spots.begin(), spots.end());
    learner.add(image(spots));
  }
  const auto result = learner.result();
  const LearnedMasks& learned = result.at("a");
  EXPECT_TRUE(learned.problem.empty()) << learned.problem;
  ASSERT_EQ(learned.masks.size(), 2U);
  for (const Eigen::Vector2d& spot : all)
    EXPECT_TRUE(geometry::isMasked(learned.masks, spot));
  for (const geometry::ImageMask& mask : learned.masks) {
    EXPECT_GT(mask.radius, 8.0);
    EXPECT_LT(mask.radius, 20.0);
  }
  EXPECT_SAYS(result.at("blind").problem, "sends no images");
}

TEST(MaskLearner, MasksFromBeforeDoNotHideWhatIsThere) {
  MaskLearner learner({"a"}, MaskOptions());
  for (int i = 0; i < 100; ++i)
    learner.add({"a", 0.0, 0, {}, {{100.0, 100.0}}});
  EXPECT_EQ(learner.result().at("a").masks.size(), 1U);
}

TEST(MaskLearner, AFlashIsNoLamp) {
  MaskLearner learner({"a"}, MaskOptions());
  for (int i = 0; i < 400; ++i)
    learner.add(image(i % 200 == 7 ? Blobs{{300.0, 300.0}} : Blobs{}));
  EXPECT_TRUE(learner.result().at("a").masks.empty());
  EXPECT_TRUE(learner.result().at("a").problem.empty());
}

TEST(MaskLearner, AnLedThatIsCarriedAboutIsToldToBeSwitchedOff) {
  MaskLearner learner({"a"}, MaskOptions());
  for (int i = 0; i < 400; ++i)
    learner.add(image({{100.0 + 2.0 * i, 300.0}, {50.0, 50.0}}));
  EXPECT_SAYS(learner.result().at("a").problem, "sees a light that moves");
  EXPECT_TRUE(learner.result().at("a").masks.empty());
}

TEST(MaskLearner, AFewImagesSayNothing) {
  MaskLearner learner({"a"}, MaskOptions());
  for (int i = 0; i < 10; ++i)
    learner.add(image({{100.0, 100.0}}));
  EXPECT_SAYS(learner.result().at("a").problem, "10 images only");
}

TEST(Masks, AMaskedSpotIsSetAsideInItsOwnCameraOnly) {
  const Masks masks = {{"a", {{{100.0, 100.0}, 10.0}}}};
  Image own = image({{105.0, 105.0}, {300.0, 300.0}, {100.0, 110.5}});
  Image other = own;
  other.camera = "b";
  applyMasks(masks, &own);
  applyMasks(masks, &other);
  EXPECT_EQ(own.spots, Blobs({{300.0, 300.0}, {100.0, 110.5}}));
  EXPECT_EQ(own.masked, Blobs({{105.0, 105.0}}));
  EXPECT_EQ(other.spots.size(), 3U);
  EXPECT_TRUE(other.masked.empty());
}

}  // namespace
}  // namespace wiimote_tracker::capture
