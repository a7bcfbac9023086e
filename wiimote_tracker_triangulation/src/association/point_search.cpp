#include "point_search.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

namespace wiimote_tracker::association {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kMaskSize = 64;

}  // namespace

PointSearch::PointSearch(const geometry::Rig& rig,
                         std::vector<std::vector<std::size_t>> partners,
                         const AssociationOptions& options)
    : options_(options), cameras_(rig.rayCameras()), partners_(std::move(partners)) {
  triangulation_.method = geometry::TriangulationMethod::kMaximumLikelihood;
  triangulation_.pixel_stddev = options.pixel_stddev;
  triangulation_.minimum_angle = options.minimum_angle;
  reserve(kMaskSize);
}

/// Reserves memory for components of that many spots.
void PointSearch::reserve(std::size_t spots) {
  drafts_.resize(spots);
  best_.resize(spots);
  for (Draft& draft : drafts_)
    draft.spots.reserve(cameras_.size());
  for (Point& point : best_)
    point.spots.reserve(cameras_.size());
  partner_spots_.reserve(spots);
  least_costs_.reserve(spots);
  costs_.reserve(spots);
  sights_.reserve(cameras_.size());
}

bool PointSearch::solveAsOnePoint(const Component& component, const std::vector<View>& views) {
  const std::size_t size = component.spots.size();
  if (size < options_.minimum_rays)
    return false;
  for (std::size_t a = 0; a < size; ++a) {
    for (std::size_t b = a + 1; b < size; ++b) {
      if (component.pair(a, b) == kInfinity)
        return false;  // also if two spots are of one view
    }
  }
  begin(component, views);
  Draft& draft = drafts_[draft_count_++];
  draft.spots.resize(size);
  std::iota(draft.spots.begin(), draft.spots.end(), std::size_t{0});
  findFit(&draft);
  if (!draft.fit.is_possible)
    return false;
  // Any other association has at least two points, a point and a ghost, or ghosts only.
  const double misfit = draft.fit.chi_squared + missesOf(draft);
  const double least_other =
      std::min(options_.point + std::min(options_.point, options_.ghost), best_cost_);
  if (options_.point + misfit > least_other)
    return false;
  finish(0);
  return true;
}

std::size_t PointSearch::solve(const Component& component,
                               const std::vector<View>& views,
                               std::size_t maximum_steps) {
  begin(component, views);
  prepare();
  maximum_steps_ = maximum_steps;
  decide(0, 0);
  return steps_;
}

void PointSearch::begin(const Component& component, const std::vector<View>& views) {
  component_ = &component;
  views_ = &views;
  steps_ = 0;
  if (drafts_.size() < component.spots.size())
    reserve(component.spots.size());
  draft_count_ = 0;
  best_count_ = 0;
  best_cost_ = options_.ghost * component.spots.size();
  has_association_ = false;
}

void PointSearch::prepare() {
  const std::size_t size = component_->spots.size();
  partner_spots_.assign(size, 0);
  least_costs_.resize(size);
  for (std::size_t spot = 0; spot < size; ++spot) {
    std::size_t rays = 1;
    std::optional<std::size_t> last_view;  // with a partner; the spots are in the order of views
    for (std::size_t other = 0; other < size; ++other) {
      if (component_->pair(spot, other) == kInfinity)
        continue;
      if (other < kMaskSize)
        partner_spots_[spot] |= Mask{1} << other;
      const std::size_t view = component_->spots[other].view;
      rays += last_view != view;
      last_view = view;
    }
    least_costs_[spot] = std::min(options_.ghost, options_.point / rays);
  }
}

/// Decides on this spot and all after it.
void PointSearch::decide(std::size_t spot, std::size_t ghosts) {
  if (spot == component_->spots.size()) {
    finish(ghosts);
    return;
  }
  if (steps_ == maximum_steps_)
    return;
  ++steps_;
  tryJoining(spot, ghosts);
  tryBeginning(spot, ghosts);
  if (isWorthwhile(spot + 1, ghosts + 1))
    decide(spot + 1, ghosts + 1);
}

/// Tries the best-fitting points first, so that the first association is a good bound.
void PointSearch::tryJoining(std::size_t spot, std::size_t ghosts) {
  using Choice = std::pair<double, std::size_t>;  // mean cost of its pairs, and the draft
  Choice last(-kInfinity, 0);
  for (;;) {
    Choice next(kInfinity, 0);
    for (std::size_t i = 0; i < draft_count_; ++i) {
      const Choice choice(meanPairCost(drafts_[i], spot), i);
      if (choice > last)
        next = std::min(next, choice);
    }
    if (next.first == kInfinity)
      return;
    last = next;

    Draft& draft = drafts_[next.second];
    const Fit before = draft.fit;
    const Mask possible_before = draft.possible;
    draft.spots.push_back(spot);
    draft.possible &= partner_spots_[spot];
    draft.fit.is_known = false;
    if (has_association_)
      findFit(&draft);
    if (isWorthwhile(spot + 1, ghosts))
      decide(spot + 1, ghosts);
    draft.spots.pop_back();
    draft.possible = possible_before;
    draft.fit = before;
  }
}

void PointSearch::tryBeginning(std::size_t spot, std::size_t ghosts) {
  bool has_partner = false;
  for (std::size_t later = spot + 1; later < component_->spots.size() && !has_partner; ++later)
    has_partner = component_->pair(spot, later) < kInfinity;
  if (!has_partner)
    return;
  Draft& draft = drafts_[draft_count_++];
  draft.spots.assign(1, spot);
  draft.possible = partner_spots_[spot];
  draft.fit.is_known = false;
  draft.fit.chi_squared = 0.0;
  if (isWorthwhile(spot + 1, ghosts))
    decide(spot + 1, ghosts);
  --draft_count_;
}

/// Whether the lower bound of the present branch is below the best cost.
bool PointSearch::isWorthwhile(std::size_t next_spot, std::size_t ghosts) const {
  double cost = options_.ghost * ghosts;
  for (std::size_t i = 0; i < draft_count_; ++i)
    cost += options_.point + drafts_[i].fit.chi_squared;
  return cost + leastCostOfUnjoinable(next_spot) < best_cost_;
}

/// A lower bound: a spot that can join no draft is a ghost or in a new point, and shares that cost
/// with at most one spot of each view that has partners of it.
double PointSearch::leastCostOfUnjoinable(std::size_t next_spot) const {
  Mask joinable = 0;
  for (std::size_t i = 0; i < draft_count_; ++i)
    joinable |= drafts_[i].possible;
  double cost = 0.0;
  for (std::size_t spot = next_spot; spot < std::min(least_costs_.size(), kMaskSize); ++spot) {
    if ((joinable >> spot & 1) == 0)
      cost += least_costs_[spot];
  }
  return cost;
}

/// All spots are decided: keeps the association if it is the best. Spots of drafts that are not
/// points count as ghosts.
void PointSearch::finish(std::size_t ghosts) {
  has_association_ = true;
  double cost = options_.ghost * ghosts;
  costs_.clear();
  for (std::size_t i = 0; i < draft_count_; ++i) {
    Draft& draft = drafts_[i];
    if (!draft.fit.is_known)
      findFit(&draft);
    const double as_ghosts = options_.ghost * draft.spots.size();
    const double as_point =
        isPoint(draft) ? options_.point + draft.fit.chi_squared + missesOf(draft) : kInfinity;
    costs_.push_back(as_point);
    cost += std::min(as_point, as_ghosts);
    if (!(cost < best_cost_))
      return;
  }
  best_cost_ = cost;
  best_count_ = 0;
  for (std::size_t i = 0; i < draft_count_; ++i) {
    const Draft& draft = drafts_[i];
    if (costs_[i] > options_.ghost * draft.spots.size())
      continue;
    Point& point = best_[best_count_++];
    point.spots = draft.spots;
    point.location = draft.fit.location;
  }
}

bool PointSearch::isPoint(const Draft& draft) const {
  return draft.spots.size() >= options_.minimum_rays && draft.fit.is_possible;
}

/// Infinite when the spot has no possible pair with a spot of the draft.
double PointSearch::meanPairCost(const Draft& draft, std::size_t spot) const {
  double sum = 0.0;
  for (const std::size_t other : draft.spots)
    sum += component_->pair(other, spot);
  return sum / draft.spots.size();
}

void PointSearch::findFit(Draft* draft) {
  sights_.clear();
  for (const std::size_t spot : draft->spots)
    sights_.push_back(*component_->spots[spot].sight);
  const auto point = geometry::triangulate(sights_.data(), sights_.size(), triangulation_);
  draft->fit.is_known = true;
  draft->fit.is_possible = point.has_value();
  if (!point)
    return;
  draft->fit.location = *point;
  draft->fit.chi_squared = point->reprojection_error * point->reprojection_error * sights_.size() /
                           (options_.pixel_stddev * options_.pixel_stddev);
}

double PointSearch::missesOf(const Draft& draft) const {
  double cost = 0.0;
  auto spot = draft.spots.begin();
  for (const std::size_t camera : partners_[component_->spots[draft.spots.front()].view]) {
    while (spot != draft.spots.end() && component_->spots[*spot].view < camera)
      ++spot;
    const bool is_seen = spot != draft.spots.end() && component_->spots[*spot].view == camera;
    const View& view = (*views_)[camera];
    if (!is_seen && view.watching && !view.full &&
        cameras_[camera].sees(draft.fit.location.position))
      cost += options_.miss;
  }
  return cost;
}

}  // namespace wiimote_tracker::association
