#include "wiimote_tracker_calibration/bundle/self_calibrate.h"

#include "start.h"
#include "steps.h"

#include "wiimote_tracker_calibration/bundle/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::bundle {

namespace {

/// Whether two attempts ended with the same lenses.
bool agree(const Attempt& a, const Attempt& b, double tolerance) {
  for (std::size_t i = 0; i < a.reconstruction.placed.size(); ++i) {
    const double first = a.reconstruction.cameras[i].intrinsics.fx;
    const double second = b.reconstruction.cameras[i].intrinsics.fx;
    if (a.reconstruction.placed[i] && b.reconstruction.placed[i] &&
        std::abs(std::log(first / second)) > tolerance)
      return false;
  }
  return true;
}

// A focal length with a larger relative standard deviation counts as not determined.
constexpr double kMostFocalUncertainty = 0.05;

// Points that two cameras share which suffice to distinguish a good start from a bad one.
constexpr std::size_t kFewPoints = 100;

/// Continues the best starts until one solution is left.
class Search {
 public:
  Search(const Reconstruction& all,
         const SelfCalibrationOptions& options,
         const ProgressCallback& progress)
      : all_(all), options_(options), progress_(progress), few_(thinned(all, kFewPoints)) {}

  /// Sets starts, followed and agreeing of the result. @throws BundleError.
  Attempt run(SelfCalibration* result) {
    start(&result->starts);
    followAll("cameras of a few starts", 0.3, 0.5, [&](Attempt* attempt) {
      growTo(std::min(kFewCameras, all_.cameras.size()), attempt);
    });
    attempts_.resize(std::min(attempts_.size(), kFollowed));
    followAll("all cameras", 0.5, 0.7,
              [&](Attempt* attempt) { growTo(all_.cameras.size(), attempt); });
    followAll("adjusting the best starts", 0.7, 0.8,
              [&](Attempt* attempt) { adjustPlaced(options_.bundle, maximumError(), attempt); });
    result->followed = attempts_.size();
    result->agreeing = static_cast<std::size_t>(std::count_if(
        attempts_.begin(), attempts_.end(),
        [&](const Attempt& attempt) { return agree(attempt, attempts_.front(), kSameFocal); }));
    return withAllPoints(attempts_.front());
  }

  /// Whether another solution explains the points about as well with other lenses.
  bool isAmbiguous() const {
    const double kAsWell = 1.2;
    return std::any_of(attempts_.begin(), attempts_.end(), [&](const Attempt& attempt) {
      return attempt.cost < kAsWell * attempts_.front().cost &&
             !agree(attempt, attempts_.front(), kMostFocalUncertainty);
    });
  }

 private:
  static constexpr std::size_t kPairs = 4;  // Of cameras, to start from.
  // Up to so many cameras all starts are followed; from then on only the best kFollowed.
  static constexpr std::size_t kFewCameras = 4;
  static constexpr std::size_t kFollowed = 3;
  static constexpr double kSameFocal = 0.01;  // Relative, of starts that agree.

  double maximumError() const { return options_.bundle.maximum_error; }

  void report(const char* step, double fraction) const {
    if (progress_)
      progress_(step, fraction);
  }

  /// Keeps the best start of each focal length.
  void start(std::size_t* starts) {
    std::vector<CameraPair> pairs = likelyPairs(few_, options_.bundle);
    pairs.resize(std::min(pairs.size(), kPairs));
    if (pairs.empty())
      throw BundleError(
          "no two cameras have " + std::to_string(options_.bundle.minimum_common_points) +
          " points in common: move the light where two cameras or more see it at a time");
    std::size_t tried = 0;
    attempts_.assign(options_.focal_lengths.size(), Attempt());
    for (const CameraPair& pair : pairs) {
      for (std::size_t i = 0; i < options_.focal_lengths.size(); ++i) {
        const double focal_length = options_.focal_lengths[i];
        report("trying starts",
               0.3 * static_cast<double>(tried++) /
                   static_cast<double>(pairs.size() * options_.focal_lengths.size()));
        const Attempt attempt = attemptPair(guess(focal_length), pair, options_.bundle);
        ++*starts;
        // Two cameras alone hardly determine their focal lengths: keep the best of each.
        if (attempt.cost < attempts_[i].cost)
          attempts_[i] = attempt;
      }
    }
    reason_ = "no two cameras agree on where they stand: move the light through all of the room";
    sort();
  }

  /// Some of the points, and all cameras with such a lens.
  Reconstruction guess(double focal_length) const {
    Reconstruction guessed = few_;
    for (geometry::Camera& camera : guessed.cameras)
      camera.intrinsics =
          guessedLens(camera.intrinsics.width, camera.intrinsics.height, focal_length);
    return guessed;
  }

  void growTo(std::size_t cameras, Attempt* attempt) const {
    grow(options_, cameras, attempt);
    if (cameras == all_.cameras.size())
      refuseUnexplained(attempt->reconstruction, options_.bundle);
  }

  /// Takes all attempts one step further; drops those that fail, and sorts the others.
  template <typename Step>
  void followAll(const char* name, double from, double to, const Step& step) {
    for (std::size_t i = 0; i < attempts_.size(); ++i) {
      report(name,
             from + (to - from) * static_cast<double>(i) / static_cast<double>(attempts_.size()));
      try {
        step(&attempts_[i]);
      } catch (const BundleError& error) {
        reason_ = error.what();
        attempts_[i].cost = std::numeric_limits<double>::infinity();
      }
    }
    sort();
    if (attempts_.empty())
      throw BundleError(reason_);
  }

  /// Whether all fields of view are possible ones: a wrong start often ends in others.
  static bool isPlausible(const Attempt& attempt) {
    const double kShortest = 0.25;  // image widths; a field of view of 127 degrees
    const double kLongest = 20.0;   // 3 degrees
    for (std::size_t i = 0; i < attempt.reconstruction.placed.size(); ++i) {
      const geometry::Intrinsics& lens = attempt.reconstruction.cameras[i].intrinsics;
      if (attempt.reconstruction.placed[i] &&
          !(lens.fx > kShortest * lens.width && lens.fx < kLongest * lens.width))
        return false;
    }
    return true;
  }

  /// Puts the best first and drops those that failed.
  void sort() {
    for (Attempt& attempt : attempts_) {
      if (std::isfinite(attempt.cost) && !isPlausible(attempt)) {
        attempt.cost = std::numeric_limits<double>::infinity();
        reason_ =
            "only lenses with impossible fields of view explain what the cameras saw: check that "
            "all count the same frames, and that no image is mirrored or cut";
      }
    }
    attempts_.erase(
        std::remove_if(attempts_.begin(), attempts_.end(),
                       [](const Attempt& attempt) { return !std::isfinite(attempt.cost); }),
        attempts_.end());
    std::stable_sort(attempts_.begin(), attempts_.end(),
                     [](const Attempt& a, const Attempt& b) { return a.cost < b.cost; });
  }

  /// Adjusts a solution of few points with all of them, roughly: refine() follows.
  Attempt withAllPoints(const Attempt& solved) const {
    report("adjusting with all points", 0.8);
    Attempt attempt;
    attempt.reconstruction = all_;
    attempt.reconstruction.cameras = solved.reconstruction.cameras;
    attempt.reconstruction.placed.assign(all_.cameras.size(), true);
    Options rough = options_.bundle;
    rough.rough = true;
    adjustPlaced(rough, maximumError(), &attempt);
    triangulatePoints(&attempt.reconstruction, maximumError());
    return attempt;
  }

  const Reconstruction& all_;
  const SelfCalibrationOptions& options_;
  const ProgressCallback& progress_;
  const Reconstruction few_;
  std::vector<Attempt> attempts_;
  std::string reason_;
};

void judgeLenses(const SelfCalibrationOptions& options, bool ambiguous, SelfCalibration* result) {
  Certainty certainty(result->reconstruction, options.bundle);
  result->pixel_stddev = pixelStddev(result->reconstruction, options.bundle);
  const double ratio =
      options.bundle.fixed_lenses ? 1.0 : birgeRatio(result->reconstruction, options.bundle);
  result->expected_shape_error = certainty.expectedShapeError();
  if (result->expected_shape_error)
    *result->expected_shape_error *= ratio;
  for (std::size_t i = 0; i < result->reconstruction.cameras.size(); ++i) {
    LensCertainty lens{0.0, true};
    if (!options.bundle.fixed_lenses) {
      const auto covariance = certainty.lensCovariance(i);
      lens.focal_stddev = covariance ? ratio * std::sqrt((*covariance)(0, 0))
                                     : std::numeric_limits<double>::infinity();
      lens.focal_determined =
          !ambiguous && lens.focal_stddev <
                            kMostFocalUncertainty * result->reconstruction.cameras[i].intrinsics.fx;
    }
    result->lenses.push_back(lens);
  }
}

/// Adjusts with the observations within six medians of their points: a false detection that is off
/// by less than Options::maximum_error would pull the solution. Then marks as inliers what lies
/// within maximum_error.
void refine(const SelfCalibrationOptions& options, Reconstruction* reconstruction) {
  const int kRounds = 5;
  const double kMedians = 6.0;  // 7 sigma: the median of a Rayleigh distribution is 1.18 sigma
  Options tight = options.bundle;
  for (int round = 0; round < kRounds; ++round) {
    const double median = statistics(*reconstruction).median;
    tight.maximum_error = std::min(kMedians * median, options.bundle.maximum_error);
    tight.loss_scale = std::max(std::min(2.0 * median, options.bundle.loss_scale), 1e-3);
    // Exact pixels have a median near 0.
    tight.maximum_error = std::max(tight.maximum_error, 0.01 * options.bundle.maximum_error);
    tight.pixel_stddev = std::max(pixelStddev(*reconstruction, tight), 1e-3);
    tight.rough = round + 1 < kRounds;
    triangulatePoints(reconstruction, tight.maximum_error);
    adjust(reconstruction, tight);
  }
  triangulatePoints(reconstruction, options.bundle.maximum_error);
}

SelfCalibration solveOnce(const Reconstruction& all,
                          const SelfCalibrationOptions& options,
                          const ProgressCallback& progress) {
  SelfCalibration result;
  bool ambiguous = false;
  if (options.bundle.fixed_lenses) {
    result.reconstruction = solve(all, options.bundle);
  } else {
    Search search(all, options, progress);
    result.reconstruction = search.run(&result).reconstruction;
    refuseUnexplained(result.reconstruction, options.bundle);
    ambiguous = search.isAmbiguous();
  }
  if (progress)
    progress("leaving out false detections", 0.9);
  refine(options, &result.reconstruction);
  judgeLenses(options, ambiguous, &result);
  return result;
}

}  // namespace

SelfCalibration selfCalibrate(Reconstruction observed,
                              const SelfCalibrationOptions& options,
                              const ProgressCallback& progress) {
  if (!options.bundle.fixed_lenses) {
    for (geometry::Camera& camera : observed.cameras)
      camera.intrinsics = guessedLens(camera.intrinsics.width, camera.intrinsics.height, 1.0);
  }
  checkObservations(observed);
  if (isOnALine(observed))
    throw BundleError("the light moved on a line only: move it through all of the room");
  SelfCalibration result;
  try {
    result = solveOnce(observed, options, progress);
  } catch (const BundleError& error) {
    // It only matters whether it works: fewer points and starts are enough.
    SelfCalibrationOptions quick = options;
    quick.focal_lengths = {0.7, 1.4, 2.8};
    const auto works = [&](const Reconstruction& changed) {
      try {
        solveOnce(changed, quick, progress);
        return true;
      } catch (const BundleError&) {
        return false;
      }
    };
    throw BundleError(suspicion(thinned(observed, kFewPoints), options.bundle.fixed_lenses, works)
                          .value_or(error.what()));
  }
  // Points close to a plane still determine the depth when a lens is known.
  const double kFlat = 0.005;
  const bool lenses_known =
      std::any_of(result.lenses.begin(), result.lenses.end(),
                  [](const LensCertainty& lens) { return lens.focal_determined; });
  if (isFlat(result.reconstruction, options.bundle, lenses_known ? 0.0 : kFlat))
    throw BundleError(
        "the light moved in one plane only, or the cameras stand in one place: move the light "
        "nearer to and farther from the cameras too");
  return result;
}

}  // namespace wiimote_tracker::bundle
