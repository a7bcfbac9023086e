#include "encounter.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::tracking {
namespace {

constexpr double kLeastLogLikelihood = -20.0;  // [log 1/px^2]; one bad spot does not decide
constexpr double kNegligible = 10.0;           // log of 22000 to 1

/// Views take turns within this [s]: what no view showed apart for longer was one spot in all.
constexpr double kTurn = 0.02;

}  // namespace

Encounter::Encounter(std::uint32_t a, std::uint32_t b, const Filters& before)
    : ids_{a, b}, opened_at_(before[0].time()), last_apart_(opened_at_) {
  ways_[0] = Way{before, 0.0};
}

std::optional<Encounter::Places> Encounter::take(const View& view,
                                                 double gate,
                                                 motion::MotionSteps* steps) {
  if (view.spot_count < 2)
    return std::nullopt;
  Outlooks outlooks;
  for (std::size_t i = 0; i < way_count_; ++i)
    outlooks[i] = lookOut(&*ways_[i], view, gate, steps);
  const std::optional<Places> places = likeliestPlaces(outlooks, view.spot_count);
  if (!places)
    return std::nullopt;
  if (!areApart(view.time))
    parted_at_ = view.time;
  has_parted_ = true;
  last_apart_ = view.time;
  return branch(outlooks, view, *places);
}

/// The way goes on to the view's time.
Encounter::Outlook Encounter::lookOut(Way* way,
                                      const View& view,
                                      double gate,
                                      motion::MotionSteps* steps) const {
  Outlook result;
  for (std::size_t led = 0; led < 2; ++led) {
    motion::MotionFilter& filter = way->filters[led];
    filter.predict(view.time, steps);
    const auto& prediction = result.predictions[led] =
        filter.predictPixel(*view.camera, view.noise);
    for (std::size_t spot = 0; spot < view.spot_count; ++spot) {
      const double fit = prediction ? prediction->logLikelihood(view.pixels[spot])
                                    : -std::numeric_limits<double>::infinity();
      result.fit[led][spot] = fit > kLeastLogLikelihood ? fit : kLeastLogLikelihood;
      result.within_gate[led][spot] =
          prediction && prediction->squaredDistance(view.pixels[spot]) <= gate;
    }
  }
  return result;
}

/// The two spots that some way expects most.
std::optional<Encounter::Places> Encounter::likeliestPlaces(const Outlooks& outlooks,
                                                            std::size_t spot_count) const {
  std::optional<Places> result;
  double greatest = -std::numeric_limits<double>::infinity();
  for (std::size_t way = 0; way < way_count_; ++way) {
    const Outlook& outlook = outlooks[way];
    for (std::size_t a = 0; a < spot_count; ++a) {
      for (std::size_t b = 0; b < spot_count; ++b) {
        if (a == b || !outlook.within_gate[0][a] || !outlook.within_gate[1][b])
          continue;
        const double sum = ways_[way]->log_likelihood + outlook.fit[0][a] + outlook.fit[1][b];
        if (sum > greatest) {
          greatest = sum;
          result = {a, b};
        }
      }
    }
  }
  return result;
}

/// Each way has two to give out those spots. @returns that of the likeliest
Encounter::Places Encounter::branch(const Outlooks& outlooks,
                                    const View& view,
                                    const Places& places) {
  struct Branch {
    std::size_t way;
    Places places;
    double log_likelihood;
  };
  std::array<Branch, 2 * kMaximumWays> branches;
  std::size_t count = 0;
  for (std::size_t way = 0; way < way_count_; ++way) {
    for (const Places& given : {places, Places{places[1], places[0]}}) {
      branches[count++] = {way, given,
                           ways_[way]->log_likelihood + outlooks[way].fit[0][given[0]] +
                               outlooks[way].fit[1][given[1]]};
    }
  }
  const auto isLikelier = [](const Branch& a, const Branch& b) {
    return a.log_likelihood > b.log_likelihood;
  };
  const std::size_t most = std::min(count, kMaximumWays);
  std::partial_sort(branches.begin(), branches.begin() + most, branches.begin() + count,
                    isLikelier);
  const double greatest = branches[0].log_likelihood;
  const std::array<std::optional<Way>, kMaximumWays> before = ways_;
  way_count_ = 0;
  for (std::optional<Way>& way : ways_) {
    const Branch& branch = branches[way_count_];
    if (way_count_ == most || branch.log_likelihood < greatest - kNegligible) {
      way.reset();
      continue;
    }
    ++way_count_;
    way = before[branch.way];
    way->log_likelihood = branch.log_likelihood - greatest;
    for (std::size_t led = 0; led < 2; ++led) {
      if (const auto& prediction = outlooks[branch.way].predictions[led])
        way->filters[led].update(*view.camera, *prediction, view.pixels[branch.places[led]]);
    }
  }
  return branches[0].places;
}

bool Encounter::areApart(double time) const {
  return has_parted_ && time - last_apart_ <= kTurn;
}

bool Encounter::isDecided(double time, double doubt_time) const {
  if (!has_parted_)
    return false;
  // Where they have become one spot again, their motion had not so long to tell.
  const bool is_too_long =
      time - parted_at_ > doubt_time && (areApart(time) || time - last_apart_ > doubt_time);
  return way_count_ == 1 || is_too_long;
}

}  // namespace wiimote_tracker::tracking
