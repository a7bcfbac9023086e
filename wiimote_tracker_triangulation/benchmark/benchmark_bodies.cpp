// Accuracy of finding and following rigid bodies: one table per section.
#include "benchmark_program.h"
#include "body/body_scene.h"

#include <wiimote_tracker_msgs/median.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace wiimote_tracker {
namespace {

using body::Constellation;
using namespace body::test;
using tracking::test::SceneOptions;

constexpr double kPixelNoise = 0.5;  // [px]
constexpr double kBegin = 1001.0;    // errors before are not scored [s]
constexpr double kWrong = 0.35;      // a larger rotation error means a wrong assignment [rad]

geometry::Rig rigOf(std::size_t cameras) {
  geometry::Rig rig = tracking::test::paperRig();
  rig.cameras.resize(cameras);  // two: neighbours, as in the paper
  return rig;
}

SceneOptions sceneOptions() {
  SceneOptions options;
  options.pixel_noise = kPixelNoise;
  return options;
}

BenchmarkRow measure(const std::string& name,
                     std::size_t cameras,
                     const Constellation& body,
                     const Motion& motion,
                     const SceneOptions& options,
                     const BenchmarkSettings& settings,
                     double judged_from = kBegin) {
  const geometry::Rig rig = rigOf(cameras);
  BodyScore score;
  double median = 0.0;
  for (int run = 0; run < settings.runs; ++run) {
    FollowedBody followed(rig, body, motion, options, settings.seed + static_cast<unsigned>(run));
    std::vector<double> seconds;  // of processing, per image
    while (followed.time() < judged_from + 10.0) {
      followed.show();
      const double start = processorTime();
      followed.track();
      seconds.push_back(processorTime() - start);
      if (followed.time() >= judged_from)
        score.add(followed);
    }
    median += medianOf(&seconds) / settings.runs;
  }
  return {name,
          {{"position mm", 1e3 * score.position()},
           {"/ bound", score.positionRatio()},
           {"rotation deg", 180.0 / M_PI * score.rotation()},
           {"/ bound ", score.rotationRatio()},
           {"velocity m/s", score.velocity()},
           {"rate deg/s", 180.0 / M_PI * score.angularVelocity()},
           {"NEES / 6", score.nees()},
           {"of rates", score.ratesNees()},
           {"known %", 100.0 * score.known()},
           {"right %", 100.0 * (1.0 - score.wrong())},
           {"us per image", 1e6 * median}}};
}

void runAccuracy(const BenchmarkSettings& settings, const RowCallback& row) {
  for (const Constellation& body : {fourLeds(), threeLeds()}) {
    for (const std::size_t cameras : {4, 2}) {
      const std::string where = body.name + ", " + std::to_string(cameras) + " cameras, ";
      row(measure(where + "held still", cameras, body, held, sceneOptions(), settings));
      row(measure(where + "hand-held", cameras, body, handheld, sceneOptions(), settings));
      row(measure(where + "shaken", cameras, body, shaken, sceneOptions(), settings));
      row(measure(where + "360 deg/s", cameras, body, tumbling, sceneOptions(), settings));
    }
  }
}

void runHidden(const BenchmarkSettings& settings, const RowCallback& row) {
  SceneOptions one_led = sceneOptions();
  one_led.hidden = [](std::size_t, std::size_t led, double) { return led == 2; };
  row(measure("one LED of four hidden", 4, fourLeds(), handheld, one_led, settings));
  SceneOptions one_camera = sceneOptions();
  one_camera.hidden = [](std::size_t camera, std::size_t, double t) {
    return t > kBegin && camera != 1;
  };
  row(measure("one camera left, four LEDs, for 10 s", 4, fourLeds(), handheld, one_camera, settings,
              kBegin + 0.5));
  for (const double merging : {8.0, 12.0, 16.0, 24.0}) {
    SceneOptions merged = sceneOptions();
    merged.merging_distance = merging;
    row(measure("spots within " + std::to_string(static_cast<int>(merging)) + " px are one", 4,
                fourLeds(), handheld, merged, settings));
  }
}

void runRecovery(const BenchmarkSettings& settings, const RowCallback& row) {
  SceneOptions options = sceneOptions();
  constexpr double kPeriod = 2.0, kDark = 1.2;  // [s]
  options.hidden = [=](std::size_t, std::size_t, double t) {
    return std::fmod(t, kPeriod) > kDark;
  };
  for (const auto& [name, motion] : {std::make_pair("hand-held", Motion(handheld)),
                                     std::make_pair("360 deg/s", Motion(tumbling))}) {
    std::vector<double> delays;
    double wrong = 0.0;
    for (int run = 0; run < settings.runs; ++run) {
      FollowedBody followed(rigOf(4), fourLeds(), motion, options,
                            settings.seed + static_cast<unsigned>(run));
      bool was_lost = false;
      while (followed.time() < 1021.0) {
        followed.step();
        if (!followed.estimate()) {
          was_lost = true;
          continue;
        }
        if (!was_lost)
          continue;
        was_lost = false;
        delays.push_back(std::fmod(followed.time(), kPeriod));
        wrong +=
            rotationError(followed.truth(), followed.estimate()->world_from_body).norm() > kWrong;
      }
    }
    std::sort(delays.begin(), delays.end());
    const auto quantile = [&](double q) {
      return 1e3 * delays[static_cast<std::size_t>(q * static_cast<double>(delays.size() - 1))];
    };
    row({name,
         {{"times", delays.size()},
          {"median ms", quantile(0.5)},
          {"p95 ms", quantile(0.95)},
          {"worst ms", quantile(1.0)},
          {"wrong %", 100.0 * wrong / static_cast<double>(delays.size())}}});
  }
}

}  // namespace
}  // namespace wiimote_tracker

int main(int argc, char** argv) {
  using namespace wiimote_tracker;
  return runBenchmark(
      "benchmark_bodies",
      {{"accuracy",
        "Poses at the newest image, the paper's cameras, unsynchronised, 0.5 px, bodies of 0.1 m "
        "radius, 10 s per run; beside the Cramer-Rao bound of one image by each camera. known: "
        "share of the time with a pose; right: within 20 degrees.",
        runAccuracy},
       {"hidden", "The same with LEDs hidden, or spots that merge.", runHidden},
       {"recovery", "Time to the first pose after all LEDs were hidden for 0.8 s.", runRecovery}},
      argc, argv);
}
