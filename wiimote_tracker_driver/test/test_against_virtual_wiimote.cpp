// Driver and virtual remote share no code, so what one writes the other must read.
#include "wiimote_tracker_driver/virtual_wiimote/device.h"
#include "wiimote_tracker_driver/wiimote/wiimote.h"

#include <gtest/gtest.h>

#include <deque>
#include <random>

namespace wiimote_tracker::wiimote {
namespace {

using virtual_wiimote::Bytes;
using virtual_wiimote::Device;
using virtual_wiimote::Senses;

protocol::Report reportOf(const Bytes& bytes) {
  protocol::Report report;
  report.size = bytes.size();
  std::copy(bytes.begin(), bytes.end(), report.bytes.begin());
  return report;
}

/// The virtual remote as a transport without a socket, in fake time: an image every 10 ms.
class DeviceTransport : public transport::Transport {
 public:
  DeviceTransport(Device* device, const Senses* senses, double* now)
      : device_(device), senses_(senses), now_(now) {}

  bool read(protocol::Report& report, double timeout) override {
    if (answers_.empty()) {
      *now_ += std::min(timeout, 0.01);
      if (timeout < 0.01)
        return false;
      if (const auto sampled = device_->sample(*senses_))
        answers_.push_back(*sampled);
    }
    if (answers_.empty())
      return false;
    report = reportOf(answers_.front());
    answers_.pop_front();
    return true;
  }
  void write(const protocol::Report& report) override {
    const auto begin = report.bytes.begin();
    for (const Bytes& answer : device_->handleOutput(Bytes(begin, begin + report.size)))
      answers_.push_back(answer);
  }
  std::string description() const override { return "device"; }
  std::string identity() const override { return ""; }

 private:
  Device* device_;
  const Senses* senses_;
  double* now_;
  std::deque<Bytes> answers_;
};

TEST(AgainstVirtualWiimote, EverySensitivityMakesItSee) {
  for (const std::string& name : protocol::irSensitivityNames()) {
    Device device;
    Senses senses;
    senses.lights = {{123, 456, 7, 1}};
    double now = 0.0;
    Options options;
    options.session.sensitivity = *protocol::irSensitivity(name);
    options.session.leds = 0x5;
    Wiimote wiimote(
        options, [&] { return std::make_unique<DeviceTransport>(&device, &senses, &now); },
        [&] { return now; });
    std::optional<protocol::DataReport> image;
    while (!(image && image->spots[0].seen) && now < 5.0)
      image = wiimote.step(0.1);
    ASSERT_TRUE(image) << name;
    EXPECT_EQ(123, image->spots[0].x);
    EXPECT_EQ(456, image->spots[0].y);
    EXPECT_EQ(7, image->spots[0].size);
    EXPECT_EQ(0x5, device.leds());
    EXPECT_TRUE(wiimote.link().accelerometer_calibrated);
    EXPECT_EQ(0u, wiimote.link().clock_epoch);
    const std::array<double, 3> g = wiimote.accelerometer().toG(*image->acceleration);
    EXPECT_NEAR(0.0, g[0], 0.02);
    EXPECT_NEAR(0.0, g[1], 0.02);
    EXPECT_NEAR(1.0, g[2], 0.02);
  }
}

TEST(AgainstVirtualWiimote, AnyLightsComeThrough) {
  Device device;
  const std::vector<Bytes> set_up{
      {0x13, 0x04},
      {0x1a, 0x04},
      {0x16, 0x04, 0xb0, 0x00, 0x00, 9, 2, 0, 0, 0x71, 1, 0, 0xaa, 0, 0x64},
      {0x16, 0x04, 0xb0, 0x00, 0x1a, 2, 0x63, 3},
      {0x16, 0x04, 0xb0, 0x00, 0x30, 1, 8}};
  for (const Bytes& report : set_up)
    device.handleOutput(report);
  std::mt19937 random(7);
  const auto uniform = [&](int limit) { return static_cast<int>(random() % limit); };
  struct Mode {
    std::uint8_t camera;
    std::uint8_t report;
  };
  for (const Mode mode : {Mode{3, 0x33}, Mode{1, 0x36}, Mode{1, 0x37}}) {
    device.handleOutput({0x16, 0x04, 0xb0, 0x00, 0x33, 1, mode.camera});
    device.handleOutput({0x12, 0x04, mode.report});
    for (int i = 0; i < 2000; ++i) {
      Senses senses;
      senses.buttons = static_cast<std::uint16_t>(random() & 0x1f9f);
      const int count = uniform(5);
      // One in each corner of the image, so far from the others that their images cannot touch.
      for (int light = 0; light < count; ++light) {
        const int x = uniform(392) + light % 2 * 632;
        const int y = uniform(263) + light / 2 * 504 + 1;
        const int size = 1 + uniform(15);
        senses.lights.push_back({1.0 * x, 1.0 * y, 1.0 * size, 1.0});
      }
      const auto sampled = device.sample(senses);
      ASSERT_TRUE(sampled);
      const auto data = protocol::decodeDataReport(reportOf(*sampled));
      ASSERT_TRUE(data);
      EXPECT_EQ(senses.buttons, data->buttons);
      // Slots are the device's affair: the same lights, in any order.
      using Spot = std::array<int, 3>;
      std::vector<Spot> expected;
      for (const auto& light : senses.lights)
        expected.push_back({static_cast<int>(light.x), static_cast<int>(light.y),
                            mode.camera == 3 ? static_cast<int>(*light.size) : 0});
      std::vector<Spot> decoded;
      for (const auto& spot : data->spots) {
        if (spot.seen)
          decoded.push_back({spot.x, spot.y, spot.size});
      }
      std::sort(expected.begin(), expected.end());
      std::sort(decoded.begin(), decoded.end());
      ASSERT_EQ(expected, decoded) << "report " << int{mode.report} << ", image " << i;
    }
  }
}

}  // namespace
}  // namespace wiimote_tracker::wiimote
