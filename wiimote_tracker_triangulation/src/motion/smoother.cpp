#include "motion/smoother.h"

#include "motion/modes.h"
#include "motion/motion_filter.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace wiimote_tracker::motion {
namespace {

constexpr double kStartStddev = 0.5;  // of the position at which a filter starts [m]
constexpr double kMisfit = 100.0;     // squared Mahalanobis distance of an observation
constexpr std::size_t kChunk = 256;   // places
constexpr double kTogether = 0.05;    // between sightings by two cameras that locate an LED [s]

/// Updates with an observation at `time` in the filter's time. False if it does not fit.
bool update(const Observation& observation, double time, MotionFilter* filter) {
  filter->predict(time);
  const auto prediction = filter->predictPixel(*observation.camera, observation.noise);
  return prediction && prediction->squaredDistance(observation.pixel) < kMisfit &&
         filter->update(*observation.camera, *prediction, observation.pixel);
}

KinematicState reversed(KinematicState state) {
  state.mean.segment<3>(3) *= -1.0;
  state.covariance.middleRows<3>(3) *= -1.0;
  state.covariance.middleCols<3>(3) *= -1.0;
  return state;
}

/// The product of two normal distributions of the first components, divided by the prior of the
/// acceleration, which both contain: normal about 0.
/// @param size number of components: 3 (position), 6 (and velocity) or 9 (and acceleration)
/// @param prior variance of the acceleration
/// @returns log of the integral of the product of a and b, without its powers of 2 pi and without
/// dividing by the prior; nothing when the product is not normal
std::optional<double> multiply(const KinematicState& a,
                               const KinematicState& b,
                               Eigen::Index size,
                               double prior,
                               KinematicState* product) {
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(size, size);
  const Eigen::MatrixXd of_a = a.covariance.topLeftCorner(size, size);
  const Eigen::MatrixXd of_b = b.covariance.topLeftCorner(size, size);
  const Eigen::LLT<Eigen::MatrixXd> factors_a(of_a), factors_b(of_b), sum(of_a + of_b);
  const Eigen::VectorXd difference = b.mean.head(size) - a.mean.head(size);
  Eigen::MatrixXd information = factors_a.solve(identity) + factors_b.solve(identity);
  Eigen::VectorXd right = factors_b.solve(difference);  // information times the mean from a's
  if (size == 9) {
    information.diagonal().tail<3>().array() -= 1.0 / prior;
    right.tail<3>() += a.mean.tail<3>() / prior;
  }
  const Eigen::LLT<Eigen::MatrixXd> factors(information);
  if (factors_a.info() != Eigen::Success || factors_b.info() != Eigen::Success ||
      factors.info() != Eigen::Success)
    return std::nullopt;
  product->mean.setZero();
  product->covariance.setZero();
  product->mean.head(size) = a.mean.head(size) + factors.solve(right);
  product->covariance.topLeftCorner(size, size) = factors.solve(identity);
  return -0.5 * difference.dot(sum.solve(difference)) -
         sum.matrixLLT().diagonal().array().log().sum();
}

/// What both filters know together of the LED's state if it is in one mode.
/// @param a forwards. @param b backwards, but in the forward direction of time.
/// @returns log of the likelihood of the mode, up to a constant of all modes; nothing when the
/// product is not normal
std::optional<double> combineStates(const MotionOptions& options,
                                    int mode,
                                    const KinematicState& a,
                                    const KinematicState& b,
                                    KinematicState* product) {
  const double variance = accelerationVariance(options, mode);
  const bool has_acceleration = variance > 0.0;
  const Eigen::Index size = isAtRest(mode) ? 3 : has_acceleration ? 9 : 6;
  // A state that came from a more agile mode may know less of the acceleration than the mode's
  // prior. Then a wider prior is divided out, so that the product stays normal.
  const double known = b.covariance.diagonal().tail<3>().maxCoeff();
  const double prior = known < 1.01 * variance ? variance : 2.0 * known;
  const auto overlap = multiply(a, b, size, prior, product);
  if (!overlap)
    return std::nullopt;
  // Both contain the prior densities of velocity and acceleration, if the mode has them: one of
  // each is divided out, at 0. That over the product, as in the exact integral, would favour modes
  // whose prior nearly excludes the motion, since states that came from other modes do not have
  // this prior. Powers of 2 pi are then common to all modes.
  return *overlap + (isAtRest(mode) ? 0.0 : 3.0 * std::log(options.initial_speed)) +
         (has_acceleration ? 1.5 * std::log(variance) : 0.0);
}

/// What two filters of opposite directions in time know together of the LED at one time.
KinematicState combine(const MotionOptions& options,
                       const Modes& forwards,
                       const Modes& backwards) {
  const Modes initial = initialModes(options, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity());
  std::array<double, kModes> log_weights;
  log_weights.fill(-std::numeric_limits<double>::infinity());
  Modes products;
  for (int i = 0; i < kModes; ++i) {
    if (!(forwards[i].probability > 0.0 && backwards[i].probability > 0.0))
      continue;
    const auto log_likelihood = combineStates(options, i, forwards[i].state,
                                              reversed(backwards[i].state), &products[i].state);
    // Both contain the mode's prior probability.
    if (log_likelihood)
      log_weights[i] =
          *log_likelihood +
          std::log(forwards[i].probability * backwards[i].probability / initial[i].probability);
  }
  const double greatest = *std::max_element(log_weights.begin(), log_weights.end());
  if (!std::isfinite(greatest))
    return momentsOf(forwards);
  double sum = 0.0;
  for (int i = 0; i < kModes; ++i)
    sum += products[i].probability = std::exp(log_weights[i] - greatest);
  for (Mode& mode : products)
    mode.probability /= sum;
  return momentsOf(products);
}

/// The forward filters of all places would take 5 kB each. So only those at the beginnings of
/// chunks of places are kept, and each chunk is filtered again.
class Smoother {
 public:
  Smoother(const MotionOptions& options,
           const std::vector<Observation>& observations,
           const std::vector<Place>& places)
      : options_(options),
        observations_(observations),
        places_(places),
        backwards_(start(static_cast<Number>(observations.size()) - 1, kBackwards)) {}

  std::vector<KinematicState> run() {
    std::vector<KinematicState> states(places_.size());
    filterForwards();
    std::size_t end = places_.size();
    for (auto chunk = chunks_.rbegin(); chunk != chunks_.rend(); ++chunk) {
      smooth(*chunk, end, &states);
      end = chunk->first;
      if (chunk->misfit)
        backwards_ = start(*chunk->misfit - 1, kBackwards);
    }
    return states;
  }

 private:
  using Number = std::ptrdiff_t;

  enum Direction : Number { kBackwards = -1, kForwards = 1 };

  /// A filter, in its own direction of time, and the numbers of its first and next observation.
  struct Pass {
    MotionFilter filter;
    Number first;
    Number next;

    bool hasSeen() const { return next != first; }
  };
  struct Chunk {
    std::size_t first;             // place
    Pass forwards;                 // before that place
    std::optional<Number> misfit;  // the observation at which it started anew
  };

  bool exists(Number number) const {
    return number >= 0 && number < static_cast<Number>(observations_.size());
  }

  /// The first observation, from a number on in the direction, that another camera's soon follows:
  /// one camera alone does not tell how far away to start.
  Number located(Number number, Direction direction) const {
    for (; exists(number); number += direction) {
      const Observation& first = observations_[number];
      for (Number i = number + direction; exists(i); i += direction) {
        if (std::abs(observations_[i].time - first.time) >= kTogether)
          break;
        if (observations_[i].camera != first.camera)
          return number;
      }
    }
    return number;
  }

  MotionFilter filterAt(const Place& place, double time) const {
    return {options_, time, place.position,
            kStartStddev * kStartStddev * Eigen::Matrix3d::Identity()};
  }

  Pass start(Number number, Direction direction) const {
    number = located(number, direction);
    const Place& end = direction == kForwards ? places_.back() : places_.front();
    const double time = exists(number) ? observations_[number].time : end.time;
    const auto place =
        std::find_if(places_.begin(), places_.end() - 1, [&](auto& p) { return p.time >= time; });
    return {filterAt(*place, direction * time), number, number};
  }

  /// Filters up to a time. False at an observation that does not fit, which is then the next one.
  bool advance(double time, Pass* pass) const {
    for (; pass->next < static_cast<Number>(observations_.size()); ++pass->next) {
      const Observation& observation = observations_[pass->next];
      if (observation.time > time)
        break;
      if (!update(observation, observation.time, &pass->filter))
        return false;
    }
    pass->filter.predict(time);
    return true;
  }

  void filterForwards() {
    Pass pass = start(0, kForwards);
    chunks_.push_back({0, pass, std::nullopt});
    for (std::size_t i = 0; i < places_.size(); ++i) {
      if (i == chunks_.back().first + kChunk)
        chunks_.push_back({i, pass, std::nullopt});
      while (!advance(places_[i].time, &pass)) {
        const Number misfit = pass.next;
        pass = start(misfit + 1, kForwards);
        chunks_.push_back({i, pass, misfit});
      }
    }
  }

  void smooth(const Chunk& chunk, std::size_t end, std::vector<KinematicState>* states) {
    Pass pass = chunk.forwards;
    std::vector<Pass> forwards;
    for (std::size_t i = chunk.first; i < end; ++i) {
      advance(places_[i].time, &pass);
      forwards.push_back(pass);
    }
    for (std::size_t i = end; i-- > chunk.first;) {
      const double time = places_[i].time;
      while (backwards_.next >= 0 && observations_[backwards_.next].time > time) {
        const Observation& observation = observations_[backwards_.next--];
        if (update(observation, -observation.time, &backwards_.filter))
          continue;
        backwards_ = start(backwards_.next, kBackwards);
      }
      backwards_.filter.predict(-time);
      (*states)[i] = stateAt(places_[i], forwards[i - chunk.first]);
    }
  }

  KinematicState stateAt(const Place& place, const Pass& forwards) const {
    const Modes& before = forwards.filter.modes();
    const Modes& after = backwards_.filter.modes();
    if (forwards.hasSeen() && backwards_.hasSeen())
      return combine(options_, before, after);
    if (backwards_.hasSeen())
      return reversed(momentsOf(after));
    return momentsOf(forwards.hasSeen() ? before : filterAt(place, place.time).modes());
  }

  const MotionOptions& options_;
  const std::vector<Observation>& observations_;
  const std::vector<Place>& places_;
  std::vector<Chunk> chunks_;
  Pass backwards_;
};

}  // namespace

std::vector<KinematicState> smooth(const MotionOptions& options,
                                   const std::vector<Observation>& observations,
                                   const std::vector<Place>& places) {
  if (places.empty())
    return {};
  return Smoother(options, observations, places).run();
}

}  // namespace wiimote_tracker::motion
