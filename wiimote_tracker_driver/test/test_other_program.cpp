// Another program opens and closes the remote's event device, as games and desktops do: every image
// that the driver passes on must still be of the scene.
#include "driven_device.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace wiimote_tracker::wiimote {
namespace {

using virtual_wiimote::Bytes;
using virtual_wiimote::Light;

Bytes registers(std::uint8_t address, const Bytes& data) {
  Bytes report{0x16, 0x04, 0xb0, 0x00, address, static_cast<std::uint8_t>(data.size())};
  report.insert(report.end(), data.begin(), data.end());
  report.resize(22, 0);
  return report;
}

/// What the kernel's driver sends, each after the answer to the one before.
const std::vector<Bytes> kOpen{{0x13, 0x06},
                               {0x1a, 0x06},
                               registers(0x30, {0x01}),
                               registers(0x00, {0x02, 0, 0, 0x71, 0x01, 0, 0xaa, 0, 0x64}),
                               registers(0x1a, {0x63, 0x03}),
                               registers(0x33, {0x01}),
                               registers(0x30, {0x08}),
                               {0x12, 0x00, 0x36}};
const std::vector<Bytes> kClose{{0x13, 0x00}, {0x1a, 0x00}, {0x12, 0x00, 0x30}};

const std::vector<Light> kLights{{291, 69, 3, 4},
                                 {901, 612, 2, 3},
                                 {515, 397, 4, 2},
                                 {44, 700, 1, 1}};

/// A remote with `lights` lights that another program uses as well.
class Shared {
 public:
  explicit Shared(int lights, const Options& options = Options()) : driven_(options) {
    driven_.remote.senses.lights.assign(kLights.begin(), kLights.begin() + lights);
  }

  bool start() { return driven_.runToLight() && run(0.5) > 0; }

  /// Another program sends these, one each `interval` [s]; the remote gets them at once.
  void say(const std::vector<Bytes>& reports, double interval) {
    double time = driven_.remote.now;
    auto& said = driven_.remote.said;
    for (const Bytes& report : reports) {
      const auto later = std::find_if(said.begin(), said.end(),
                                      [&](const auto& other) { return other.first > time; });
      said.insert(later, {time, report});
      run(interval);
      time += interval;
    }
  }

  /// As say(). The camera is then switched off without an answer to anybody, so dark images come
  /// for a while.
  void close(double interval) {
    may_be_dark_ = true;
    say(kClose, interval);
    run(0.05);
    may_be_dark_ = false;
  }

  /// @returns the number of images, and counts those that are not of the scene.
  int run(double duration) {
    int images = 0;
    for (const double end = driven_.remote.now + duration; driven_.remote.now < end;) {
      driven_.remote.now += driven_.wiimote.idleTime();
      const auto image = driven_.wiimote.step(std::max(0.0, end - driven_.remote.now));
      if (!image)
        continue;
      ++images;
      wrong_ += isScene(image->spots) ? 0 : 1;
    }
    return images;
  }

  int wrong() const { return wrong_; }
  Wiimote& wiimote() { return driven_.wiimote; }

 private:
  bool isScene(const std::array<protocol::IrSpot, 4>& spots) const {
    const auto& lights = driven_.remote.senses.lights;
    const bool dark = std::none_of(spots.begin(), spots.end(),
                                   [](const protocol::IrSpot& spot) { return spot.seen; });
    if (dark && may_be_dark_)
      return true;
    for (std::size_t i = 0; i < spots.size(); ++i) {
      const bool lit = i < lights.size();
      if (spots[i].seen != lit)
        return false;
      if (lit && (spots[i].x != lights[i].x || spots[i].y != lights[i].y ||
                  spots[i].size != *lights[i].size))
        return false;
    }
    return true;
  }

  Driven driven_;
  int wrong_ = 0;
  bool may_be_dark_ = false;
};

TEST(OtherProgram, ThatOpensTheEventDeviceCausesNoWrongImage) {
  int openings = 0, wrong = 0;
  for (int lights = 1; lights <= 4; ++lights) {
    for (const double interval : {0.002, 0.008, 0.012, 0.025}) {
      Shared shared(lights);
      ASSERT_TRUE(shared.start());
      for (int i = 0; i < 5; ++i) {
        shared.run(0.0037 * i);  // at another phase each time
        shared.say(kOpen, interval);
        shared.run(0.3);
        EXPECT_GE(shared.run(0.2), 18) << lights << " lights, interval " << interval;
        shared.close(interval);
        shared.run(0.3);
        EXPECT_GE(shared.run(0.2), 18) << lights << " lights, interval " << interval;
        ++openings;
      }
      wrong += shared.wrong();
      EXPECT_EQ(0u, shared.wiimote().link().clock_epoch);
    }
  }
  EXPECT_EQ(0, wrong) << "in " << openings << " openings";
}

}  // namespace
}  // namespace wiimote_tracker::wiimote
