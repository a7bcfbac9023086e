// Lights in the virtual remote's camera, in raw bytes.
#include "virtual_remote_bytes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace wiimote_tracker::virtual_wiimote {
namespace {

struct Level {
  const char* name;
  Bytes block1;
  Bytes block2;
  /// Largest distance at which a sensor bar is seen [m]: 6 sqrt(99 * 3 / (GAINLIMIT * max(MINSIZE,
  /// 1))).
  double reach;
};

const std::vector<Level> kLevels{
    {"1", {0x02, 0, 0, 0x71, 0x01, 0, 0x64, 0, 0xfe}, {0xfd, 0x05}, 2.907},
    {"2", {0x02, 0, 0, 0x71, 0x01, 0, 0x96, 0, 0xb4}, {0xb3, 0x04}, 3.864},
    {"3", {0x02, 0, 0, 0x71, 0x01, 0, 0xaa, 0, 0x64}, {0x63, 0x03}, 6.000},
    {"4", {0x02, 0, 0, 0x71, 0x01, 0, 0xc8, 0, 0x36}, {0x35, 0x03}, 8.200},
    {"5", {0x07, 0, 0, 0x71, 0x01, 0, 0x72, 0, 0x20}, {0x1f, 0x03}, 10.722},
    {"most", {0, 0, 0, 0, 0, 0, 0x90, 0, 0x41}, {0x40, 0x00}, 12.925},
};

constexpr std::size_t kMiddle = 2;

/// A remote that looks with that sensitivity and reports extended infrared.
class Camera {
 public:
  explicit Camera(const Level& level, const Device::Options& options = Device::Options())
      : device_(options) {
    std::vector<Bytes> outputs = handshake();
    outputs[3] = write(0x04, {0xb0, 0x00, 0x00}, level.block1);
    outputs[4] = write(0x04, {0xb0, 0x00, 0x1a}, level.block2);
    for (const Bytes& output : outputs)
      device_.handleOutput(output);
  }

  struct Spot {
    std::size_t slot;
    int x;
    int y;
    int size;
  };

  std::vector<Spot> see(const std::vector<Light>& seen) {
    const Bytes report = *device_.sample(lights(seen));
    std::vector<Spot> spots;
    for (std::size_t slot = 0; slot < 4; ++slot) {
      const int b0 = report[6 + 3 * slot];
      const int b1 = report[7 + 3 * slot];
      const int b2 = report[8 + 3 * slot];
      const int x = b0 + (b2 / 16 % 4) * 256;
      const int y = b1 + (b2 / 64) * 256;
      if (y < 768 && b0 + b1 + b2 > 0)
        spots.push_back({slot, x, y, b2 % 16});
    }
    return spots;
  }

 private:
  Device device_;
};

/// The Wii's sensor bar at this distance [m].
Light barAt(double distance) {
  Light light;
  light.x = 200.0;
  light.y = 300.0;
  light.brightness = 1.0 / (distance * distance);
  return light;
}

TEST(Sensitivity, DecidesHowFarALightIsSeen) {
  for (const Level& level : kLevels) {
    EXPECT_EQ(1u, Camera(level).see({barAt(0.99 * level.reach)}).size()) << level.name;
    EXPECT_EQ(0u, Camera(level).see({barAt(1.01 * level.reach)}).size()) << level.name;
  }
}

TEST(Sensitivity, IsTakenFromTheRegistersAtOnce) {
  Device device;
  for (const Bytes& output : handshake())
    device.handleOutput(output);
  const Senses senses = lights({barAt(9.0)});
  const Bytes report = *device.sample(senses);
  EXPECT_EQ(Bytes(12, 0x00), Bytes(report.begin() + 6, report.end())) << "too far for the middle";
  device.handleOutput(write(0x04, {0xb0, 0x00, 0x00}, kLevels[4].block1));
  device.handleOutput(write(0x04, {0xb0, 0x00, 0x1a}, kLevels[4].block2));
  EXPECT_EQ(200, device.sample(senses)->at(6));
}

TEST(Sensitivity, WeakSpotsAreCoarse) {
  // At this brightness the first level has steps of 4 px, the fifth is as fine as the pixels.
  const double brightness = 2.0 / (kLevels[0].reach * kLevels[0].reach);
  for (const auto& level_and_places : {std::make_pair(0u, 16u), std::make_pair(4u, 64u)}) {
    Camera camera(kLevels[level_and_places.first]);
    std::set<int> places;
    for (int x = 0; x < 64; ++x) {
      const auto spots = camera.see({{1.0 * x, 100.0, 2.0, brightness}});
      ASSERT_EQ(1u, spots.size());
      EXPECT_NEAR(x, spots[0].x, level_and_places.first == 0 ? 2 : 0);
      places.insert(spots[0].x);
    }
    EXPECT_NEAR(level_and_places.second, places.size(), 1);
  }
}

TEST(Size, FollowsFromDistance) {
  // clamp(round(2.37 z^-0.778), 1, 15)
  const std::vector<std::pair<double, int>> sizes{{0.05, 15}, {0.3, 6}, {0.5, 4}, {0.7, 3},
                                                  {1.0, 2},   {2.0, 1}, {4.0, 1}};
  for (const auto& size : sizes) {
    const auto spots = Camera(kLevels[kMiddle]).see({barAt(size.first)});
    ASSERT_EQ(1u, spots.size());
    EXPECT_EQ(size.second, spots[0].size) << size.first << " m";
  }
}

TEST(Size, GrowsALittleWithSensitivity) {
  // 3.63 at the middle level; about half a unit between the first and the fifth.
  EXPECT_EQ(3, Camera(kLevels[0]).see({barAt(0.578)})[0].size);
  EXPECT_EQ(4, Camera(kLevels[4]).see({barAt(0.578)})[0].size);
}

TEST(Size, GivenIsReported) {
  EXPECT_EQ(0, Camera(kLevels[kMiddle]).see({{100, 100, 0.4, 1.0}})[0].size);
  EXPECT_EQ(15, Camera(kLevels[kMiddle]).see({{100, 100, 99.0, 1.0}})[0].size);
}

TEST(Merging, LightsWhoseImagesTouchAreOne) {
  // Images of size 2 are 16 px wide.
  EXPECT_EQ(2u, Camera(kLevels[kMiddle]).see({{100, 50, 2, 1}, {116.1, 50, 2, 1}}).size());
  EXPECT_EQ(1u, Camera(kLevels[kMiddle]).see({{100, 50, 2, 1}, {115.9, 50, 2, 1}}).size());
}

TEST(Merging, AtTheMeanWeightedByBrightnessAndBigger) {
  const auto spots = Camera(kLevels[kMiddle]).see({{100, 50, 2, 3}, {108, 50, 2, 1}});
  ASSERT_EQ(1u, spots.size());
  EXPECT_EQ(102, spots[0].x);
  EXPECT_EQ(50, spots[0].y);
  EXPECT_EQ(3, spots[0].size);
}

TEST(Merging, ChainsAreOneSpotAndOthersStay) {
  const auto spots =
      Camera(kLevels[kMiddle])
          .see({{100, 50, 2, 1}, {130, 50, 2, 1}, {700, 700, 2, 1}, {115, 50, 2, 1}});
  ASSERT_EQ(2u, spots.size());
  EXPECT_EQ(115, spots[0].x);
  EXPECT_EQ(700, spots[1].x);
}

TEST(Merging, LightsTooDimAloneAreSeenTogether) {
  const Light dim{300.0, 300.0, 1.0, 0.6 / 36.0};
  EXPECT_EQ(0u, Camera(kLevels[kMiddle]).see({dim}).size());
  EXPECT_EQ(1u, Camera(kLevels[kMiddle]).see({dim, dim}).size());
}

TEST(Image, QuantisesToTheNearestPixel) {
  const auto spots = Camera(kLevels[kMiddle]).see({{100.49, 50.51, 2, 1}});
  EXPECT_EQ(100, spots[0].x);
  EXPECT_EQ(51, spots[0].y);
}

TEST(Image, EndsAtItsEdges) {
  EXPECT_EQ(0u, Camera(kLevels[kMiddle])
                    .see({{-0.6, 5, 2, 1}, {1023.6, 5, 2, 1}, {5, -0.6, 2, 1}, {5, 767.6, 2, 1}})
                    .size());
  const auto spots = Camera(kLevels[kMiddle]).see({{-0.4, 20, 1, 2}, {1023.4, 767.4, 1, 1}});
  ASSERT_EQ(2u, spots.size());
  EXPECT_EQ(0, spots[0].x);
  EXPECT_EQ(1023, spots[1].x);
  EXPECT_EQ(767, spots[1].y);
}

TEST(Image, InvalidLightsAreNotSeen) {
  const double nan = std::nan("");
  EXPECT_EQ(0u, Camera(kLevels[kMiddle])
                    .see({{nan, 5, 2, 1},
                          {5, nan, 2, 1},
                          {5, 5, 2, nan},
                          {5, 5, 2, 0},
                          {5, 5, 2, -1},
                          {5, 5, 2, HUGE_VAL}})
                    .size());
}

TEST(Slots, FourBrightestOnly) {
  const auto spots =
      Camera(kLevels[kMiddle])
          .see({{10, 9, 1, 5}, {20, 9, 1, 1}, {30, 9, 1, 4}, {40, 9, 1, 3}, {50, 9, 1, 2}});
  ASSERT_EQ(4u, spots.size());
  EXPECT_EQ(10, spots[0].x);
  EXPECT_EQ(30, spots[1].x);
  EXPECT_EQ(40, spots[2].x);
  EXPECT_EQ(50, spots[3].x);
}

TEST(Slots, LightKeepsItsSlotWhileFollowed) {
  Camera camera(kLevels[kMiddle]);
  camera.see({{100, 100, 2, 2}, {200, 100, 2, 1}});
  // The second becomes the brighter one, both move, and their order is exchanged.
  auto spots = camera.see({{205, 100, 2, 9}, {105, 100, 2, 1}});
  ASSERT_EQ(2u, spots.size());
  EXPECT_EQ(105, spots[0].x);
  EXPECT_EQ(205, spots[1].x);
  // The first goes out: the second stays where it is.
  spots = camera.see({{205, 100, 2, 9}});
  ASSERT_EQ(1u, spots.size());
  EXPECT_EQ(1u, spots[0].slot);
  // A new one takes the first free slot.
  spots = camera.see({{205, 100, 2, 9}, {50, 700, 2, 1}});
  ASSERT_EQ(2u, spots.size());
  EXPECT_EQ(50, spots[0].x);
  EXPECT_EQ(0u, spots[0].slot);
}

TEST(Slots, OfReturningLightsAreDrawnOnRequest) {
  Device::Options options;
  options.slot_seed = 5;
  Camera camera(kLevels[kMiddle], options);
  const Light stays{205, 100, 2, 9};
  const Light comes_and_goes{800, 700, 2, 1};
  const std::size_t kept = camera.see({stays})[0].slot;
  std::set<std::size_t> drawn;
  for (int i = 0; i < 100; ++i) {
    for (const auto& spot : camera.see({stays, comes_and_goes})) {
      if (spot.x == 205)
        EXPECT_EQ(kept, spot.slot);
      else
        drawn.insert(spot.slot);
    }
    camera.see({stays});
  }
  EXPECT_EQ(3u, drawn.size());
}

TEST(Slots, NeverLitAreZerosLostOnesFf) {
  Device device;
  for (const Bytes& output : handshake())
    device.handleOutput(output);
  Bytes report = *device.sample(lights({{100, 100, 2, 2}}));
  EXPECT_EQ((Bytes{100, 100, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0}),
            Bytes(report.begin() + 6, report.end()));
  report = *device.sample(Senses());
  EXPECT_EQ((Bytes{0xff, 0xff, 0xff, 0, 0, 0, 0, 0, 0, 0, 0, 0}),
            Bytes(report.begin() + 6, report.end()));
}

TEST(FullFormat, GoldenVector) {
  Device device;
  for (const Bytes& output : {kClockOn, kLogicOn, kBegin, kBlock1, kBlock2, kFull, kRun})
    device.handleOutput(output);
  device.handleOutput({0x12, 0x04, 0x3e});
  device.sample(Senses());
  // 36 thresholds make one of brightness; the intensity is 255 s / (s + 8).
  Senses senses = lights({{291, 69, 3, 4.0}, {1023, 767, 1, 1.0}, {512, 384, 15, 0.25}});
  senses.acceleration = {8.0 / 105.0, -10.0 / 108.0, 82.0 / 102.0};
  EXPECT_EQ((Bytes{0x3e, 0x20, 0x40, 0x86,                                //
                   0x23, 0x45, 0x13, 0x22, 0x07, 0x25, 0x0a, 0x00, 0xf2,  //
                   0xff, 0xff, 0xb1, 0x7f, 0x5f, 0x7f, 0x5f, 0x00, 0xd1}),
            *device.sample(senses));
  EXPECT_EQ((Bytes{0x3f, 0x40, 0x40, 0x7f,                                //
                   0x00, 0x80, 0x6f, 0x38, 0x28, 0x47, 0x37, 0x00, 0x87,  //
                   0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00}),
            *device.sample(senses));
}

}  // namespace
}  // namespace wiimote_tracker::virtual_wiimote
