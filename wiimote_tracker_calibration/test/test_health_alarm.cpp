// When a finding begins and ends, and that of another device.
#include "expect_says.h"
#include "simulated_rig.h"

#include "health/alarm.h"
#include "health/health_watch.h"

#include <gtest/gtest.h>

namespace wiimote_tracker::health {
namespace {

using square::Random;

TEST(Alarm, DoesNotFlap) {
  Alarm alarm;
  int changes = 0;
  bool on = false;
  const auto judge = [&](double ratio) {
    alarm.judge(ratio);
    changes += alarm.on() != on;
    on = alarm.on();
  };
  // What wavers about the limit begins once.
  for (int i = 0; i < 50; ++i)
    judge(i % 3 == 0 ? 0.9 : 1.1);
  EXPECT_TRUE(on);
  EXPECT_EQ(changes, 1);
  // Single judgements that all is well are not believed, two are.
  judge(0.1);
  EXPECT_TRUE(on);
  judge(0.9);
  judge(0.1);
  EXPECT_TRUE(on);
  judge(0.1);
  EXPECT_FALSE(on);
  judge(1.5);
  EXPECT_FALSE(on);
}

TEST(HealthWatch, NoticesAnotherDevice) {
  Random random(32);
  const geometry::Rig rig = paperRigWith(calibratedByWave());
  HealthWatch watch(rig, {});
  capture::Image image;
  image.camera = "camera_2";
  const auto addFrom = [&](const char* device) {
    image.identity = device;
    watch.addImage(image);
  };
  addFrom("");
  EXPECT_TRUE(watch.takeNews().empty());
  addFrom("00:1e:35:ff:ff:ff");
  addFrom("00:1e:35:ff:ff:ff");
  const auto news = watch.takeNews();
  ASSERT_EQ(news.size(), 1u);
  EXPECT_SAYS(news.front(), "camera_2 is another device (00:1e:35:ff:ff:ff)");
  addFrom("00:1e:35:00:00:02");
  EXPECT_EQ(watch.healths().at("camera_2").text, "");
  // Cameras that are not in the rig are nobody's concern.
  image.camera = "elsewhere";
  addFrom("x");
  watch.addAcceleration("elsewhere", 0.0, {0.0, 0.0, 9.81});
  EXPECT_EQ(watch.healths().size(), 4u);
}

}  // namespace
}  // namespace wiimote_tracker::health
