// The accuracy of the motion filter of one LED, compared with bounds.
#include "benchmark_sections.h"
#include "geometry/accuracy.h"
#include "motion/filter_scene.h"
#include "motion/known_mode.h"
#include "motion/transition.h"
#include "single_model_filter.h"
#include "tracking/paths.h"
#include "tracking/scene.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace wiimote_tracker {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using geometry::Camera;
using geometry::test::Random;
using motion::MotionFilter;
using motion::MotionOptions;
using motion::test::kPixelStddev;
using motion::test::kStep;
using motion::test::takeIn;
using tracking::test::Path;

constexpr double kStartStddev = 2e-3;  // of the first position, per axis [m]
constexpr double kSettled = 0.5;       // errors before are not scored [s]

/// Errors, and their bound.
struct Figures : geometry::test::Accuracy {
  double bound_squared = 0.0;  // [m^2]

  BenchmarkRow row(const std::string& name) const {
    const double bound = std::sqrt(bound_squared / count);
    return {name,
            {{"RMS mm", 1e3 * rms()},
             {"bound mm", 1e3 * bound},
             {"ratio", rms() / bound},
             {"NEES", nees()},
             {"in 95 %", 100.0 * shareInside()}}};
  }
};

const Camera& cameraOf(std::size_t index) {
  static const geometry::Rig rig = tracking::test::paperRig();
  return rig.cameras[index].camera;
}

void takeIn(SingleModelFilter* filter, double time, const Camera& camera, const Vector2d& pixel) {
  filter->predict(time);
  filter->update(camera, pixel, filter->state.position());
}

/// The acceleration is a random walk. @param density [m^2/s^5]  @param h duration [s]
motion::Transition randomWalkOfAcceleration(double density, double h) {
  motion::Transition result;
  result.F << 1.0, h, 0.5 * h * h, 0.0, 1.0, h, 0.0, 0.0, 1.0;
  result.Q << h * h * h * h / 20.0, h * h * h / 8.0, h * h / 6.0,  //
      h * h * h / 8.0, h * h / 3.0, h / 2.0,                       //
      h * h / 6.0, h / 2.0, 1.0;
  result.Q *= density * h;
  return result;
}

/// A true motion, whose model the bound knows.
struct Drawn {
  double stddev, time;  // of the acceleration
  bool jumps;           // still for 1 to 3 s, moving for 1 to 2 s; else it always moves
  double duration;      // [s]
};

/// Adds one run; `moving` and `still` may be the same. Ends early where the LED leaves a view.
void runDrawn(const Drawn& drawn,
              const MotionOptions& options,
              Random& random,
              Figures* moving,
              Figures* still) {
  motion::test::SingerTruth truth(drawn.stddev, drawn.time, kStep);
  const Matrix3d covariance = kStartStddev * kStartStddev * Matrix3d::Identity();
  const double speed = drawn.jumps ? 0.0 : options.initial_speed;
  truth.place(Vector3d(1.25, 1.25, 1.2) + random.inBox(0.2), random.gaussianVector(speed));
  motion::test::KnownModeBound bound(drawn.stddev, drawn.time, kStep, covariance, speed);
  double next_jump = std::numeric_limits<double>::infinity();
  if (drawn.jumps) {
    bound.stop();
    next_jump = random.uniform(1.0, 3.0);
  } else {
    truth.startMoving(random);
  }
  MotionFilter filter(options, 0.0, truth.position() + random.gaussianVector(kStartStddev),
                      covariance);
  for (int i = 1; i * kStep < drawn.duration; ++i) {
    const double time = i * kStep;
    if (time >= next_jump) {
      if (truth.moves()) {
        truth.stop();
        bound.stop();
        next_jump = time + random.uniform(1.0, 3.0);
      } else {
        truth.startMoving(random);
        bound.startMoving();
        next_jump = time + random.uniform(1.0, 2.0);
      }
    }
    truth.step(random);
    bound.step();
    const Camera& camera = cameraOf(static_cast<std::size_t>(i % 4));
    if (!camera.sees(truth.position()))
      return;
    takeIn(&filter, time, camera, motion::test::noisyPixel(camera, truth.position(), random));
    bound.observe(camera, truth.position(), kPixelStddev);
    Figures* figures = truth.moves() ? moving : still;
    figures->add(filter.position() - truth.position(), filter.positionCovariance());
    figures->bound_squared += bound.squaredError();
  }
}

Figures sum(const Figures& a, const Figures& b) {
  return {
      {a.squares + b.squares, a.distances + b.distances, a.inside + b.inside, a.count + b.count},
      a.bound_squared + b.bound_squared};
}

/// With a single mode, the filter is a Kalman filter.
void ownModel(const BenchmarkSettings& settings, const RowCallback& row) {
  const Drawn drawn{2.0, 0.2, false, 1.0};
  MotionOptions options;
  options.moving.fill({drawn.stddev, drawn.time});
  options.sudden_random_walk = options.stop_rate = 0.0;
  options.initial_speed = 0.3;
  Random random(settings.seed);
  Figures figures;
  for (int run = 0; run < 20 * settings.runs; ++run)
    runDrawn(drawn, options, random, &figures, &figures);
  row(figures.row("(a) of its own single model"));
}

void jumps(const BenchmarkSettings& settings, const RowCallback& row) {
  const MotionOptions options;
  Random random(settings.seed + 1);
  Figures moving, still;
  for (int run = 0; run < 32 * settings.runs; ++run)
    runDrawn({2.0, 0.2, true, 12.0}, options, random, &moving, &still);
  row(sum(moving, still).row("(b) still and moving by jumps"));
  row(still.row("    while still"));
  row(moving.row("    while moving"));
}

/// One image of one LED, and its true position.
struct Sample {
  double time;
  std::size_t camera;
  Vector2d pixel;
  Vector3d truth;
  int speed_class;
};

std::vector<Sample> simulate(
    const Path& path,
    double duration,
    unsigned seed,
    const std::function<int(double)>& speed_class = [](double) { return 0; }) {
  tracking::test::SceneOptions options;
  options.start = 0.0;
  options.pixel_noise = kPixelStddev;
  tracking::test::Scene scene(tracking::test::paperRig(), {path}, options, seed);
  std::vector<Sample> samples;
  while (true) {
    const tracking::test::SceneImage& image = scene.next();
    if (image.true_time >= duration)
      return samples;
    if (!image.image.spots.empty()) {
      samples.push_back({image.true_time, image.camera, image.image.spots.front().pixel,
                         path(image.true_time), speed_class(image.true_time)});
    }
  }
}

/// Runs a filter, initialised at the first sample, over all samples.
template <typename Filter>
void follow(const std::vector<Sample>& samples,
            Filter* filter,
            const std::function<void(const Sample&)>& score) {
  for (const Sample& sample : samples) {
    takeIn(filter, sample.time, cameraOf(sample.camera), sample.pixel);
    if (sample.time > kSettled)
      score(sample);
  }
}

/// Figures per speed class, each compared with the constant-noise filter that suits it best.
void compareWithBestFilter(const std::vector<std::vector<Sample>>& recordings,
                           const std::vector<std::string>& classes,
                           const RowCallback& row) {
  std::vector<Figures> figures(classes.size());
  std::vector<double> best(classes.size(), std::numeric_limits<double>::infinity());
  const MotionOptions options;
  const Matrix3d covariance = kStartStddev * kStartStddev * Matrix3d::Identity();
  for (const std::vector<Sample>& samples : recordings) {
    MotionFilter filter(options, samples.front().time, samples.front().truth, covariance);
    follow(samples, &filter, [&](const Sample& sample) {
      figures[sample.speed_class].add(filter.position() - sample.truth,
                                      filter.positionCovariance());
    });
  }
  // Random walks of the velocity or acceleration, densities from 1e-6 to 1e4, two per decade.
  for (const int order : {2, 3}) {
    for (int exponent = -12; exponent <= 8; ++exponent) {
      const double density = std::pow(10.0, 0.5 * exponent);
      std::vector<double> squared(classes.size(), 0.0);
      for (const std::vector<Sample>& samples : recordings) {
        SingleModelFilter filter{
            [&](double duration) {
              return order == 2 ? motion::randomWalkOfVelocity(std::sqrt(density), duration)
                                : randomWalkOfAcceleration(density, duration);
            },
            kPixelStddev, samples.front().time,
            stateAt(samples.front().truth, covariance, 1.0, order == 2 ? 0.0 : 10.0)};
        follow(samples, &filter, [&](const Sample& sample) {
          squared[sample.speed_class] += (filter.state.position() - sample.truth).squaredNorm();
        });
      }
      for (std::size_t i = 0; i < classes.size(); ++i)
        best[i] = std::min(best[i], squared[i]);
    }
  }
  for (std::size_t i = 0; i < classes.size(); ++i) {
    if (figures[i].count == 0)
      continue;
    figures[i].bound_squared = best[i];
    row(figures[i].row(classes[i]));
  }
}

void circles(const BenchmarkSettings& settings, const RowCallback& row) {
  for (const double speed : {0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0}) {
    std::vector<std::vector<Sample>> recordings;
    for (int run = 0; run < settings.runs; ++run) {
      const Path path =
          tracking::test::circle({1.25, 1.25, 1.2}, 0.75, speed, 2.0 * M_PI * run / settings.runs);
      recordings.push_back(simulate(path, 3.0, settings.seed + run));
    }
    const std::string name = format("(c) circle of 0.75 m at %.1f m/s", speed);
    compareWithBestFilter(recordings, {name}, row);
  }
}

/// Through samples, smoothly (Catmull and Rom 1974).
Path smoothed(const std::vector<Vector3d>& samples, double interval) {
  return [=](double time) {
    const double place = std::clamp(time / interval, 1.0, static_cast<double>(samples.size()) - 3);
    const std::size_t i = std::min(static_cast<std::size_t>(place), samples.size() - 3);
    const double s = place - static_cast<double>(i);
    const Vector3d &a = samples[i - 1], &b = samples[i], &c = samples[i + 1], &d = samples[i + 2];
    return Vector3d(
        b +
        0.5 * s * (c - a + s * (2.0 * a - 5.0 * b + 4.0 * c - d + s * (3.0 * (b - c) + d - a))));
  };
}

/// Markers of a recording at 60 Hz, moved into view.
void recorded(const BenchmarkSettings& settings, const RowCallback& row) {
  constexpr double kInterval = 1.0 / 60.0;
  const std::array<double, 3> limits{0.1, 0.5, 1.5};  // upper speeds of the classes [m/s]
  std::vector<std::vector<Sample>> recordings;
  constexpr int kMarkers = 28;
  for (int marker = 0; marker < std::min(kMarkers, settings.runs); ++marker) {
    // With few runs, the markers are spread over the whole body.
    const int column = 1 + 3 * (marker * kMarkers / std::min(kMarkers, settings.runs));
    std::vector<Vector3d> samples = tracking::test::readMotion(settings.motion, column);
    for (Vector3d& sample : samples)
      sample += Vector3d(1.19, 1.05, 0.4);
    const double duration = kInterval * (static_cast<double>(samples.size()) - 4);
    const Path path = smoothed(samples, kInterval);
    const auto speed_class = [path, limits](double time) {
      constexpr double kSmall = 0.005;
      const double speed = (path(time + kSmall) - path(time - kSmall)).norm() / (2.0 * kSmall);
      int i = 0;
      while (i < 3 && speed >= limits[i])
        ++i;
      return i;
    };
    recordings.push_back(simulate(path, duration, settings.seed + 100 + marker, speed_class));
  }
  compareWithBestFilter(recordings,
                        {"(c) recorded, below 0.1 m/s", "(c) recorded, 0.1 to 0.5 m/s",
                         "(c) recorded, 0.5 to 1.5 m/s", "(c) recorded, above 1.5 m/s"},
                        row);
}

/// Time of an image's prediction, innovation and update.
void speed(const BenchmarkSettings& settings, const RowCallback& row) {
  const std::vector<Sample> samples =
      simulate(tracking::test::circle({1.25, 1.25, 1.2}, 0.75, 1.0), 10.0, settings.seed);
  const MotionOptions options;
  double best = std::numeric_limits<double>::infinity();
  for (int run = 0; run < settings.runs; ++run) {
    MotionFilter filter(options, samples.front().time, samples.front().truth,
                        1e-6 * Matrix3d::Identity());
    const double start = processorTime();
    for (const Sample& sample : samples)
      takeIn(&filter, sample.time, cameraOf(sample.camera), sample.pixel);
    best = std::min(best, (processorTime() - start) / static_cast<double>(samples.size()));
  }
  row({"time per image, fastest run", {{"ns", 1e9 * best}}});
}

void runFilter(const BenchmarkSettings& settings, const RowCallback& row) {
  ownModel(settings, row);
  jumps(settings, row);
  circles(settings, row);
  if (!settings.motion.empty())
    recorded(settings, row);
  speed(settings, row);
}

}  // namespace

BenchmarkSection filterSection() {
  return {
      "filter",
      "one LED seen by four cameras in turn every 2.5 ms, 0.5 px of noise. (a) motion drawn from "
      "the filter's only mode and (b) motion that changes between rest (1 to 3 s) and moving (1 to "
      "2 s, acceleration of 2 m/s^2 with an autocorrelation time of 0.2 s), beside the posterior "
      "Cramer-Rao bound, which knows the mode; (c) bound: the constant-velocity or -acceleration "
      "filter whose noise suits the row best. NEES: 3 where the covariance is right.",
      runFilter};
}

}  // namespace wiimote_tracker
