#include "scenarios.h"

#include "clock.h"
#include "kernel.h"
#include "streaming.h"

namespace wiimote_tracker::real_kernel {

void muteRemote(Checks& checks) {
  const std::string mute_address = addressOf(1), address = addressOf(2);
  Scene scene;
  PluggedRemote mute(mute_address, scene);
  mute.mute();
  const bool first = waitFor([&] { return !hidrawOf(mute_address).empty(); }, kTimeout);
  const PluggedRemote remote(address, scene);
  const bool second = waitFor([&] { return !hidrawOf(address).empty(); }, 2.0 * kTimeout);
  checks.check("the mute remote comes first",
               first && second && hidrawOf(mute_address) < hidrawOf(address));
  const RunningDriver driver("", scene, checks.images);
  driver.waitForState(wiimote::Link::State::kStreaming, 4.0 * kTimeout);
  const wiimote::Link link = driver.link();
  checks.check("the other one streams", link.remote.identity == address,
               link.remote.identity + link.error);
  checks.recovers("at full rate", driver, [] {});
}

}  // namespace wiimote_tracker::real_kernel
