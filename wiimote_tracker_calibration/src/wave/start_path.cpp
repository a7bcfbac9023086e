#include "steps.h"

#include "capture/views.h"
#include "wave/error.h"

#include <wiimote_tracker_msgs/median.h>
#include <wiimote_tracker_msgs/text.h>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace wiimote_tracker::wave {

namespace {

// Clocks may be off by this much: the path is defined for as much longer than the frames [s].
constexpr double kMargin = 0.2;
// A frame this close to an instant counts as of that instant [s].
constexpr double kSameInstant = 0.008;
// Start poses, time offsets and unequal instants put a spot off by up to this [px].
constexpr double kTolerance = 25.0;
// Pairs of spots are formed among this many cameras; the others only confirm.
constexpr std::size_t kPairedCameras = 6;
// Two assignments of two LEDs whose errors differ by less than this are ambiguous [px].
constexpr double kTellApart = 6.0;
// Share by which the distance of the LEDs may differ from the wand's length at the start.
constexpr double kLengthTolerance = 0.2;
// An LED that vanished for longer may come back as the other one [s].
constexpr double kLongestGap = 0.3;
// Fewest places to start from.
constexpr std::size_t kLeastPlaces = 40;

const Eigen::Vector2d kUnknownVelocity =
    Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
using Spot = capture::View;  // Its velocity is not known: NaN.

/// A point in space that two or more spots of different cameras agree on.
struct Point {
  Eigen::Vector3d position;
  std::vector<std::size_t> spots;  // indices
  double error;                    // [px]
};

/// LED or LEDs at one time.
struct Instant {
  double time;
  std::vector<Eigen::Vector3d> leds;
};

std::optional<geometry::TriangulatedPoint> triangulate(const std::vector<geometry::Camera>& cameras,
                                                       const std::vector<Spot>& spots,
                                                       const std::vector<std::size_t>& chosen) {
  std::vector<Spot> views;
  for (std::size_t i : chosen)
    views.push_back(spots[i]);
  const auto found = capture::locate(cameras, views, kTolerance, chosen.size());
  return found ? std::make_optional(found->point) : std::nullopt;
}

/// Extends two spots by those of other cameras that lie where their point is seen.
std::optional<Point> pointOf(const std::vector<geometry::Camera>& cameras,
                             const std::vector<Spot>& spots,
                             std::size_t first,
                             std::size_t second) {
  auto point = triangulate(cameras, spots, {first, second});
  if (!point)
    return std::nullopt;
  std::vector<std::size_t> chosen = {first, second};
  for (std::size_t i = 0; i < spots.size();) {
    const std::size_t camera = spots[i].camera;
    const auto pixel = cameras[camera].project(point->position);
    double nearest = kTolerance;
    std::optional<std::size_t> match;
    for (; i < spots.size() && spots[i].camera == camera; ++i) {
      const double distance =
          pixel ? (*pixel - spots[i].pixel).norm() : std::numeric_limits<double>::infinity();
      if (distance < nearest) {
        nearest = distance;
        match = i;
      }
    }
    if (match && camera != spots[first].camera && camera != spots[second].camera)
      chosen.push_back(*match);
  }
  if (chosen.size() > 2) {
    const auto together = triangulate(cameras, spots, chosen);
    if (together)
      point = together;
    else
      chosen.resize(2);
  }
  return Point{point->position, chosen, point->reprojection_error};
}

/// All points that explain spots of two cameras or more, those that explain most first.
std::vector<Point> pointsOf(const std::vector<geometry::Camera>& cameras,
                            const std::vector<Spot>& spots) {
  std::vector<Point> points;
  std::size_t limit = 0;
  std::size_t seen = 0;
  for (; limit < spots.size(); ++limit) {
    seen += limit == 0 || spots[limit].camera != spots[limit - 1].camera ? 1 : 0;
    if (seen > kPairedCameras)
      break;
  }
  for (std::size_t i = 0; i < limit; ++i) {
    for (std::size_t j = i + 1; j < limit; ++j) {
      if (spots[i].camera == spots[j].camera)
        continue;
      if (auto point = pointOf(cameras, spots, i, j))
        points.push_back(std::move(*point));
    }
  }
  std::stable_sort(points.begin(), points.end(), [](const Point& a, const Point& b) {
    return a.spots.size() != b.spots.size() ? a.spots.size() > b.spots.size() : a.error < b.error;
  });
  return points;
}

bool disjoint(const Point& a, const Point& b) {
  return std::none_of(a.spots.begin(), a.spots.end(), [&](std::size_t spot) {
    return std::find(b.spots.begin(), b.spots.end(), spot) != b.spots.end();
  });
}

/// Two points of different spots that may be the ends of the wand.
struct Ends {
  const Point* first;
  const Point* second;

  double distance() const { return (first->position - second->position).norm(); }
  std::size_t support() const { return first->spots.size() + second->spots.size(); }
  double error() const { return first->error + second->error; }
};

std::vector<Ends> possibleEnds(const std::vector<Point>& points, double length) {
  std::vector<Ends> all;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      const Ends ends{&points[i], &points[j]};
      const double distance = ends.distance();
      const bool wrong = std::abs(distance - length) > kLengthTolerance * length;  // false of NaN
      if (disjoint(points[i], points[j]) && distance != 0.0 && !wrong)
        all.push_back(ends);
    }
  }
  return all;
}

/// Whether the same two points were found from other spots.
bool areSame(const Ends& a, const Ends& b) {
  const auto apart = [](const Point* one, const Point* other) {
    return (one->position - other->position).norm();
  };
  return std::min(apart(a.first, b.first) + apart(a.second, b.second),
                  apart(a.first, b.second) + apart(a.second, b.first)) < 0.2 * a.distance();
}

/// The two ends of the wand: the two points that explain most. Nothing when another assignment of
/// the spots is as good. @param length NaN: not known yet.
std::optional<std::pair<Eigen::Vector3d, Eigen::Vector3d>> wandEnds(
    const std::vector<Point>& points,
    double length) {
  const std::vector<Ends> all = possibleEnds(points, length);
  const auto best = std::min_element(all.begin(), all.end(), [](const Ends& a, const Ends& b) {
    return a.support() != b.support() ? a.support() > b.support() : a.error() < b.error();
  });
  if (best == all.end())
    return std::nullopt;
  const bool is_ambiguous = std::any_of(all.begin(), all.end(), [&](const Ends& other) {
    return other.support() == best->support() && other.error() - best->error() < kTellApart &&
           !areSame(other, *best);
  });
  if (is_ambiguous)
    return std::nullopt;
  return std::make_pair(best->first->position, best->second->position);
}

/// Spots of all cameras around each of the times, camera by camera.
class Instants {
 public:
  explicit Instants(const Recording& recording)
      : recording_(recording), next_(recording.cameras.size(), 0) {}

  /// Times must grow from call to call.
  const std::vector<Spot>& at(double time) {
    spots_.clear();
    for (std::size_t c = 0; c < next_.size(); ++c) {
      const std::vector<Frame>& frames = recording_.cameras[c].frames;
      const auto distance = [&](std::size_t i) { return std::abs(frames[i].stamp - time); };
      std::size_t& i = next_[c];
      while (i + 1 < frames.size() && distance(i + 1) <= distance(i))
        ++i;
      if (distance(i) > kSameInstant)
        continue;
      for (const Eigen::Vector2d& spot : frames[i].spots)
        spots_.push_back({c, spot, kUnknownVelocity});
    }
    return spots_;
  }

 private:
  const Recording& recording_;
  std::vector<std::size_t> next_;
  std::vector<Spot> spots_;
};

/// Tracks which of the wand's LEDs is which from instant to instant.
void keepLabels(std::vector<Instant>* instants) {
  for (std::size_t i = 1; i < instants->size(); ++i) {
    const Instant& before = (*instants)[i - 1];
    std::vector<Eigen::Vector3d>& leds = (*instants)[i].leds;
    if ((*instants)[i].time - before.time > kLongestGap)
      continue;
    const double kept = (leds[0] - before.leds[0]).norm() + (leds[1] - before.leds[1]).norm();
    const double swapped = (leds[1] - before.leds[0]).norm() + (leds[0] - before.leds[1]).norm();
    if (swapped < kept)
      std::swap(leds[0], leds[1]);
  }
}

void refuseFew(std::size_t places) {
  if (places < kLeastPlaces)
    throw WaveContradiction(
        "the LED was found in only " + counted(places, "place") +
        " that two cameras agree on: check that it is bright and that nobody moved a "
        "camera, and wave it where two cameras see it");
}

/// Scales cameras and LEDs by the wand. Leaves out instants at which its length is another.
void scaleByWand(double wand_length,
                 std::vector<Instant>* instants,
                 std::vector<geometry::Camera>* cameras) {
  const auto lengthAt = [](const Instant& instant) {
    return (instant.leds[0] - instant.leds[1]).norm();
  };
  std::vector<double> lengths;
  for (const Instant& instant : *instants)
    lengths.push_back(lengthAt(instant));
  const double length = medianOf(&lengths);
  const auto differs = [&](const Instant& instant) {
    return std::abs(lengthAt(instant) - length) > kLengthTolerance * length;
  };
  instants->erase(std::remove_if(instants->begin(), instants->end(), differs), instants->end());
  refuseFew(instants->size());
  const double scale = wand_length / length;
  for (Instant& instant : *instants) {
    for (Eigen::Vector3d& led : instant.leds)
      led *= scale;
  }
  for (geometry::Camera& camera : *cameras)
    camera.world_from_camera.translation() *= scale;
}

/// Control points of one LED's path, one per row: least squares over places of it and the prior of
/// its acceleration.
/// @param errors of the positions [m]. @param bend error of a second difference of the controls
/// [m].
Eigen::MatrixX3d controlsThrough(const std::vector<Trajectory::Place>& places,
                                 const std::vector<Eigen::Vector3d>& positions,
                                 const std::vector<double>& errors,
                                 double bend,
                                 Eigen::Index controls) {
  const auto count = static_cast<Eigen::Index>(places.size());
  std::vector<Eigen::Triplet<double>> design;
  Eigen::MatrixX3d target = Eigen::MatrixX3d::Zero(count + controls - 2, 3);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (Eigen::Index k = 0; k < 4; ++k)
      design.emplace_back(row, places[i].first + k, places[i].value(k) / errors[i]);
    target.row(row) = positions[i].transpose() / errors[i];
  }
  for (Eigen::Index k = 0; k + 2 < controls; ++k) {
    design.emplace_back(count + k, k, 1.0 / bend);
    design.emplace_back(count + k, k + 1, -2.0 / bend);
    design.emplace_back(count + k, k + 2, 1.0 / bend);
  }
  Eigen::SparseMatrix<double> by_controls(target.rows(), controls);
  by_controls.setFromTriplets(design.begin(), design.end());
  const Eigen::SparseMatrix<double> information = by_controls.transpose() * by_controls;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(information);
  if (solver.info() != Eigen::Success)
    refuseFew(0);
  const Eigen::MatrixX3d right = by_controls.transpose() * target;
  return solver.solve(right);
}

/// A spline for each LED through points with outliers: least squares, reweighted for the loss of
/// Geman and McClure (1985), whose scale shrinks from round to round.
void fitSplines(const std::vector<Instant>& instants, double acceleration, Trajectory* trajectory) {
  // Scale of the loss, round by round [m].
  const double kErrors[] = {1.0, 0.3, 0.1, 0.05, 0.05};
  const double bend = trajectory->spacing() * trajectory->spacing() * acceleration;
  std::vector<Trajectory::Place> places;
  for (const Instant& instant : instants)
    places.push_back(*trajectory->at(instant.time));
  for (Eigen::Index led = 0; led < trajectory->leds(); ++led) {
    std::vector<Eigen::Vector3d> positions;
    for (const Instant& instant : instants)
      positions.push_back(instant.leds[static_cast<std::size_t>(led)]);
    std::vector<double> distances(instants.size(), 0.0);  // of the points from the spline [m]
    for (const double error : kErrors) {
      std::vector<double> errors;
      for (const double distance : distances)
        errors.push_back(error + distance * distance / error);
      auto controls = trajectory->controls().middleRows<3>(3 * led);
      controls = controlsThrough(places, positions, errors, bend, controls.cols()).transpose();
      for (std::size_t i = 0; i < places.size(); ++i)
        distances[i] = (trajectory->position(places[i], led) - positions[i]).norm();
    }
  }
}

}  // namespace

Trajectory startPath(const Recording& recording,
                     const WaveOptions& options,
                     std::vector<geometry::Camera>* cameras) {
  const auto [start, end] = recording.span();
  const bool wand = recording.wand.has_value();
  const double length =
      wand && recording.square ? recording.wand->length : std::numeric_limits<double>::quiet_NaN();
  Instants views(recording);
  std::vector<Instant> instants;
  for (double time = start; time <= end; time += 0.5 * options.knot_spacing) {
    const std::vector<Point> points = pointsOf(*cameras, views.at(time));
    if (wand) {
      if (const auto ends = wandEnds(points, length))
        instants.push_back({time, {ends->first, ends->second}});
    } else if (!points.empty()) {
      instants.push_back({time, {points.front().position}});
    }
  }
  refuseFew(instants.size());

  if (wand) {
    keepLabels(&instants);
    if (!recording.square)
      scaleByWand(recording.wand->length, &instants, cameras);
  }
  Trajectory trajectory(start - kMargin, end + kMargin, options.knot_spacing, wand ? 2 : 1);
  fitSplines(instants, options.acceleration, &trajectory);
  return trajectory;
}

}  // namespace wiimote_tracker::wave
