#include "wiimote_tracker_calibration/import/recording.h"

#include "wiimote_tracker_triangulation/geometry/error.h"

#include <array>
#include <cctype>
#include <cmath>
#include <list>
#include <map>
#include <set>

namespace wiimote_tracker::import {

namespace {

// Slots of a flydra row: X Y Z 1 u v 1.
constexpr std::size_t kCorrespondenceColumns = 7;

/// Letters, digits and underscores, a letter first: what ROS allows as a name.
std::string rosName(const std::string& text) {
  std::string name;
  for (const char c : text)
    name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return std::isalpha(static_cast<unsigned char>(name[0])) != 0 ? name : "camera_" + name;
}

std::vector<std::string> readNames(const std::string& folder, std::size_t count) {
  const std::string path = folder + "/camera_order.txt";
  std::vector<std::string> names;
  if (!fileExists(path)) {
    for (std::size_t i = 1; i <= count; ++i)
      names.push_back("camera_" + std::to_string(i));
    return names;
  }
  for (const std::string& line : readLines(path))
    names.push_back(rosName(line));
  if (names.size() != count)
    throw ImportError(path + " names " + std::to_string(names.size()) + " cameras, but " + folder +
                      "/Res.dat has " + std::to_string(count));
  if (std::set<std::string>(names.begin(), names.end()).size() != count)
    throw ImportError(path + " names a camera twice");
  return names;
}

/// Lines "key = number".
std::map<std::string, double> readKeys(const std::string& path) {
  std::map<std::string, double> keys;
  for (const std::string& line : readLines(path)) {
    const std::size_t equals = line.find('=');
    if (equals == std::string::npos)
      throw ImportError(path + ": '" + line + "' is not of the form key = number");
    const std::string key = line.substr(0, line.find_first_of(" \t="));
    const std::size_t value = line.find_first_not_of(" \t", equals + 1);
    keys[key] = parseNumber(value == std::string::npos ? "" : line.substr(value), path + " " + key);
  }
  return keys;
}

geometry::Intrinsics readIntrinsics(const std::string& path, double width, double height) {
  const std::map<std::string, double> keys = readKeys(path);
  const auto value = [&](const std::string& key) {
    const auto found = keys.find(key);
    if (found == keys.end())
      throw ImportError(path + " lacks " + key);
    return found->second;
  };
  for (const std::string zero : {"K12", "K21", "K31", "K32"}) {
    if (value(zero) != 0.0)
      throw ImportError(path + ": " + zero + " must be 0, skew is not supported");
  }
  if (value("K33") != 1.0)
    throw ImportError(path + ": K33 must be 1");
  geometry::Intrinsics intrinsics;
  intrinsics.width = static_cast<int>(width);
  intrinsics.height = static_cast<int>(height);
  intrinsics.fx = value("K11");
  intrinsics.fy = value("K22");
  intrinsics.cx = value("K13");
  intrinsics.cy = value("K23");
  const double k3 = keys.count("kc5") == 0 ? 0.0 : value("kc5");
  intrinsics.distortion = {value("kc1"), value("kc2"), value("kc3"), value("kc4"), k3};
  try {
    intrinsics.check();
  } catch (const geometry::Error& error) {
    throw ImportError(path + ": " + error.what());
  }
  return intrinsics;
}

double readMetersPerUnit(const std::string& folder) {
  const std::string path = folder + "/calibration_units.txt";
  if (!fileExists(path))
    return 1.0;
  const std::map<std::string, double> units = {
      {"meters", 1.0}, {"centimeters", 1e-2}, {"millimeters", 1e-3}};
  const std::vector<std::string> lines = readLines(path);
  const auto unit = lines.size() == 1 ? units.find(lines[0]) : units.end();
  if (unit == units.end())
    throw ImportError(path + " must hold one word: meters, centimeters or millimeters");
  return unit->second;
}

void requireFinite(const NumberTable& table, const std::string& path) {
  for (const std::vector<double>& row : table) {
    for (const double value : row) {
      if (!std::isfinite(value))
        throw ImportError(path + " must not hold NaN");
    }
  }
}

void readCenters(const std::string& folder, double meters_per_unit, Recording* recording) {
  for (const std::string name : {"/Cst.dat", "/original_cam_centers.dat"}) {
    const std::string path = folder + name;
    if (!fileExists(path))
      continue;
    const NumberTable table = readNumberTable(path, recording->cameras.size(), 3);
    requireFinite(table, path);
    for (std::size_t i = 0; i < table.size(); ++i)
      recording->cameras[i].center =
          meters_per_unit * Eigen::Vector3d(table[i][0], table[i][1], table[i][2]);
    return;
  }
}

void readProjections(const std::string& folder, Recording* recording) {
  const std::string path = folder + "/Pmatrices.dat";
  if (!fileExists(path))
    return;
  const NumberTable table = readNumberTable(path, 3 * recording->cameras.size(), 4);
  requireFinite(table, path);
  for (std::size_t i = 0; i < recording->cameras.size(); ++i) {
    ProjectionMatrix& projection = recording->cameras[i].projection.emplace();
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t column = 0; column < 4; ++column)
        projection(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) =
            table[3 * i + row][column];
    }
  }
}

/// NaN in either, or both 0: the camera did not see the light.
std::optional<Eigen::Vector2d> pixelOf(double x, double y) {
  if (std::isnan(x) || std::isnan(y) || (x == 0.0 && y == 0.0))
    return std::nullopt;
  return Eigen::Vector2d(x, y);
}

/// points.dat (x, y, w of each camera, a column per frame) and IdMat.dat (1 where seen).
void readFrames(const std::string& folder, Recording* recording) {
  const std::string path = folder + "/points.dat";
  const std::size_t cameras = recording->cameras.size();
  const NumberTable points = readNumberTable(path, 3 * cameras, 0);
  const std::size_t frames = points.front().size();
  const std::string visibility_path = folder + "/IdMat.dat";
  NumberTable visible(cameras, std::vector<double>(frames, 1.0));
  if (fileExists(visibility_path))
    visible = readNumberTable(visibility_path, cameras, frames);
  for (std::size_t frame = 0; frame < frames; ++frame) {
    Pixels pixels(cameras);
    for (std::size_t camera = 0; camera < cameras; ++camera) {
      const double weight = points[3 * camera + 2][frame];
      if (visible[camera][frame] == 0.0 || std::isnan(weight) || weight == 0.0)
        continue;
      if (weight != 1.0)
        throw ImportError(path + " row " + std::to_string(3 * camera + 3) + " column " +
                          std::to_string(frame + 1) + " must be 1, 0 or NaN");
      pixels[camera] = pixelOf(points[3 * camera][frame], points[3 * camera + 1][frame]);
    }
    recording->frames.push_back(pixels);
  }
}

/// camN.points4cal.dat: a row per point that camera N saw, with the point's place in space, by
/// which the rows of all cameras belong together. The order of each file is kept.
void readCorrespondences(const std::string& folder, double meters_per_unit, Recording* recording) {
  struct Frame {
    Eigen::Vector3d point;
    Pixels pixels;
  };
  const std::size_t cameras = recording->cameras.size();
  std::list<Frame> frames;
  std::map<std::array<double, 3>, std::list<Frame>::iterator> by_point;
  for (std::size_t camera = 0; camera < cameras; ++camera) {
    const std::string path = folder + "/cam" + std::to_string(camera + 1) + ".points4cal.dat";
    const NumberTable table = readNumberTable(path, 0, kCorrespondenceColumns);
    requireFinite(table, path);
    auto next = frames.begin();
    for (std::size_t row = 0; row < table.size(); ++row) {
      const std::vector<double>& v = table[row];
      if (v[3] != 1.0 || v[6] != 1.0)
        throw ImportError(path + " row " + std::to_string(row + 1) +
                          " must have 1 in the columns 4 and 7");
      const auto [entry, is_new] = by_point.try_emplace({v[0], v[1], v[2]}, next);
      if (is_new)
        entry->second = frames.insert(
            next, {meters_per_unit * Eigen::Vector3d(v[0], v[1], v[2]), Pixels(cameras)});
      entry->second->pixels[camera] = pixelOf(v[4], v[5]);
      next = std::next(entry->second);
    }
  }
  for (const Frame& frame : frames) {
    recording->points.push_back(frame.point);
    recording->frames.push_back(frame.pixels);
  }
}

}  // namespace

Recording readRecording(const std::string& folder, bool intrinsics_required) {
  const std::string sizes_path = folder + "/Res.dat";
  const NumberTable sizes = readNumberTable(sizes_path, 0, 2);
  const std::vector<std::string> names = readNames(folder, sizes.size());
  const double meters_per_unit = readMetersPerUnit(folder);
  const auto lens_path = [&](std::size_t camera) {
    return folder + "/basename" + std::to_string(camera + 1) + ".rad";
  };
  const bool has_intrinsics = intrinsics_required || fileExists(lens_path(0));
  Recording recording;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    for (const double length : sizes[i]) {
      if (!(length >= 1.0 && length <= 1e5 && length == std::floor(length)))
        throw ImportError(sizes_path + " row " + std::to_string(i + 1) +
                          " must hold the width and height of an image [px]");
    }
    RecordedCamera camera;
    camera.name = names[i];
    camera.has_intrinsics = has_intrinsics;
    camera.intrinsics.width = static_cast<int>(sizes[i][0]);
    camera.intrinsics.height = static_cast<int>(sizes[i][1]);
    if (has_intrinsics)
      camera.intrinsics = readIntrinsics(lens_path(i), sizes[i][0], sizes[i][1]);
    recording.cameras.push_back(camera);
  }
  readCenters(folder, meters_per_unit, &recording);
  readProjections(folder, &recording);
  if (fileExists(folder + "/points.dat"))
    readFrames(folder, &recording);
  else if (fileExists(folder + "/cam1.points4cal.dat"))
    readCorrespondences(folder, meters_per_unit, &recording);
  else
    throw ImportError(folder + " holds neither points.dat nor cam1.points4cal.dat");
  return recording;
}

bundle::Reconstruction observedBy(const Recording& recording) {
  bundle::Reconstruction observed;
  for (const RecordedCamera& recorded : recording.cameras) {
    geometry::Camera& camera = observed.cameras.emplace_back();
    camera.name = recorded.name;
    camera.intrinsics = recorded.intrinsics;
  }
  observed.points.resize(recording.frames.size());
  for (std::size_t frame = 0; frame < recording.frames.size(); ++frame) {
    for (std::size_t camera = 0; camera < recording.cameras.size(); ++camera) {
      if (const auto& pixel = recording.frames[frame][camera])
        observed.observations.push_back({camera, frame, *pixel});
    }
  }
  return observed;
}

}  // namespace wiimote_tracker::import
