// The paper's three circles at several speeds, tracked by unsynchronised cameras after the paper's
// calibration and after ours.
#include "calibrations.h"
#include "experiment.h"
#include "program.h"
#include "room.h"
#include "session.h"

#include "wiimote_tracker_triangulation/geometry/error.h"

#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::monte_carlo {
namespace {

constexpr double kSettling = 3.0;   // of clocks and tracks [s]
constexpr double kInterval = 0.05;  // between rows [s]
constexpr double kNear = 0.5;       // points farther off are not of the LED [m]

/// A calibration and the tracker mode.
struct Method {
  std::string name;
  geometry::Rig rig;
  estimators::EstimatorOptions options;
  bool by_arrival = false;  // whether the arrivals are the stamps, not the driver's estimates
};

/// Nothing if a camera of the session could not be solved.
template <typename Solver>
std::optional<geometry::Rig> solve(const PaperSession& session, const Solver& solver) {
  try {
    geometry::Rig rig = solver();
    // The waved LED was recorded with other clocks than the circles.
    for (geometry::RigCamera& camera : rig.cameras)
      camera.time_offset_rule = geometry::TimeOffsetRule::kNone;
    if (rig.cameras.size() == session.wave.cameras.size())
      return rig;
  } catch (const geometry::Error&) {
    // The table then lacks these rows.
  }
  return std::nullopt;
}

std::vector<Method> methodsOf(const simulation::Description& described,
                              const PaperSession& session) {
  estimators::EstimatorOptions tracks;
  estimators::EstimatorOptions instants;
  instants.tracker_mode = estimators::TrackerMode::kInstant;
  estimators::EstimatorOptions paper = instants;
  paper.instant.triangulation.method = geometry::TriangulationMethod::kMeanClosest;
  std::vector<Method> methods;
  const auto add = [&](const std::string& name, const std::optional<geometry::Rig>& rig,
                       const estimators::EstimatorOptions& options) {
    if (rig)
      methods.push_back({name, *rig, options});
  };
  const auto case_3 = [&](geometry::RayModel model) {
    return solve(session, [&] { return solvePaperCase(session, PaperCase::kC3, model).rig; });
  };
  const auto waved = solve(session, [&] { return solveWaved(session.wave); });
  const auto wand = solve(session, [&] { return solveWaved(session.wand); });
  add("C3_image_center", case_3(geometry::RayModel::kImageCenter), paper);
  add("C3_calibrated", case_3(geometry::RayModel::kCalibrated), paper);
  add("wave_instants", waved, instants);
  add("wave_tracks", waved, tracks);
  add("wand_tracks", wand, tracks);
  add("exact_tracks", trueRig(described), tracks);
  methods.push_back({"exact_arrivals", trueRig(described), tracks, true});
  return methods;
}

/// Writes the rows of one lap.
struct LapWriter {
  int session;
  std::size_t circle;
  double speed;  // [m/s]
  double phase;  // [rad]
  Table* table;

  double duration() const { return 2.0 * M_PI * kCircleRadius / speed; }

  Eigen::Vector3d position(double time) const {
    return onCircle(circle, phase + speed / kCircleRadius * time);
  }

  void follow(const Method& method, const std::vector<RoomImage>& images) const {
    double due = kSettling;
    trackImages(method.rig, method.options, images,
                [&](double time, const tracking::Snapshot& snapshot) {
                  if (time < due || time > kSettling + duration())
                    return;
                  due += kInterval * (1.0 + std::floor((time - due) / kInterval));
                  write(method, time, snapshot);
                });
  }

  void write(const Method& method, double time, const tracking::Snapshot& snapshot) const {
    const Eigen::Vector3d truth = position(time);
    Eigen::Vector3d measured = Eigen::Vector3d::Constant(std::nan(""));
    double nearest = kNear;
    for (const tracking::TrackedLed& led : snapshot.leds) {
      const double distance = (led.position - truth).norm();
      if (distance < nearest) {
        nearest = distance;
        measured = led.position;
      }
    }
    const Eigen::Vector3d center = circleCenters()[circle];
    *table << session << method.rig.cameras.size() << method.name << circle + 1 << speed << time
           << truth.x() << truth.y() << truth.z() << measured.x() << measured.y() << measured.z()
           << (measured - center).head<2>().norm() - kCircleRadius << measured.z() - center.z();
  }
};

void measureAll(const simulation::Description& description, const Session& session, Table* table) {
  for (const std::size_t count : {std::size_t(2), std::size_t(4)}) {
    if (count > description.cameras.size())
      continue;
    std::vector<std::size_t> cameras(count);
    std::iota(cameras.begin(), cameras.end(), std::size_t(0));
    const PaperSession drawn = drawPaperSession(description, cameras, session.seed);
    simulation::Description described = withCameras(description, count);
    for (std::size_t i = 0; i < count; ++i)
      described.cameras[i].camera = drawn.wave.cameras[i];
    const std::vector<Method> methods = methodsOf(described, drawn);
    for (std::size_t circle = 0; circle < circleCenters().size(); ++circle) {
      for (const double speed : {0.5, 1.0, 2.0}) {
        const LapWriter lap{session.number, circle, speed, 1e-3 * (session.seed % 6283), table};
        Room room(described, {[&](double time) { return lap.position(time); }},
                  session.seed + static_cast<std::uint32_t>(circle));
        const std::vector<RoomImage> images = record(&room, kSettling + lap.duration());
        const std::vector<RoomImage> by_arrival = stampedByArrival(images);
        for (const Method& method : methods)
          lap.follow(method, method.by_arrival ? by_arrival : images);
      }
    }
  }
}

}  // namespace
}  // namespace wiimote_tracker::monte_carlo

int main(int argc, char** argv) {
  return wiimote_tracker::monte_carlo::runProgram(
      argc, argv,
      "The paper's three circles at 0.5, 1 and 2 m/s, tracked by two and by four cameras after the "
      "paper's calibration and after others: a row every 50 ms.",
      {"session", "cameras", "method", "circle", "speed", "time", "true_x", "true_y", "true_z",
       "measured_x", "measured_y", "measured_z", "radial_error", "height_error"},
      wiimote_tracker::monte_carlo::measureAll);
}
