#include "body/learn_constellation.h"

#include "body/align.h"
#include "body/match_points.h"
#include "wiimote_tracker_triangulation/geometry/error.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

namespace wiimote_tracker::body {
namespace {

constexpr std::size_t kParts = 8;          // of the recording, for the uncertainty
constexpr std::size_t kFewest = 5;         // instants in each
constexpr double kSameLed = 0.03;          // a new track this near a missing LED continues it [m]
constexpr double kNotRigid = 0.01;         // [m]
constexpr double kPointStddev = 0.004;     // of an LED, to find the body by its shape [m]
constexpr double kMatchMargin = 15.0;      // as BodyTrackerOptions::minimum_margin
constexpr double kShareOfInstants = 0.05;  // that must show all LEDs
constexpr int kRounds = 5;                 // of aligning and averaging; converges fast

std::string millimetres(double metres) {
  return format("%.1f mm", 1e3 * metres);
}

class Learning {
 public:
  Learning(const std::string& name, const std::vector<LedsInstant>& instants)
      : name_(name), instants_(instants) {}

  LearnedConstellation run() {
    begin();
    for (const LedsInstant& instant : instants_)
      identify(instant);
    if (seen_.size() < kParts * kFewest)
      throw Error("body '" + name_ + "' was seen in " + counted(seen_.size(), "instant") +
                  " only; hold it for longer where cameras see all of its LEDs");
    for (int round = 0; round < kRounds; ++round)
      takeMean();
    LearnedConstellation learned;
    learned.ids = ids_;
    learned.constellation = body_;
    learned.stddev = stddevs();
    return learned;
  }

 private:
  /// An instant with the LED of each point identified.
  struct Seen {
    std::array<PointPair, kMaximumLeds> pairs;
    std::array<std::size_t, kMaximumLeds> leds;  // of the pairs
    std::size_t count = 0;
  };

  /// Starts from the first instant with as many LEDs as at least 5 % of the instants show.
  void begin() {
    std::map<std::size_t, std::size_t> instants_of_count;
    for (const LedsInstant& instant : instants_)
      ++instants_of_count[instant.leds.size()];
    const double enough = kShareOfInstants * instants_.size();
    std::size_t leds = 0;
    for (const auto& [count, instants] : instants_of_count)
      leds = instants >= enough ? count : leds;
    if (leds < 3 || leds > kMaximumLeds)
      throw Error("the cameras saw " + counted(leds, "LED") +
                  " at once, those of known bodies left out, but a body has 3 to " +
                  std::to_string(kMaximumLeds) +
                  "; bring all of them in view of two cameras, and no others");
    const auto first =
        std::find_if(instants_.begin(), instants_.end(),
                     [&](const LedsInstant& instant) { return instant.leds.size() == leds; });
    body_.name = name_;
    for (const LedsInstant::Led& led : first->leds) {
      led_of_id_[led.id] = ids_.size();
      ids_.push_back(led.id);
      body_.leds.push_back(led.position);
    }
    recentre();
  }

  void recentre() {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& led : body_.leds)
      mean += led / static_cast<double>(body_.leds.size());
    for (Eigen::Vector3d& led : body_.leds)
      led -= mean;
  }

  void identify(const LedsInstant& instant) {
    Seen seen = pairsOf(instant);
    if (seen.count < instant.leds.size()) {
      if (seen.count >= 3)
        recogniseNear(instant, align(seen.pairs.data(), seen.count).world_from_body);
      else if (const auto match = matchOf(instant))
        recogniseNear(instant, match->world_from_body);
      seen = pairsOf(instant);
    }
    if (seen.count >= 3)
      seen_.push_back(seen);
  }

  Seen pairsOf(const LedsInstant& instant) const {
    Seen seen;
    for (const LedsInstant::Led& led : instant.leds) {
      const auto known = led_of_id_.find(led.id);
      if (known == led_of_id_.end() || seen.count == kMaximumLeds)
        continue;
      seen.leds[seen.count] = known->second;
      seen.pairs[seen.count++] = {body_.leds[known->second], led.position,
                                  1.0 / (led.stddev * led.stddev)};
    }
    return seen;
  }

  std::optional<Match> matchOf(const LedsInstant& instant) const {
    std::vector<MeasuredPoint> points;
    for (const LedsInstant::Led& led : instant.leds)
      points.push_back({led.position, kPointStddev, false});
    const std::optional<Match> match = matchPoints(body_, points);
    return match && match->margin >= kMatchMargin ? match : std::nullopt;
  }

  /// Assigns new tracks to LEDs that are missing.
  void recogniseNear(const LedsInstant& instant, const Eigen::Isometry3d& world_from_body) {
    for (std::size_t i = 0; i < body_.leds.size(); ++i) {
      const bool is_there =
          std::any_of(instant.leds.begin(), instant.leds.end(), [&](const LedsInstant::Led& led) {
            const auto known = led_of_id_.find(led.id);
            return known != led_of_id_.end() && known->second == i;
          });
      for (const LedsInstant::Led& led : instant.leds) {
        if (!is_there && led_of_id_.count(led.id) == 0 &&
            (led.position - world_from_body * body_.leds[i]).norm() < kSameLed)
          led_of_id_[led.id] = i;
      }
    }
  }

  /// Calls take(led, position in the body, weight) for the LEDs of one instant after alignment.
  template <typename Take>
  void aligned(Seen* seen, const Take& take) const {
    for (std::size_t i = 0; i < seen->count; ++i)
      seen->pairs[i].in_body = body_.leds[seen->leds[i]];
    const Eigen::Isometry3d body_from_world =
        align(seen->pairs.data(), seen->count).world_from_body.inverse();
    for (std::size_t i = 0; i < seen->count; ++i)
      take(seen->leds[i], body_from_world * seen->pairs[i].in_world, seen->pairs[i].weight);
  }

  void takeMean() {
    std::vector<Eigen::Vector3d> sums(body_.leds.size(), Eigen::Vector3d::Zero());
    std::vector<double> weights(body_.leds.size(), 0.0);
    for (Seen& seen : seen_)
      aligned(&seen, [&](std::size_t led, const Eigen::Vector3d& place, double weight) {
        sums[led] += weight * place;
        weights[led] += weight;
      });
    for (std::size_t i = 0; i < body_.leds.size(); ++i)
      body_.leds[i] = sums[i] / weights[i];
    recentre();
  }

  /// Also refuses a body that is not rigid.
  std::vector<double> stddevs() {
    struct Part {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      double weight = 0.0;
    };
    std::vector<std::array<Part, kParts>> parts(body_.leds.size());
    std::vector<double> squares(body_.leds.size(), 0.0);
    std::vector<double> counts(body_.leds.size(), 0.0);
    for (std::size_t i = 0; i < seen_.size(); ++i)
      aligned(&seen_[i], [&](std::size_t led, const Eigen::Vector3d& place, double weight) {
        Part& part = parts[led][i * kParts / seen_.size()];
        part.sum += weight * place;
        part.weight += weight;
        squares[led] += (place - body_.leds[led]).squaredNorm();
        counts[led] += 1.0;
      });
    std::vector<double> result;
    // The alignment removes six degrees of freedom.
    const double coordinates = 3 * body_.leds.size();
    for (std::size_t led = 0; led < body_.leds.size(); ++led) {
      const double scatter = std::sqrt(squares[led] / counts[led]);
      if (scatter > kNotRigid)
        throw Error("LED " + std::to_string(led) + " of body '" + name_ + "' moved by " +
                    millimetres(scatter) +
                    " against the others; name its LEDs' labels when others are in view, and "
                    "turn it slowly");
      double sum = 0.0;
      double count = 0.0;
      for (const Part& part : parts[led]) {
        if (!(part.weight > 0.0))
          continue;
        sum += (part.sum / part.weight - body_.leds[led]).squaredNorm() / 3.0;
        count += 1.0;
      }
      if (count < 3.0)
        throw Error("LED " + std::to_string(led) + " of body '" + name_ +
                    "' was hidden most of the time; turn it such that cameras see it");
      result.push_back(
          std::sqrt(sum / (count * (count - 1.0)) * coordinates / (coordinates - 6.0)));
    }
    return result;
  }

  std::string name_;
  const std::vector<LedsInstant>& instants_;
  Constellation body_;
  std::vector<std::uint32_t> ids_;
  std::map<std::uint32_t, std::size_t> led_of_id_;
  std::vector<Seen> seen_;
};

}  // namespace

LearnedConstellation learnConstellation(const std::string& name,
                                        const std::vector<LedsInstant>& instants) {
  return Learning(name, instants).run();
}

}  // namespace wiimote_tracker::body
