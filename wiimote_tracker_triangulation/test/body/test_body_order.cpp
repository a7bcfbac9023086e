// Images of bodies that come late, twice, or with the time of another one.
#include "body/body_scene.h"
#include "body/body_tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

namespace wiimote_tracker::body {
namespace {

using test::fourLeds;
using test::handheld;
using test::pathsOf;
using tracking::test::paperRig;
using tracking::test::Scene;
using tracking::test::SceneImage;

tracking::test::SceneOptions sceneOptions() {
  tracking::test::SceneOptions options;
  options.pixel_noise = 0.5;
  return options;
}

TEST(BodyTracker, TheOrderOfArrivalDoesNotMatter) {
  tracking::test::SceneOptions options = sceneOptions();
  options.delay_jitter = 0.004;
  Scene scene(paperRig(), pathsOf(fourLeds(), handheld), options, 27);
  std::vector<SceneImage> images;
  for (int i = 0; i < 800; ++i)
    images.push_back(scene.next());
  BodyTracker as_arrived(paperRig(), {fourLeds()}, BodyTrackerOptions());
  for (const SceneImage& image : images)
    test::take(image, &as_arrived);
  const auto isEarlier = [](const auto& a, const auto& b) { return a.image.stamp < b.image.stamp; };
  EXPECT_FALSE(std::is_sorted(images.begin(), images.end(), isEarlier));
  std::sort(images.begin(), images.end(), isEarlier);
  BodyTracker in_order(paperRig(), {fourLeds()}, BodyTrackerOptions());
  for (const SceneImage& image : images)
    test::take(image, &in_order);
  ASSERT_TRUE(as_arrived.bodies()[0]);
  ASSERT_TRUE(in_order.bodies()[0]);
  EXPECT_EQ(as_arrived.bodies()[0]->world_from_body.matrix(),
            in_order.bodies()[0]->world_from_body.matrix());
  SceneImage old = images[400];
  as_arrived.take(old.camera, {}, &old.image);
  EXPECT_EQ(old.image.spots.size(), images[400].image.spots.size()) << "it is left alone";
}

TEST(BodyTracker, TwoImagesOfOneTimeMayComeInEitherOrder) {
  tracking::test::SceneOptions options = sceneOptions();
  options.synchronised = true;
  BodyTracker forth(paperRig(), {fourLeds()}, BodyTrackerOptions());
  BodyTracker back(paperRig(), {fourLeds()}, BodyTrackerOptions());
  Scene scene(paperRig(), pathsOf(fourLeds(), handheld), options, 30);
  for (int instant = 0; instant < 50; ++instant) {
    std::vector<SceneImage> images(4);
    for (SceneImage& image : images)
      image = scene.next();
    std::for_each(images.begin(), images.end(), [&](auto& image) { test::take(image, &forth); });
    std::for_each(images.rbegin(), images.rend(), [&](auto& image) { test::take(image, &back); });
  }
  ASSERT_TRUE(forth.bodies()[0]);
  ASSERT_TRUE(back.bodies()[0]);
  EXPECT_EQ(forth.bodies()[0]->world_from_body.matrix(),
            back.bodies()[0]->world_from_body.matrix());
}

/// Expects of two trackers of a moving body the same, bit for bit: one that gets each image once,
/// and one that gets what `more` gives it of the images so far.
void expectTheSame(const std::function<void(const std::vector<SceneImage>&, BodyTracker*)>& more) {
  Scene scene(paperRig(), pathsOf(fourLeds(), handheld), sceneOptions(), 3);
  BodyTracker plain(paperRig(), {fourLeds()}, BodyTrackerOptions());
  BodyTracker with_more(paperRig(), {fourLeds()}, BodyTrackerOptions());
  std::vector<SceneImage> images;
  for (int i = 0; i < 400; ++i) {
    images.push_back(scene.next());
    test::take(images.back(), &plain);
    more(images, &with_more);
    ASSERT_EQ(plain.bodies()[0].has_value(), with_more.bodies()[0].has_value()) << i;
    if (i < 100)
      continue;
    const BodyEstimate& a = plain.bodies()[0].value();
    const BodyEstimate& b = with_more.bodies()[0].value();
    ASSERT_EQ(a.world_from_body.matrix(), b.world_from_body.matrix()) << i;
    ASSERT_EQ(a.covariance, b.covariance) << i;
  }
}

TEST(BodyTracker, ARepeatedImageChangesNothing) {
  expectTheSame([](const auto& images, BodyTracker* tracker) {
    test::take(images.back(), tracker);
    test::take(images.back(), tracker);
  });
}

TEST(BodyTracker, OnlyTheLastImageOfABurstOfOneStampCounts) {
  expectTheSame([](const auto& images, BodyTracker* tracker) {
    if (images.size() > 4) {
      SceneImage mistimed = images[images.size() - 5];  // the same camera's
      EXPECT_EQ(mistimed.camera, images.back().camera);
      mistimed.image.stamp = images.back().image.stamp - 1e-6;
      test::take(mistimed, tracker);
    }
    test::take(images.back(), tracker);
  });
}

}  // namespace
}  // namespace wiimote_tracker::body
