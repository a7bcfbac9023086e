#include "session/join_rigs.h"

#include "place/chi_squared.h"
#include "session/error.h"

#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/point_sensitivity.h>
#include <wiimote_tracker_triangulation/geometry/so3.h>

#include <Eigen/Cholesky>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <utility>

namespace wiimote_tracker::session {

namespace {

namespace so3 = geometry::so3;

// A larger angle between the gravity readings of a shared camera means that it was moved [rad].
constexpr double kTurned = 0.05;
// Minimum width of the places relative to their length: on a line the rotation is not determined.
constexpr double kThinnest = 0.05;
// Smallest standard deviation [rad, m]: keeps covariances invertible if a parameter was held.
constexpr double kLeastStddev = 1e-5;

std::string listOf(const std::vector<std::string>& words) {
  std::string list;
  for (std::size_t i = 0; i < words.size(); ++i)
    list += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
  return list;
}

/// Linearised conditions: residual + by_motion * m + by_first * a + by_second * b + noise = 0, with
/// the errors (true minus estimated) m of the motion between the worlds (rotation about the first
/// world's axes, translation), a and b of the parameters of both rigs.
struct Conditions {
  Eigen::VectorXd residual;
  Eigen::MatrixXd by_motion;
  Eigen::MatrixXd by_first;
  Eigen::MatrixXd by_second;
  Eigen::VectorXd variance;  ///< Of the noise.

  Conditions(Eigen::Index rows, const geometry::Rig& first, const geometry::Rig& second)
      : residual(Eigen::VectorXd::Zero(rows)),
        by_motion(Eigen::MatrixXd::Zero(rows, 6)),
        by_first(Eigen::MatrixXd::Zero(rows, first.covariance.cols())),
        by_second(Eigen::MatrixXd::Zero(rows, second.covariance.cols())),
        variance(Eigen::VectorXd::Constant(rows, kLeastStddev * kLeastStddev)) {}
};

/// What both rigs share, as conditions on the motion between them.
class Joint {
 public:
  Joint(const geometry::Rig& first, const geometry::Rig& second) : first_(first), second_(second) {}
  virtual ~Joint() = default;

  virtual std::size_t count() const = 0;
  virtual Eigen::Isometry3d start() const = 0;
  /// Linearised at a motion, without the shared thing of index left_out (none if >= count()).
  virtual Conditions conditions(const Eigen::Isometry3d& first_from_second,
                                std::size_t left_out) const = 0;

 protected:
  const geometry::Rig& first_;
  const geometry::Rig& second_;
};

/// Cameras of both rigs: six conditions each.
class SharedCameras : public Joint {
 public:
  using Joint::Joint;

  void add(std::size_t in_first, std::size_t in_second) {
    pairs_.emplace_back(in_first, in_second);
  }

  std::size_t count() const override { return pairs_.size(); }

  Eigen::Isometry3d start() const override {
    return pose(first_, pairs_[0].first) * pose(second_, pairs_[0].second).inverse();
  }

  Conditions conditions(const Eigen::Isometry3d& motion, std::size_t left_out) const override {
    const std::size_t used = count() - (left_out < count() ? 1 : 0);
    Conditions result(6 * static_cast<Eigen::Index>(used), first_, second_);
    Eigen::Index row = 0;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      if (i == left_out)
        continue;
      const Eigen::Isometry3d expected = pose(first_, pairs_[i].first);
      const Eigen::Isometry3d second = pose(second_, pairs_[i].second);
      const Eigen::Isometry3d moved = motion * second;
      const Eigen::Index first_column = geometry::firstParameter(pairs_[i].first);
      const Eigen::Index second_column = geometry::firstParameter(pairs_[i].second);
      result.residual.segment<3>(row) = so3::log(moved.linear() * expected.linear().transpose());
      result.residual.segment<3>(row + 3) = moved.translation() - expected.translation();
      result.by_motion.block<6, 6>(row, 0).setIdentity();
      result.by_motion.block<3, 3>(row + 3, 0) = -so3::skew(motion.linear() * second.translation());
      result.by_first.block<6, 6>(row, first_column) = -Eigen::Matrix<double, 6, 6>::Identity();
      result.by_second.block<3, 3>(row, second_column + geometry::kRotation) = motion.linear();
      result.by_second.block<3, 3>(row + 3, second_column + geometry::kPosition) = motion.linear();
      row += 6;
    }
    return result;
  }

 private:
  static Eigen::Isometry3d pose(const geometry::Rig& rig, std::size_t camera) {
    return rig.cameras[camera].camera.world_from_camera;
  }

  std::vector<std::pair<std::size_t, std::size_t>> pairs_;
};

/// Places known in the first world and measured with the second rig: three conditions each.
class SharedPlaces : public Joint {
 public:
  SharedPlaces(const geometry::Rig& first,
               const geometry::Rig& second,
               const std::vector<CommonPlace>& places)
      : Joint(first, second), places_(places) {
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto derivative = geometry::pointByParameters(
          second, places[i].in_second, geometry::camerasSeeing(second, places[i].in_second));
      if (!derivative)
        throw SessionError("no two cameras of the second rig look at place " +
                           std::to_string(i + 1) + ": measure places that they see");
      derivatives_.push_back(*derivative);
    }
  }

  std::size_t count() const override { return places_.size(); }

  Eigen::Isometry3d start() const override {
    Eigen::Matrix3Xd from(3, places_.size());
    Eigen::Matrix3Xd to(3, places_.size());
    for (std::size_t i = 0; i < places_.size(); ++i) {
      from.col(static_cast<Eigen::Index>(i)) = places_[i].in_second;
      to.col(static_cast<Eigen::Index>(i)) = places_[i].in_first;
    }
    return Eigen::Isometry3d(Eigen::umeyama(from, to, false));
  }

  Conditions conditions(const Eigen::Isometry3d& motion, std::size_t left_out) const override {
    const std::size_t used = count() - (left_out < count() ? 1 : 0);
    Conditions result(3 * static_cast<Eigen::Index>(used), first_, second_);
    Eigen::Index row = 0;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      if (i == left_out)
        continue;
      const CommonPlace& place = places_[i];
      result.residual.segment<3>(row) = motion * place.in_second - place.in_first;
      result.by_motion.block<3, 3>(row, 0) = -so3::skew(motion.linear() * place.in_second);
      result.by_motion.block<3, 3>(row, 3).setIdentity();
      result.by_second.middleRows<3>(row) = motion.linear() * derivatives_[i];
      result.variance.segment<3>(row).array() += place.stddev * place.stddev;
      row += 3;
    }
    return result;
  }

 private:
  const std::vector<CommonPlace>& places_;
  std::vector<Eigen::MatrixXd> derivatives_;
};

/// The best motion, and how its error depends on those of the rigs.
struct Motion {
  Eigen::Isometry3d first_from_second;
  Eigen::MatrixXd gain;  ///< error = -gain * (by_first * a + by_second * b + noise).
  double chi_squared = 0.0;
  int degrees_of_freedom = 0;
};

/// Generalised least squares by Gauss-Newton, weighted by the covariances of both rigs.
Motion fitMotion(const geometry::Rig& first,
                 const geometry::Rig& second,
                 const Joint& joint,
                 std::size_t left_out) {
  Motion motion;
  motion.first_from_second = joint.start();
  for (int iteration = 0;; ++iteration) {
    const Conditions conditions = joint.conditions(motion.first_from_second, left_out);
    Eigen::MatrixXd covariance = conditions.variance.asDiagonal();
    covariance += conditions.by_first * first.covariance * conditions.by_first.transpose();
    covariance += conditions.by_second * second.covariance * conditions.by_second.transpose();
    const Eigen::LDLT<Eigen::MatrixXd> weight(covariance);
    const Eigen::MatrixXd weighed = weight.solve(conditions.by_motion);
    const Eigen::Matrix<double, 6, 6> information = conditions.by_motion.transpose() * weighed;
    motion.gain = information.ldlt().solve(weighed.transpose());
    motion.chi_squared = conditions.residual.dot(weight.solve(conditions.residual));
    motion.degrees_of_freedom = static_cast<int>(conditions.residual.size()) - 6;
    const Eigen::Matrix<double, 6, 1> step = -motion.gain * conditions.residual;
    if (!step.allFinite())
      throw SessionError("what the rigs share does not tell how one lies in the other: share more");
    if (step.norm() < 1e-10 || iteration == 20)
      return motion;
    motion.first_from_second.linear() =
        Eigen::Quaterniond(so3::exp(step.head<3>()) * motion.first_from_second.linear())
            .normalized()
            .toRotationMatrix();
    motion.first_from_second.translation() += step.tail<3>();
  }
}

bool contradicts(const Motion& motion) {
  return motion.degrees_of_freedom > 0 &&
         motion.chi_squared >
             place::chiSquaredQuantile(motion.degrees_of_freedom, place::kThreeNines);
}

/// Index of the shared thing without which the rest fits best.
std::size_t oddOneOut(const geometry::Rig& first, const geometry::Rig& second, const Joint& joint) {
  std::size_t odd = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < joint.count(); ++i) {
    const double without = fitMotion(first, second, joint, i).chi_squared;
    if (without < least) {
      least = without;
      odd = i;
    }
  }
  return odd;
}

/// Offset of the second rig's clock from the first's, from shared cameras with known time offsets.
struct ClockShift {
  double shift = 0.0;
  std::vector<std::pair<std::size_t, std::size_t>> cameras;  ///< Empty: not known.
};

ClockShift clockShift(const geometry::Rig& first, const geometry::Rig& second) {
  ClockShift result;
  for (std::size_t i = 0; i < first.cameras.size(); ++i) {
    for (std::size_t j = 0; j < second.cameras.size(); ++j) {
      const geometry::RigCamera& a = first.cameras[i];
      const geometry::RigCamera& b = second.cameras[j];
      const double shift = a.time_offset - b.time_offset;
      if (a.camera.name != b.camera.name || !std::isfinite(shift) ||
          a.time_offset_rule != b.time_offset_rule ||
          a.time_offset_rule == geometry::TimeOffsetRule::kNone ||
          (a.time_offset_rule == geometry::TimeOffsetRule::kOneEpoch &&
           a.time_offset_epoch != b.time_offset_epoch))
        continue;
      result.shift += shift;
      result.cameras.emplace_back(i, j);
    }
  }
  if (!result.cameras.empty())
    result.shift /= static_cast<double>(result.cameras.size());
  return result;
}

Eigen::Index offsetParameter(std::size_t camera) {
  return geometry::firstParameter(camera) + geometry::kTimeOffset;
}

/// The first rig with the second's other cameras, moved into its world.
geometry::Rig joined(const geometry::Rig& first,
                     const geometry::Rig& second,
                     const Motion& motion,
                     const Conditions& conditions) {
  const Eigen::Isometry3d& moved = motion.first_from_second;
  const ClockShift clock = clockShift(first, second);
  geometry::Rig rig = first;
  // Derivatives of the result's errors by those of both rigs and by the noise.
  const Eigen::Index most = first.covariance.rows() + second.covariance.rows();
  Eigen::MatrixXd by_first = Eigen::MatrixXd::Zero(most, first.covariance.rows());
  Eigen::MatrixXd by_second = Eigen::MatrixXd::Zero(most, second.covariance.rows());
  Eigen::MatrixXd by_noise = Eigen::MatrixXd::Zero(most, conditions.variance.size());
  by_first.topRows(first.covariance.rows()).setIdentity();
  Eigen::Index row = first.covariance.rows();
  for (std::size_t j = 0; j < second.cameras.size(); ++j) {
    if (first.find(second.cameras[j].camera.name))
      continue;
    geometry::RigCamera camera = second.cameras[j];
    const Eigen::Vector3d turned = moved.linear() * camera.camera.center();
    const Eigen::Index column = geometry::firstParameter(j);
    by_second.block<geometry::kParameters, geometry::kParameters>(row, column).setIdentity();
    by_second.block<3, 3>(row, column) = moved.linear();
    by_second.block<3, 3>(row + 3, column + 3) = moved.linear();
    Eigen::Matrix<double, 6, 6> by_motion = Eigen::Matrix<double, 6, 6>::Identity();
    by_motion.block<3, 3>(3, 0) = -so3::skew(turned);
    const Eigen::MatrixXd by_conditions = -by_motion * motion.gain;
    by_first.middleRows<6>(row) += by_conditions * conditions.by_first;
    by_second.middleRows<6>(row) += by_conditions * conditions.by_second;
    by_noise.middleRows<6>(row) = by_conditions;
    const Eigen::Index offset = row + geometry::kTimeOffset;
    for (const auto& shared : clock.cameras) {
      const double share = 1.0 / static_cast<double>(clock.cameras.size());
      by_first(offset, offsetParameter(shared.first)) += share;
      by_second(offset, offsetParameter(shared.second)) -= share;
    }
    if (clock.cameras.empty()) {
      by_second.row(offset).setZero();
      camera.time_offset = std::numeric_limits<double>::quiet_NaN();
      camera.time_offset_rule = geometry::TimeOffsetRule::kNone;
    } else {
      camera.time_offset += clock.shift;
    }
    camera.camera.world_from_camera = moved * camera.camera.world_from_camera;
    camera.camera.world_from_camera.linear() =
        Eigen::Quaterniond(camera.camera.world_from_camera.linear())
            .normalized()
            .toRotationMatrix();
    rig.cameras.push_back(camera);
    row += geometry::kParameters;
  }
  by_first.conservativeResize(row, Eigen::NoChange);
  by_second.conservativeResize(row, Eigen::NoChange);
  by_noise.conservativeResize(row, Eigen::NoChange);
  const Eigen::MatrixXd covariance =
      by_first * first.covariance * by_first.transpose() +
      by_second * second.covariance * by_second.transpose() +
      by_noise * conditions.variance.asDiagonal() * by_noise.transpose();
  rig.covariance = 0.5 * (covariance + covariance.transpose());
  return rig;
}

void checkRigs(const geometry::Rig& first, const geometry::Rig& second) {
  first.check();
  second.check();
  if (first.id() == second.id())
    throw SessionError("both are the same rig, " + first.id() +
                       ": name the rig file of the other room");
  if (std::all_of(second.cameras.begin(), second.cameras.end(),
                  [&](const geometry::RigCamera& c) { return first.find(c.camera.name); }))
    throw SessionError(
        "all cameras of the second rig are in the first one already: there is nothing to join");
  for (const geometry::Rig* rig : {&first, &second}) {
    if (!geometry::hasCovariance(*rig))
      throw SessionError(std::string("the ") + (rig == &first ? "first" : "second") +
                         " rig does not say how certain its cameras are: calibrate it anew");
  }
  if (first.ray_model != second.ray_model)
    throw SessionError(
        "the rigs build their rays by different models: calibrate both with the same ray_model");
  for (const geometry::RigCamera& camera : second.cameras) {
    const std::string& identity = camera.camera.identity;
    const geometry::RigCamera* same = first.find(camera.camera.name);
    if (same && !identity.empty() && !same->camera.identity.empty() &&
        identity != same->camera.identity)
      throw SessionError(camera.camera.name + " is another device in the second rig (" + identity +
                         ") than in the first (" + same->camera.identity +
                         "): give it another name, or calibrate anew with the same device");
    for (const geometry::RigCamera& other : first.cameras) {
      if (!same && !identity.empty() && identity == other.camera.identity)
        throw SessionError("the device " + identity + " is called " + camera.camera.name +
                           " in the second rig, but " + other.camera.name +
                           " in the first: give it one name and calibrate anew");
    }
  }
}

void checkGravity(const geometry::RigCamera& first, const geometry::RigCamera& second) {
  if (!first.gravity || !second.gravity)
    return;
  const double angle =
      std::atan2(first.gravity->cross(*second.gravity).norm(), first.gravity->dot(*second.gravity));
  if (angle > kTurned)
    throw SessionError(first.camera.name + " was turned by " +
                       format("%.1f degrees", angle * 180.0 / M_PI) +
                       " between both calibrations, as its accelerometer tells: calibrate one of "
                       "the rooms anew");
}

JoinedRigs finish(const geometry::Rig& first,
                  const geometry::Rig& second,
                  const Joint& joint,
                  const Motion& motion,
                  const std::string& over) {
  JoinedRigs result;
  result.first_from_second = motion.first_from_second;
  result.chi_squared = motion.chi_squared;
  result.degrees_of_freedom = motion.degrees_of_freedom;
  result.rig =
      joined(first, second, motion, joint.conditions(motion.first_from_second, joint.count()));
  const std::size_t added = result.rig.cameras.size() - first.cameras.size();
  result.message = std::to_string(added) + (added == 1 ? " camera" : " cameras") +
                   " joined to the " + std::to_string(first.cameras.size()) +
                   " of the first rig over " + over;
  if (motion.degrees_of_freedom > 0)
    result.message += "; the rigs disagree " +
                      format("%.1f", std::sqrt(motion.chi_squared / motion.degrees_of_freedom)) +
                      " times as much as their uncertainties let expect";
  else
    result.message += "; nothing checks that it did not move in between, a second one would";
  result.rig.method = first.method + " joined with " + second.method;
  result.rig.verdict = result.message + "; first: " + first.verdict + "; second: " + second.verdict;
  result.rig.check();
  return result;
}

}  // namespace

JoinedRigs joinRigs(const geometry::Rig& first, const geometry::Rig& second) {
  checkRigs(first, second);
  SharedCameras joint(first, second);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < first.cameras.size(); ++i) {
    for (std::size_t j = 0; j < second.cameras.size(); ++j) {
      if (first.cameras[i].camera.name != second.cameras[j].camera.name)
        continue;
      checkGravity(first.cameras[i], second.cameras[j]);
      joint.add(i, j);
      names.push_back(first.cameras[i].camera.name);
    }
  }
  if (names.empty())
    throw SessionError(
        "the rigs share no camera: calibrate the second room together with a camera of the first "
        "that stays where it is, or measure three known places or more of the first world with the "
        "second rig");
  const Motion motion = fitMotion(first, second, joint, joint.count());
  if (contradicts(motion)) {
    const std::string advice =
        ": it was moved in between, or was calibrated badly; calibrate one of the rooms anew";
    if (names.size() == 2)
      throw SessionError(names[0] + " and " + names[1] +
                         " do not stand to each other in the second rig as in the first: one of "
                         "them was moved in between, or calibrated badly; calibrate one of the "
                         "rooms anew");
    throw SessionError(names[oddOneOut(first, second, joint)] +
                       " does not stand to the other shared cameras in the second rig as in the "
                       "first" +
                       advice);
  }
  JoinedRigs result = finish(first, second, joint, motion, listOf(names));
  result.shared = names;
  return result;
}

JoinedRigs joinRigs(const geometry::Rig& first,
                    const geometry::Rig& second,
                    const std::vector<CommonPlace>& places) {
  checkRigs(first, second);
  if (places.size() < 3)
    throw SessionError(std::to_string(places.size()) +
                       " common places do not tell how one rig lies in the other: measure three or "
                       "more, not on one line");
  Eigen::Matrix3Xd points(3, places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const CommonPlace& place = places[i];
    if (!place.in_first.allFinite() || !place.in_second.allFinite() ||
        !(std::isfinite(place.stddev) && place.stddev > 0.0))
      throw SessionError("place " + std::to_string(i + 1) +
                         " is not finite, or its standard deviation not above 0: correct it");
    points.col(static_cast<Eigen::Index>(i)) = place.in_second;
  }
  const Eigen::Matrix3Xd centered = points.colwise() - points.rowwise().mean();
  const Eigen::Vector3d extent =
      Eigen::JacobiSVD<Eigen::MatrixXd>(centered.transpose()).singularValues();
  if (!(extent[1] > kThinnest * extent[0]))
    throw SessionError("the common places are on one line: measure one beside it, too");
  const SharedPlaces joint(first, second, places);
  const Motion motion = fitMotion(first, second, joint, joint.count());
  if (contradicts(motion)) {
    if (places.size() == 3)
      throw SessionError(
          "the three common places do not lie to one another in the second rig as in the first: "
          "measure them again, and a fourth");
    throw SessionError("place " + std::to_string(oddOneOut(first, second, joint) + 1) +
                       " does not lie to the other common places in the second rig as in the "
                       "first: measure it again");
  }
  return finish(first, second, joint, motion, std::to_string(places.size()) + " common places");
}

}  // namespace wiimote_tracker::session
