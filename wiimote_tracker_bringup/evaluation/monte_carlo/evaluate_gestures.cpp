// Gestures that simulated people draw with an LED, as tracked: a folder per person with a CSV per
// gesture, for gesture_tool.
#include "program.h"
#include "room.h"

#include <wiimote_tracker_msgs/text.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace wiimote_tracker::monte_carlo {
namespace {

using Eigen::Vector3d;
using Line = std::vector<Vector3d>;  // in a unit square around the origin: x to the right, z up

constexpr double kRest = 1.0;     // before and after a drawing [s]
constexpr int kPoints = 400;      // per line
constexpr double kMargin = 0.05;  // of the drawing, cut off with the rest [s]

/// @param radius from the begin (0) to the end (1).
Line arc(double from, double to, const std::function<double(double)>& radius, double z = 0.0) {
  Line line;
  for (int i = 0; i <= 60; ++i) {
    const double angle = from + (to - from) * i / 60.0;
    line.push_back(z * Vector3d::UnitZ() +
                   radius(i / 60.0) * Vector3d(std::cos(angle), 0.0, std::sin(angle)));
  }
  return line;
}

Line infinity() {
  Line line;
  for (int i = 0; i <= 80; ++i) {
    const double angle = 2.0 * M_PI * i / 80.0;
    line.push_back({0.5 * std::sin(angle), 0.0, 0.25 * std::sin(2.0 * angle)});
  }
  return line;
}

Line sCurve() {
  const auto radius = [](double) { return 0.25; };
  Line line = arc(0.3 * M_PI, 1.5 * M_PI, radius, 0.25);
  const Line lower = arc(0.5 * M_PI, -0.7 * M_PI, radius, -0.25);
  line.insert(line.end(), lower.begin(), lower.end());
  return line;
}

/// The gestures to draw.
std::map<std::string, Line> gestures() {
  const auto corners = [](std::initializer_list<std::array<double, 2>> places) {
    Line line;
    for (const auto& [x, z] : places)
      line.push_back({x, 0.0, z});
    return line;
  };
  return {
      {"arrow", corners({{-0.5, 0}, {0.5, 0}, {0.2, 0.3}, {0.5, 0}, {0.2, -0.3}})},
      {"caret", corners({{-0.4, -0.4}, {0, 0.4}, {0.4, -0.4}})},
      {"check", corners({{-0.4, 0}, {-0.15, -0.35}, {0.45, 0.45}})},
      {"circle", arc(0.5 * M_PI, -1.5 * M_PI, [](double) { return 0.5; })},
      {"hook", corners({{0.2, 0.5}, {0.2, -0.3}, {-0.1, -0.5}, {-0.3, -0.25}})},
      {"infinity", infinity()},
      {"s_curve", sCurve()},
      {"spiral", arc(0.0, 5.0 * M_PI, [](double share) { return 0.08 + 0.42 * share; })},
      {"square", corners({{-0.4, 0.4}, {0.4, 0.4}, {0.4, -0.4}, {-0.4, -0.4}, {-0.4, 0.4}})},
      {"star",
       corners(
           {{-0.3, -0.45}, {0, 0.5}, {0.3, -0.45}, {-0.45, 0.15}, {0.45, 0.15}, {-0.3, -0.45}})},
      {"triangle", corners({{0, 0.45}, {0.45, -0.4}, {-0.45, -0.4}, {0, 0.45}})},
      {"zigzag", corners({{-0.5, 0.3}, {-0.15, -0.3}, {0.15, 0.3}, {0.5, -0.3}})},
  };
}

/// From the begin of a line to each of its points.
std::vector<double> lengths(const Line& line) {
  std::vector<double> way = {0.0};
  for (std::size_t i = 1; i < line.size(); ++i)
    way.push_back(way.back() + (line[i] - line[i - 1]).norm());
  return way;
}

/// kPoints points at equal distances along a line.
Line evenly(const Line& line) {
  const std::vector<double> way = lengths(line);
  Line result;
  std::size_t piece = 1;
  for (int i = 0; i < kPoints; ++i) {
    const double at = way.back() * i / (kPoints - 1);
    while (piece + 1 < way.size() && way[piece] < at)
      ++piece;
    const double share = (at - way[piece - 1]) / (way[piece] - way[piece - 1]);
    result.push_back(line[piece - 1] + share * (line[piece] - line[piece - 1]));
  }
  return result;
}

/// A person's way of drawing, with variations from drawing to drawing.
class Hand {
 public:
  explicit Hand(std::uint32_t seed) : random_(seed) {
    size_ = uniform(0.25, 0.5);
    slant_ = uniform(-0.3, 0.3);
    aspect_ = uniform(0.75, 1.3);
    heading_ = uniform(-0.25, 0.25);
    roundness_ = uniform(0.01, 0.06);
    speed_ = uniform(0.6, 1.4);
    wobble_ = uniform(0.01, 0.04);
  }

  /// A drawing that starts at time 0. @param duration output [s].
  Path draw(const Line& gesture, double* duration) {
    const Line line = round(evenly(distort(gesture)));
    const double time = lengths(line).back() / speed_ * uniform(0.85, 1.15);
    const double uneven = uniform(-0.3, 0.3), when = uniform(0.0, 2.0 * M_PI);
    *duration = time;
    return [=](double now) {
      const double share = std::clamp(now / time, 0.0, 1.0);
      // Accelerates and decelerates smoothly, at an uneven pace.
      const double soft = share - std::sin(2.0 * M_PI * share) / (2.0 * M_PI);
      const double mixed = 0.5 * (share + soft);
      const double way =
          mixed + uneven / (2.0 * M_PI) * (std::sin(2.0 * M_PI * mixed + when) - std::sin(when));
      const double at = std::clamp(way, 0.0, 1.0) * (kPoints - 1);
      const auto index = std::min<std::size_t>(static_cast<std::size_t>(at), kPoints - 2);
      const Vector3d& a = line[index];
      return Vector3d(a + (at - static_cast<double>(index)) * (line[index + 1] - a));
    };
  }

 private:
  double uniform(double low, double high) {
    return low + (high - low) * (random_() / 4294967296.0);
  }

  Line distort(const Line& gesture) {
    const double size = size_ * uniform(0.9, 1.1);
    const Eigen::Matrix3d turn =
        (Eigen::AngleAxisd(heading_ + uniform(-0.1, 0.1), Vector3d::UnitZ()) *
         Eigen::AngleAxisd(uniform(-0.15, 0.15), Vector3d::UnitY()))
            .toRotationMatrix();
    const Vector3d place(uniform(0.9, 1.6), uniform(0.9, 1.6), uniform(1.0, 1.5));
    // Random waves along the line, as of people who miss the corners.
    Eigen::Matrix3d phases, amplitudes;
    for (int i = 0; i < 9; ++i) {
      phases(i) = uniform(0.0, 2.0 * M_PI);
      amplitudes(i) = wobble_ * uniform(-1.0, 1.0);
    }
    Line line = evenly(gesture);
    for (int i = 0; i < kPoints; ++i) {
      Vector3d& point = line[static_cast<std::size_t>(i)];
      point.x() = aspect_ * point.x() + slant_ * point.z();
      for (int wave = 0; wave < 3; ++wave) {
        const double angle = 2.0 * M_PI * (wave + 1) * i / kPoints;
        for (int axis = 0; axis < 3; ++axis)
          point(axis) += amplitudes(axis, wave) * std::sin(angle + phases(axis, wave));
      }
      point = place + size * (turn * point);
    }
    return line;
  }

  /// Rounds the corners, as a moving hand does.
  Line round(const Line& line) const {
    const int reach = static_cast<int>(roundness_ * kPoints);
    Line result;
    for (int i = 0; i < kPoints; ++i) {
      const int span = std::min({reach, i, kPoints - 1 - i});
      Vector3d sum = Vector3d::Zero();
      for (int j = i - span; j <= i + span; ++j)
        sum += line[static_cast<std::size_t>(j)];
      result.push_back(sum / (2 * span + 1));
    }
    return result;
  }

  std::mt19937 random_;
  double size_, slant_, aspect_, heading_, roundness_, speed_, wobble_;
};

void writeTracked(const simulation::Description& description,
                  const Path& drawing,
                  double duration,
                  std::uint32_t seed,
                  const std::string& file) {
  const Path path = [&](double time) { return drawing(time - kRest); };
  Room room(description, {path}, {}, seed);
  Table table(file, {"x", "y", "z", "t_ms"});
  const auto take = [&](double at, const tracking::Snapshot& snapshot) {
    const double time = at - kRest;
    if (time < 0.0 || time > duration - kMargin || snapshot.leds.empty())
      return;
    const Vector3d position = 1e3 * snapshot.leds[0].position;
    table << position.x() << position.y() << position.z() << 1e3 * time;
  };
  trackImages(trueRig(description), {}, record(&room, duration + 2.0 * kRest), take);
  table.close();
}

void measure(const simulation::Description& description,
             const std::vector<Session>& people,
             const std::string& output) {
  for (const Session& person : people) {
    Hand hand(person.seed);
    const std::string name = format("person_%03d", person.number + 1);
    const std::filesystem::path folder = std::filesystem::path(output) / name;
    std::filesystem::create_directories(folder);
    for (const auto& [gesture, line] : gestures()) {
      double duration = 0.0;
      const Path drawing = hand.draw(line, &duration);
      writeTracked(description, drawing, duration, person.seed,
                   (folder / (gesture + ".csv")).string());
    }
  }
}

}  // namespace
}  // namespace wiimote_tracker::monte_carlo

int main(int argc, char** argv) {
  return wiimote_tracker::monte_carlo::runProgram(
      argc, argv,
      "Twelve gestures, each drawn once by every simulated person (--sessions of them) and "
      "tracked; --output is a folder for gesture_tool.",
      wiimote_tracker::monte_carlo::measure);
}
