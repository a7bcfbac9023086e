#include "association/exhaustive.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

namespace wiimote_tracker::association::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Hypothesis {
  Tuple tuple;
  std::uint64_t spots;  // one bit each
  double cost;
};

class BestDivision {
 public:
  BestDivision(const geometry::Rig& rig,
               const SimulatedViews& views,
               const AssociationOptions& options)
      : rig_(rig), views_(views), options_(options) {
    std::uint64_t all = 0;
    int bit = 0;
    for (const auto& pixels : views.pixels) {
      bits_.emplace_back();
      for (std::size_t i = 0; i < pixels.size(); ++i) {
        bits_.back().push_back(std::uint64_t{1} << bit++);
        all |= bits_.back().back();
      }
    }
    Tuple tuple;
    enumerate(&tuple, 0, 0);
    least(all);
    division_.cost = known_.at(all).cost;
    for (std::uint64_t rest = all; rest != 0;) {
      const Choice& choice = known_.at(rest);
      if (choice.hypothesis)
        division_.points.insert(choice.hypothesis->tuple);
      rest &= ~(choice.hypothesis ? choice.hypothesis->spots : rest & ~(rest - 1));
    }
  }

  const Division& division() const { return division_; }

 private:
  struct Choice {
    double cost;
    const Hypothesis* hypothesis;  // of the lowest spot; null: it is a ghost
  };

  /// Goes through all tuples; those that cost less than as many ghosts become hypotheses.
  void enumerate(Tuple* tuple, std::uint64_t spots, std::size_t rays) {
    const std::size_t camera = tuple->size();
    if (camera == rig_.cameras.size()) {
      if (rays >= options_.minimum_rays)
        add(*tuple, spots, static_cast<double>(rays));
      return;
    }
    tuple->push_back(-1);
    enumerate(tuple, spots, rays);
    for (std::size_t i = 0; i < views_.pixels[camera].size(); ++i) {
      tuple->back() = static_cast<int>(i);
      enumerate(tuple, spots | bits_[camera][i], rays + 1);
    }
    tuple->pop_back();
  }

  void add(const Tuple& tuple, std::uint64_t spots, double rays) {
    Eigen::Vector3d position;
    double cost =
        options_.point + chiSquared(rig_, views_, tuple, options_.pixel_stddev, &position);
    if (cost == kInfinity)
      return;
    for (std::size_t camera = 0; camera < tuple.size(); ++camera) {
      const View& view = views_.views[camera];
      if (tuple[camera] < 0 && view.watching && !view.full &&
          rig_.cameras[camera].camera.sees(position))
        cost += options_.miss;
    }
    if (cost < rays * options_.ghost)
      hypotheses_[spots & ~(spots - 1)].push_back({tuple, spots, cost});
  }

  double least(std::uint64_t rest) {
    if (rest == 0)
      return 0.0;
    const auto found = known_.find(rest);
    if (found != known_.end())
      return found->second.cost;
    const std::uint64_t lowest = rest & ~(rest - 1);
    Choice choice{options_.ghost + least(rest & ~lowest), nullptr};
    for (const Hypothesis& hypothesis : hypotheses_[lowest]) {
      if ((hypothesis.spots & ~rest) != 0)
        continue;
      const double cost = hypothesis.cost + least(rest & ~hypothesis.spots);
      if (cost < choice.cost)
        choice = {cost, &hypothesis};
    }
    known_[rest] = choice;
    return choice.cost;
  }

  const geometry::Rig& rig_;
  const SimulatedViews& views_;
  const AssociationOptions& options_;
  std::vector<std::vector<std::uint64_t>> bits_;                 // of each spot
  std::map<std::uint64_t, std::vector<Hypothesis>> hypotheses_;  // by their lowest spot
  std::map<std::uint64_t, Choice> known_;                        // by the remaining spots
  Division division_;
};

}  // namespace

double chiSquared(const geometry::Rig& rig,
                  const SimulatedViews& views,
                  const Tuple& tuple,
                  double pixel_stddev,
                  Eigen::Vector3d* position) {
  std::vector<geometry::Observation> observations;
  for (std::size_t camera = 0; camera < tuple.size(); ++camera) {
    if (tuple[camera] >= 0)
      observations.push_back({&rig.cameras[camera].camera,
                              views.pixels[camera][static_cast<std::size_t>(tuple[camera])]});
  }
  geometry::TriangulationOptions start_options;
  start_options.method = geometry::TriangulationMethod::kLeastSquares;
  const auto start = geometry::triangulate(observations, start_options);
  if (!start)
    return kInfinity;
  *position = start->position;
  double best = kInfinity;
  for (int i = 0; i < 50; ++i) {
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    double squared = 0.0;
    for (const geometry::Observation& o : observations) {
      Eigen::Matrix<double, 2, 3> jacobian;
      const auto pixel = o.camera->project(*position, &jacobian);
      if (!pixel)
        return kInfinity;
      const Eigen::Vector2d residual = *pixel - o.pixel;
      A += jacobian.transpose() * jacobian;
      b += jacobian.transpose() * residual;
      squared += residual.squaredNorm();
    }
    best = std::min(best, squared);
    const Eigen::Vector3d step = A.ldlt().solve(b);
    *position -= step;
    if (step.norm() < 1e-9)
      break;
  }
  return best / (pixel_stddev * pixel_stddev);
}

Division bestDivision(const geometry::Rig& rig,
                      const SimulatedViews& views,
                      const AssociationOptions& options) {
  return BestDivision(rig, views, options).division();
}

Division bestPermutation(const geometry::Rig& rig,
                         const SimulatedViews& views,
                         const AssociationOptions& options) {
  const std::size_t leds = views.pixels[0].size();
  std::vector<Tuple> orders(rig.cameras.size(), Tuple(leds));  // of each camera
  for (Tuple& order : orders)
    std::iota(order.begin(), order.end(), 0);
  const auto tupleOf = [&](std::size_t led) {
    Tuple tuple;
    for (const Tuple& order : orders)
      tuple.push_back(order[led]);
    return tuple;
  };
  std::vector<double> known;  // chi^2, by the number whose digits are the tuple; below 0: not yet
  known.assign(static_cast<std::size_t>(std::pow(leds, orders.size())), -1.0);
  const auto cost = [&](std::size_t led) {
    std::size_t number = 0;
    for (const Tuple& order : orders)
      number = number * leds + static_cast<std::size_t>(order[led]);
    Eigen::Vector3d position;
    if (known[number] < 0.0)
      known[number] = chiSquared(rig, views, tupleOf(led), options.pixel_stddev, &position);
    return known[number];
  };
  double least = kInfinity;
  std::vector<Tuple> best = orders;
  for (bool more = true; more;) {
    double sum = 0.0;
    for (std::size_t led = 0; led < leds; ++led)
      sum += cost(led);
    if (sum < least) {
      least = sum;
      best = orders;
    }
    more = false;  // the first camera's order stays
    for (std::size_t camera = 1; camera < orders.size() && !more; ++camera)
      more = std::next_permutation(orders[camera].begin(), orders[camera].end());
  }
  Division division;
  orders = best;
  for (std::size_t led = 0; led < leds; ++led)
    division.points.insert(tupleOf(led));
  division.cost = least + options.point * static_cast<double>(leds);
  return division;
}

Division divisionOf(const Association& association, std::size_t cameras) {
  Division division;
  division.cost = association.cost;
  for (const AssociatedPoint& point : association.points) {
    Tuple tuple(cameras, -1);
    for (const SpotReference& spot : point.spots)
      tuple[spot.view] = static_cast<int>(spot.spot);
    division.points.insert(tuple);
  }
  return division;
}

}  // namespace wiimote_tracker::association::test
