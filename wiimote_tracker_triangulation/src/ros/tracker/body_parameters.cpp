#include "body_parameters.h"

#include "body/bodies_file.h"
#include "wiimote_tracker_triangulation/geometry/error.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>

namespace wiimote_tracker {
namespace {

std::vector<body::Constellation> readKnown(const std::string& file,
                                           const std::vector<std::string>& labels) {
  std::error_code unknown;  // such as a folder of others: reading says why
  if (file.empty() || (!std::filesystem::exists(file, unknown) && !unknown))
    return {};
  std::vector<body::Constellation> bodies = body::readBodies(file);
  for (const body::Constellation& body : bodies) {
    if (std::find(labels.begin(), labels.end(), body.name) != labels.end())
      throw Error("body '" + body.name + "' of " + file +
                  " has the name of an LED; rename one of them");
  }
  return bodies;
}

}  // namespace

BodyParameters BodyParameters::read(ParameterReader* reader,
                                    const tracking::ImageOptions& images,
                                    const std::vector<std::string>& labels) {
  BodyParameters p;
  reader->read("bodies/file", &p.file);
  try {
    p.known = readKnown(p.file, labels);
  } catch (const geometry::Error& error) {
    throw ParameterError(reader->nameOf("bodies/file") + ": " + error.what());
  }
  body::BodyTrackerOptions& o = p.options;
  static_cast<tracking::ImageOptions&>(o) = images;
  reader->read("bodies/gate", &o.gate, 4.0, 100.0);
  reader->read("bodies/tracked_time", &o.tracked_time, 0.001, 1.0);
  reader->read("bodies/prediction_time", &o.prediction_time, 0.01, 10.0);
  reader->read("bodies/window", &o.window, 0.001, 0.2);
  reader->read("bodies/window_motion", &o.window_motion, 1e-5, 0.1);
  reader->read("bodies/minimum_margin", &o.minimum_margin, 0.0, 1000.0);
  body::PoseFilterOptions& motion = o.motion;
  body::PoseMode& calm = motion.modes[body::kCalm];
  body::PoseMode& agile = motion.modes[body::kAgile];
  reader->read("bodies/calm_acceleration_density", &calm.acceleration_density, 0.0, 1000.0);
  reader->read("bodies/calm_angular_acceleration_density", &calm.angular_acceleration_density, 0.0,
               1000.0);
  reader->read("bodies/acceleration_density", &agile.acceleration_density, 0.0, 1000.0);
  reader->read("bodies/angular_acceleration_density", &agile.angular_acceleration_density, 0.0,
               1000.0);
  reader->read("bodies/change_rate", &motion.change_rate, 0.001, 1000.0);
  reader->read("bodies/initial_speed", &motion.initial_speed, 0.001, 1000.0);
  reader->read("bodies/initial_angular_speed", &motion.initial_angular_speed, 0.001, 1000.0);
  body::InertialOptions& imu = o.inertial;
  reader->read("bodies/gyro_density", &imu.gyro_density, 0.00001, 1.0);
  reader->read("bodies/accelerometer_density", &imu.accelerometer_density, 0.0001, 10.0);
  return p;
}

std::string describeMissingFile(const std::string& file) {
  std::error_code ignored;
  if (file.empty() || std::filesystem::exists(file, ignored))
    return "";
  return "There is no file " + std::filesystem::absolute(file).string() +
         ", so tracking starts without bodies: learn one with the service learn_body, which "
         "creates the file, or correct the parameter bodies/file";
}

std::vector<std::string> shapeWarnings(const std::vector<body::Constellation>& bodies) {
  std::vector<std::string> sentences;
  for (const body::Constellation& body : bodies) {
    const body::Symmetry symmetry = body::nearestSymmetry(body);
    if (symmetry.residual < body::kNearlySymmetric && body.labels.empty())
      sentences.push_back(body::describe(body, symmetry));
    if (const auto merging = body::describeMergingLeds(body))
      sentences.push_back(*merging);
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (const auto twins = body::describeTwins(bodies[k], bodies[i]))
        sentences.push_back(*twins);
    }
  }
  return sentences;
}

std::vector<std::string> labelWarnings(const std::vector<body::Constellation>& bodies,
                                       const std::vector<std::string>& codes) {
  std::vector<std::string> sentences;
  for (const body::Constellation& body : bodies) {
    std::vector<std::string> unknown;
    for (const std::string& label : body.labels) {
      if (std::find(codes.begin(), codes.end(), label) == codes.end())
        unknown.push_back(label);
    }
    if (!unknown.empty())
      sentences.push_back("body '" + body.name + "' has labels without a blink code (" +
                          joined(unknown) +
                          "), so that these LEDs are never identified: correct its labels, or "
                          "name the file of their codes in identity/codes");
  }
  return sentences;
}

}  // namespace wiimote_tracker
