// The paper's ten points, measured after the paper's calibrations and after ours, in each session.
#include "calibrations.h"
#include "program.h"
#include "session.h"

#include "wiimote_tracker_calibration/remap/fit.h"
#include "wiimote_tracker_calibration/simulation/wave_bound.h"
#include "wiimote_tracker_triangulation/geometry/calibration_uncertainty.h"
#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/remap/correction.h"

#include <wiimote_tracker_msgs/error.h>

#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker::monte_carlo {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

const std::vector<std::string> kPointColumns = {
    "session",   "cameras", "method", "ray_model", "point",      "nominal_x",  "nominal_y",
    "nominal_z", "true_x",  "true_y", "true_z",    "measured_x", "measured_y", "measured_z",
    "var_xx",    "var_xy",  "var_xz", "var_yy",    "var_yz",     "var_zz"};
const std::vector<std::string> kTraceColumns = {
    "session",  "cameras", "case",   "ray_model",    "round",        "camera",      "center_u",
    "center_v", "true_u",  "true_v", "difference_u", "difference_v", "origin_error"};

/// A measured point and its covariance [m, m^2].
struct Measured {
  Eigen::Vector3d position = Eigen::Vector3d::Constant(kUnknown);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Constant(kUnknown);
};

/// Cameras that measure together, numbered from 0, and their name in the tables.
struct CameraSet {
  std::string name;
  std::vector<std::size_t> cameras;
  bool ours;  ///< Whether to evaluate our methods, too.
};

/// Two neighbours and all four, as in the paper; and two opposite ones, since one sentence of the
/// paper speaks of opposite corners.
const std::vector<CameraSet> kCameraSets = {{"1 2", {0, 1}, true},
                                            {"1 3", {0, 2}, false},
                                            {"1 2 3 4", {0, 1, 2, 3}, true}};

/// Writes the rows of one session with one set of cameras.
struct SessionWriter {
  int number;
  std::string cameras;
  const PaperSession& session;
  double pixel;  // standard deviation of a coordinate [px]
  Table* points;
  Table* places;
  Table* traces;

  void writePaper() {
    writeCases(geometry::RayModel::kCalibrated, "calibrated");
    writeCases(geometry::RayModel::kImageCenter, "image_center");
  }

  void writeOurs() {
    const geometry::Rig square = solve([&] { return solveJointSquare(session); });
    writeSolved("square", square);
    writeRemapped("square_remapped", "calibrated", square, ourOptions());
    writeSolved("wave", solve([&] { return solveWaved(session.wave); }));
    writeSolved("wand", solve([&] { return solveWaved(session.wand); }));
    wave::SimulatedWave no_wave = session.wave;
    no_wave.views.clear();
    writeBound("bound_square", session.wave_scene, no_wave);
    writeBound("bound_wave", session.wave_scene, session.wave);
    writeBound("bound_wand", session.wand_scene, session.wand);
  }

  /// A rig without cameras, which measures nothing, if it cannot be solved.
  static geometry::Rig solve(const std::function<geometry::Rig()>& solver) {
    try {
      return solver();
    } catch (const geometry::Error&) {
      return {};
    }
  }

  geometry::TriangulationOptions ourOptions() const {
    geometry::TriangulationOptions options;
    options.pixel_stddev = pixel;
    return options;
  }

  static geometry::TriangulationOptions paperOptions() {
    geometry::TriangulationOptions options;
    options.method = geometry::TriangulationMethod::kMeanClosest;
    return options;
  }

  void writeCases(geometry::RayModel model, const std::string& model_name) {
    for (const auto& [which, name] :
         {std::make_pair(PaperCase::kC1, "C1"), std::make_pair(PaperCase::kC2, "C2"),
          std::make_pair(PaperCase::kC3, "C3"), std::make_pair(PaperCase::kC4, "C4"),
          std::make_pair(PaperCase::kC5, "C5")}) {
      const geometry::Rig rig = solve([&, which = which, name = name] {
        const principal_point::CorrectionResult result = solvePaperCase(session, which, model);
        writeTrace(name, model_name, result.trace);
        return result.rig;
      });
      writeMeasured(name, model_name, rig, paperOptions());
      if (which == PaperCase::kC1)
        writeRemapped("C1_remapped", model_name, rig, paperOptions());
    }
  }

  void writeSolved(const std::string& method, const geometry::Rig& rig) {
    const geometry::CalibrationUncertainty uncertainty(rig);
    const auto measure_point = [&](const StillLed& led) {
      Measured measured;
      const auto point = measure(session, rig, led, ourOptions());
      if (!point)
        return measured;
      measured.position = point->position;
      std::vector<std::size_t> seeing;
      for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
        if (rig.cameras[i].camera.sees(point->position))
          seeing.push_back(i);
      }
      const auto systematic =
          uncertainty.covarianceOf(point->position, seeing.data(), seeing.size());
      if (systematic)
        measured.covariance = point->covariance + *systematic;
      return measured;
    };
    write(session.points, method, "calibrated", measure_point, points);
    write(session.known_places, method, "calibrated", measure_point, places);
  }

  /// With a volume correction from 27 points, placed as precisely as an LED can be.
  void writeRemapped(const std::string& method,
                     const std::string& model_name,
                     const geometry::Rig& rig,
                     const geometry::TriangulationOptions& options) {
    std::optional<remap::Correction> correction;
    try {
      std::vector<remap::KnownPoint> known;
      for (const StillLed& led : session.known_places) {
        if (const auto point = measure(session, rig, led, options))
          known.push_back({point->position, led.nominal});
      }
      correction.emplace(remap::fitRemap(known, "simulated").remap, "simulated");
    } catch (const Error&) {
      // Without a valid correction the volume stays as it is.
    }
    writeMeasured(method, model_name, rig, options, correction);
  }

  void writeMeasured(const std::string& method,
                     const std::string& model_name,
                     const geometry::Rig& rig,
                     const geometry::TriangulationOptions& options,
                     const std::optional<remap::Correction>& correction = {}) {
    const auto measure_point = [&](const StillLed& led) {
      Measured measured;
      if (const auto point = measure(session, rig, led, options))
        measured.position = correction
                                ? correction->apply(point->position, point->covariance)->position
                                : point->position;
      return measured;
    };
    write(session.points, method, model_name, measure_point, points);
  }

  void writeBound(const std::string& method,
                  const wave::WaveScene& scene,
                  const wave::SimulatedWave& wave) {
    const double image_pixel = std::sqrt(scene.pixel * scene.pixel + 1.0 / 12.0);
    const Eigen::MatrixXd covariance =
        wave::waveBound(scene, wave, image_pixel, {session.points.front().truth}).covariance;
    const auto bound_of = [&](const StillLed& led) {
      Measured bound;
      if (const auto least = wave::pointBound(wave.cameras, covariance, led.truth, pixel))
        bound.covariance = *least;
      return bound;
    };
    write(session.points, method, "calibrated", bound_of, points);
  }

  void write(const std::vector<StillLed>& leds,
             const std::string& method,
             const std::string& model_name,
             const std::function<Measured(const StillLed&)>& measure_point,
             Table* table) {
    for (std::size_t p = 0; p < leds.size(); ++p) {
      const Measured measured = measure_point(leds[p]);
      *table << number << cameras << method << model_name << p + 1;
      for (const Eigen::Vector3d& place : {leds[p].nominal, leds[p].truth, measured.position})
        *table << place.x() << place.y() << place.z();
      for (Eigen::Index i = 0; i < 3; ++i) {
        for (Eigen::Index j = i; j < 3; ++j)
          *table << measured.covariance(i, j);
      }
    }
  }

  void writeTrace(const std::string& name,
                  const std::string& model_name,
                  const principal_point::Trace& trace) {
    for (std::size_t round = 0; round < trace.rounds.size(); ++round) {
      const principal_point::Round& values = trace.rounds[round];
      for (std::size_t i = 0; i < trace.cameras.size(); ++i) {
        std::size_t camera = 0;
        while (session.wave.cameras[camera].name != trace.cameras[i])
          ++camera;
        const geometry::Intrinsics& truth = session.wave.cameras[camera].intrinsics;
        *traces << number << cameras << name << model_name << round << camera + 1
                << values.principal_points[i].x() << values.principal_points[i].y() << truth.cx
                << truth.cy << values.differences[i].x() << values.differences[i].y()
                << values.origin_error;
      }
    }
  }
};

void measureAll(const simulation::Description& description,
                const std::vector<Session>& sessions,
                const std::string& output) {
  Table points(output + "/points.csv", kPointColumns);
  Table places(output + "/places.csv", kPointColumns);
  Table traces(output + "/traces.csv", kTraceColumns);
  for (const Session& one : sessions) {
    for (const CameraSet& set : kCameraSets) {
      if (set.cameras.back() >= description.cameras.size())
        continue;
      const PaperSession session = drawPaperSession(description, set.cameras, one.seed);
      SessionWriter writer{one.number, set.name, session, stillPixelStddev(description),
                           &points,    &places,  &traces};
      writer.writePaper();
      if (set.ours)
        writer.writeOurs();
    }
  }
  points.close();
  places.close();
  traces.close();
}

}  // namespace
}  // namespace wiimote_tracker::monte_carlo

int main(int argc, char** argv) {
  return wiimote_tracker::monte_carlo::runProgram(
      argc, argv,
      "The paper's ten points measured after the paper's calibrations (cases C1 to C5, both ray "
      "models) and after others, with two and with four cameras, and 27 places in the whole cube; "
      "writes points.csv, places.csv and traces.csv into the folder --output.",
      wiimote_tracker::monte_carlo::measureAll);
}
