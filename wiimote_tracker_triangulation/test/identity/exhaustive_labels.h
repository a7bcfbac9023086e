#pragma once

#include "identity/blinking.h"
#include "wiimote_tracker_triangulation/identity/hypotheses.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <vector>

namespace wiimote_tracker::identity::test {

/// The probability of each label by its definition: a slow sum over every period, phase and
/// assignment of labels, with every sighting for each.
struct ExhaustiveLabels {
  BlinkCodes codes;
  double steady = 0.01;
  double memory = 1.0;
  std::vector<double> periods;  ///< All candidates [s].
  int phases = 100;
  double phase_blur = 0.0;  ///< Width over which the phase is uncertain [periods].

  /// A column per LED, a row per label, and a last row for a light that does not blink.
  Eigen::MatrixXd posterior(const std::vector<LedSighting>& sightings, std::size_t leds) const {
    const std::size_t labels = codes.codes.size();
    Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(labels + 1, leds);
    std::vector<double> steady_light(leds);
    for (std::size_t led = 0; led < leds; ++led)
      steady_light[led] = logLikelihood(sightings, led, [](double) { return 1.0; });
    std::vector<Eigen::MatrixXd> ways;  // log likelihoods, per period and phase
    for (const double period : periods) {
      for (int phase = 0; phase < phases; ++phase) {
        Eigen::MatrixXd cell(labels + 1, leds);
        for (std::size_t led = 0; led < leds; ++led) {
          for (std::size_t label = 0; label < labels; ++label)
            cell(label, led) = logLikelihood(sightings, led, [&](double time) {
              return light(codes.codes[label].waveform,
                           time / period - static_cast<double>(phase) / phases, period);
            });
          cell(labels, led) = steady_light[led];
        }
        ways.push_back(cell);
      }
    }
    if (codes.synchronous) {
      double best = -1e300;
      for (const Eigen::MatrixXd& cell : ways)
        best = std::max(best, cell.colwise().maxCoeff().sum());
      std::vector<std::size_t> given(leds);
      for (const Eigen::MatrixXd& cell : ways)
        giveLabels(cell, best, 0, &given, &sums);
    } else {
      for (std::size_t led = 0; led < leds; ++led) {
        double best = -1e300;
        for (const Eigen::MatrixXd& cell : ways)
          best = std::max(best, cell.col(led).maxCoeff());
        for (const Eigen::MatrixXd& cell : ways) {
          for (std::size_t label = 0; label <= labels; ++label)
            sums(label, led) += prior(label) * std::exp(cell(label, led) - best);
        }
      }
    }
    for (std::size_t led = 0; led < leds; ++led)
      sums.col(led) /= sums.col(led).sum();
    return sums;
  }

 private:
  double prior(std::size_t label) const {
    const std::size_t labels = codes.codes.size();
    return label == labels ? steady : (1.0 - steady) / static_cast<double>(labels);
  }

  /// Mean light of the exposure, over the blur of the phase.
  double light(const Waveform& waveform, double phase, double period) const {
    constexpr int kSamples = 16;
    double sum = 0.0;
    for (int i = 0; i < kSamples; ++i)
      sum += litShare(waveform,
                      phase + phase_blur * ((i + 0.5) / kSamples - 0.5) - 0.5 * exposure / period,
                      exposure / period) /
             kSamples;
    return sum;
  }

  double logLikelihood(const std::vector<LedSighting>& sightings,
                       std::size_t led,
                       const std::function<double(double)>& light_at) const {
    const double now = sightings.back().sighting.time;
    double sum = 0.0;
    struct Darkness {
      double of_blinking = 0.0, weight = 0.0;
    };
    std::map<std::size_t, Darkness> dark;  // by camera, while it lasts
    const double hidden = std::log(kOccluded);
    for (const LedSighting& s : sightings) {
      if (s.led != led)
        continue;
      const double weight = std::exp((s.sighting.time - now) / memory);
      const double p = kSeenWhenOff + (kSeenWhenOn - kSeenWhenOff) * light_at(s.sighting.time);
      Darkness& darkness = dark[s.sighting.camera];
      if (s.sighting.seen) {
        sum += std::max(darkness.of_blinking, darkness.weight * hidden) + weight * std::log(p);
        darkness = {};
      } else {
        if (darkness.weight == 0.0)
          darkness.weight = weight;
        darkness.of_blinking += weight * std::log((1.0 - p) / (1.0 - kSeenWhenOff));
      }
    }
    for (const auto& [camera, darkness] : dark)
      sum += std::max(darkness.of_blinking, darkness.weight * hidden);
    return sum;
  }

  void giveLabels(const Eigen::MatrixXd& cell,
                  double best,
                  std::size_t led,
                  std::vector<std::size_t>* given,
                  Eigen::MatrixXd* sums) const {
    const std::size_t labels = codes.codes.size();
    if (led == given->size()) {
      double way = -best;
      double priors = 1.0;
      for (std::size_t i = 0; i < led; ++i) {
        way += cell((*given)[i], i);
        priors *= prior((*given)[i]);
      }
      for (std::size_t i = 0; i < led; ++i)
        (*sums)((*given)[i], i) += priors * std::exp(way);
      return;
    }
    for (std::size_t label = 0; label <= labels; ++label) {
      if (label < labels &&
          std::find(given->begin(), given->begin() + led, label) != given->begin() + led)
        continue;
      (*given)[led] = label;
      giveLabels(cell, best, led + 1, given, sums);
    }
  }

 public:
  double exposure = 0.001;  ///< Of all sightings [s].
};

}  // namespace wiimote_tracker::identity::test
