// Errors of a moving LED with unsynchronised cameras, and the benefit of estimated exposure times.
#include "paper/experiment.h"
#include "program.h"
#include "room.h"

#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker::monte_carlo {
namespace {

constexpr double kDuration = 8.0;     // of a session [s]
constexpr double kSettled = 3.0;      // start of the score, when clocks and tracks have settled [s]
constexpr double kNear = 0.5;         // points farther off are not of the LED [m]
constexpr double kLongestKept = 0.1;  // greatest age of a spot in use [s]

struct Score {
  double squared = 0.0;  // errors [m^2]
  int seen = 0;
  int instants = 0;

  void add(const Eigen::Vector3d* position, const Eigen::Vector3d& truth) {
    ++instants;
    if (!position || (*position - truth).norm() > kNear)
      return;
    squared += (*position - truth).squaredNorm();
    ++seen;
  }
};

/// By tracks.
Score follow(const geometry::Rig& rig, const std::vector<RoomImage>& images, const Path& path) {
  Score score;
  trackImages(rig, {}, images, [&](double time, const tracking::Snapshot& snapshot) {
    if (time < kSettled)
      return;
    const Eigen::Vector3d truth = path(time);
    const Eigen::Vector3d* nearest = nullptr;
    for (const tracking::TrackedLed& led : snapshot.leds) {
      if (!nearest || (led.position - truth).norm() < (*nearest - truth).norm())
        nearest = &led.position;
    }
    score.add(nearest, truth);
  });
  return score;
}

/// Without use of times: intersects the rays of every camera's latest image at each arrival. The
/// point is compared with the LED at the mean exposure time of its images, the best possible
/// choice.
Score intersectLatest(const geometry::Rig& rig,
                      const std::vector<RoomImage>& images,
                      const Path& path) {
  std::vector<const RoomImage*> latest(rig.cameras.size(), nullptr);
  geometry::TriangulationOptions options;
  options.method = geometry::TriangulationMethod::kMeanClosest;
  Score score;
  for (const RoomImage& image : images) {
    latest[image.camera] = &image;
    std::vector<geometry::Observation> observations;
    double time = 0.0;
    for (const RoomImage* last : latest) {
      if (!last || last->image.spots.empty() ||
          image.image.arrival - last->image.arrival > kLongestKept)
        continue;
      observations.push_back({&rig.cameras[last->camera].camera, last->image.spots[0].pixel});
      time += last->exposure;
    }
    if (observations.empty())
      continue;
    time /= static_cast<double>(observations.size());
    if (time < kSettled)
      continue;
    const auto point = geometry::triangulate(observations, options);
    score.add(point ? &point->position : nullptr, path(time));
  }
  return score;
}

void measure(const simulation::Description& description, const Session& session, Table* table) {
  const geometry::Rig rig = trueRig(description);
  for (const double speed : {0.5, 1.0, 2.0, 3.0}) {
    const double phase = 1e-3 * (session.seed % 6283);
    const Path path = [=](double time) {
      return onCircle(kUpperCircle, phase + speed / kCircleRadius * time);
    };
    for (const bool synchronised : {false, true}) {
      for (const auto& [stamping, name] : {std::make_pair(Stamping::kExact, "exact"),
                                           std::make_pair(Stamping::kEstimated, "estimated"),
                                           std::make_pair(Stamping::kArrival, "arrival")}) {
        const std::string stamps = name;
        RoomOptions options;
        options.synchronised = synchronised;
        options.stamping = stamping;
        Room room(description, {path}, options, session.seed);
        const std::vector<RoomImage> images = record(&room, kDuration);
        const double lateness = medianLateness(images);
        const auto write = [&](const std::string& method, const Score& score) {
          *table << session.number << speed << (synchronised ? "synchronised" : "own") << stamps
                 << method << 1e3 * std::sqrt(score.squared / score.seen)
                 << static_cast<double>(score.seen) / score.instants << 1e3 * lateness
                 << score.instants;
        };
        write("tracks", follow(rig, images, path));
        if (stamping == Stamping::kExact)  // it does not use stamps
          write("latest", intersectLatest(rig, images, path));
      }
    }
  }
}

}  // namespace
}  // namespace wiimote_tracker::monte_carlo

int main(int argc, char** argv) {
  return wiimote_tracker::monte_carlo::runProgram(
      argc, argv,
      "RMS error of a moving LED with synchronised and "
      "unsynchronised cameras, and with stamps that are exact, estimated, or the arrivals.",
      {"session", "speed_m_per_s", "clocks", "stamps", "method", "rms_mm", "seen_share",
       "lateness_ms", "instants"},
      wiimote_tracker::monte_carlo::measure);
}
