#include "tracking/paths.h"

#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace wiimote_tracker::tracking::test {
namespace {

struct Wave {
  double amplitude;  // [m]
  double rate;       // [rad/s]
  double phase;      // [rad]
};

/// Keeps a coordinate between the walls -half_side and half_side, and smooth.
double turnedBack(double x, double half_side) {
  return half_side * std::sin(x / half_side);
}

}  // namespace

Path still(const Eigen::Vector3d& position) {
  return [position](double) { return position; };
}

Path circle(const Eigen::Vector3d& center, double radius, double speed, double phase) {
  return [=](double t) {
    const double angle = phase + speed / radius * t;
    return Eigen::Vector3d(center +
                           radius * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0));
  };
}

Path straight(const Eigen::Vector3d& point, const Eigen::Vector3d& velocity, double when) {
  return [=](double t) { return Eigen::Vector3d(point + (t - when) * velocity); };
}

Path wandering(geometry::test::Random& random,
               const Eigen::Vector3d& center,
               double half_side,
               double speed) {
  constexpr int kWaves = 6;
  std::array<std::array<Wave, kWaves>, 3> waves;
  for (auto& axis : waves) {
    for (Wave& wave : axis) {
      wave.rate = 2.0 * M_PI * random.uniform(0.1, 1.2);
      // A sine's mean square is a half; three axes of kWaves each.
      wave.amplitude = speed * std::sqrt(2.0 / (3.0 * kWaves)) / wave.rate;
      wave.phase = random.uniform(-M_PI, M_PI);
    }
  }
  return [=](double t) {
    Eigen::Vector3d place = center;
    for (int axis = 0; axis < 3; ++axis) {
      double x = 0.0;
      for (const Wave& wave : waves[static_cast<std::size_t>(axis)])
        x += wave.amplitude * std::sin(wave.rate * t + wave.phase);
      place[axis] += turnedBack(x, half_side);
    }
    return place;
  };
}

std::vector<Path> wanderers(int count, unsigned seed, double speed) {
  geometry::test::Random random(seed);
  std::vector<Path> leds;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d center(i % 2 ? 1.7 : 0.8, i / 2 ? 1.7 : 0.8, 1.0);
    leds.push_back(wandering(random, center, 0.25, speed));
  }
  return leds;
}

Path shaken(geometry::test::Random& random,
            const Eigen::Vector3d& center,
            double speed,
            double acceleration) {
  constexpr int kWaves = 5;
  std::array<std::array<Wave, kWaves>, 3> waves;
  double speed2 = 0.0, acceleration2 = 0.0;  // mean squares
  for (auto& axis : waves) {
    for (Wave& wave : axis) {
      wave = {0.0, random.uniform(0.4, 1.6), random.uniform(-M_PI, M_PI)};
      wave.amplitude = random.uniform(0.5, 1.0) / wave.rate;
      speed2 += 0.5 * std::pow(wave.amplitude * wave.rate, 2);
      acceleration2 += 0.5 * std::pow(wave.amplitude * wave.rate * wave.rate, 2);
    }
  }
  const double rate = acceleration / speed * std::sqrt(speed2 / acceleration2);
  const double amplitude = speed / (rate * std::sqrt(speed2));
  return [=](double t) {
    Eigen::Vector3d place = center;
    for (int axis = 0; axis < 3; ++axis) {
      for (const Wave& wave : waves[static_cast<std::size_t>(axis)])
        place[axis] += amplitude * wave.amplitude * std::sin(rate * wave.rate * t + wave.phase);
    }
    return place;
  };
}

Path sampled(const std::vector<Eigen::Vector3d>& samples, double interval) {
  return [=](double t) {
    const double place = std::fmod(std::fmod(t / interval, samples.size()) + samples.size(),
                                   static_cast<double>(samples.size()));
    const std::size_t before = std::min(static_cast<std::size_t>(place), samples.size() - 1);
    const std::size_t after = std::min(before + 1, samples.size() - 1);
    const double share = place - static_cast<double>(before);
    return Eigen::Vector3d((1.0 - share) * samples[before] + share * samples[after]);
  };
}

std::vector<Eigen::Vector3d> readMotion(const std::string& file, int column) {
  std::ifstream stream(file);
  if (!stream)
    throw std::runtime_error(file + " cannot be read; give the path of a CSV file");
  std::vector<Eigen::Vector3d> samples;
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line);
    std::vector<double> numbers;
    for (std::string word; std::getline(words, word, ',');) {
      std::istringstream number(word);
      double value;
      if (!(number >> value))
        break;
      numbers.push_back(value);
    }
    if (numbers.size() < static_cast<std::size_t>(column) + 3)
      continue;
    const double* place = numbers.data() + column;
    samples.push_back(1e-3 * Eigen::Vector3d(place[0], place[1], place[2]));
  }
  if (samples.empty())
    throw std::runtime_error(file + " has no line with that column; choose another");
  return samples;
}

}  // namespace wiimote_tracker::tracking::test
