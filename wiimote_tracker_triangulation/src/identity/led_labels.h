#pragma once

#include "wiimote_tracker_triangulation/identity/identifier.h"
#include "wiimote_tracker_triangulation/tracking/snapshot.h"

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::identity {

struct LedLabel {
  std::string name;

  /// For a label found by blinking, given again, or of an LED that met another one: its probability
  /// [0..1], a lower bound after several meetings. NaN for other labels.
  double confidence = std::numeric_limits<double>::quiet_NaN();
  double since = 0.0;       ///< When it was found by blinking, or given again [s]; 0 for others.
  bool identified = false;  ///< By blinking.
  double same_led_probability = 1.0;  ///< As in TrackedLed, when the confidence was set.
};

/// Gives labels to tracks. A track that blinks gets the label of its code once it is identified.
/// Any other confirmed track takes the first free label of a list and keeps it until it is lost;
/// then the label goes to the oldest track without one, or to the next confirmed track. Of several
/// free labels a track takes that of the LED which most probably is there, by the place and the
/// time where it was seen last; after 10 s it may be anywhere, and the first free label is given. A
/// track without a label is called led_<id>.
class LedLabels {
 public:
  explicit LedLabels(const std::vector<std::string>& labels) : listed_(labels) {}

  /// Call it with the LEDs of every snapshot.
  /// @param time of the snapshot [s].
  /// @param identifier that has the same snapshot; null: no LED blinks. With it, only LEDs that do
  /// not blink take labels of the list.
  void update(double time,
              const std::vector<tracking::TrackedLed>& leds,
              const Identifier* identifier = nullptr);

  /// The label of an LED of the last snapshot, or of one that was lost there or by clear().
  LedLabel of(std::uint32_t id) const;

  /// All tracks are lost, and all labels free; time may begin anew.
  void clear();

  /// Where the LED of a label was when it was tracked last.
  struct Place {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< World [m].
    double speed = 0.0;                                  ///< There [m/s].
    double age = 0.0;         ///< From there to the newest snapshot; below 0 after a jump back [s].
    double confidence = 1.0;  ///< That the LED there had the right label [0..1].
    std::vector<std::uint32_t> tracked_with;  ///< Ids of all LEDs that were tracked then.
  };
  /// Of the labels of the list that were given, by label.
  using Places = std::map<std::string, Place>;
  const Places& places() const { return places_; }

  /// The places, to be kept for another process; null if no update came since the last call, so
  /// that their ages would be those of old.
  const Places* placesToKeep();

  /// Forgets where labels were seen, as when the places are in another world from now on.
  void forgetPlaces() {
    places_.clear();
    former_.clear();
  }

  /// Forgets where labels were lost on lights that are hidden from now on, as lamps by masks. Such
  /// a label belongs again where it was seen before it went to the lamp.
  void forgetLamps(const std::function<bool(const Eigen::Vector3d&)>& is_hidden);

  /// A person says that the LED that is tracked as `label` is `right`. Another LED that had this
  /// label gets the former one if it is of the list, and keeps its doubt.
  /// @returns why that cannot be; empty: it was done.
  std::string correct(const std::string& label, const std::string& right);

  /// Places from another process, before the first update.
  void setFormerPlaces(const Places& places) { places_ = places; }

  /// Labels that became doubtful by the last update, or once more.
  const std::vector<std::string>& doubtful() const { return doubtful_; }

  /// Doubtful labels of LEDs that have a track.
  std::vector<std::string> doubtfulNow() const;

 private:
  /// The free label that fits an LED best.
  struct Choice {
    const std::string* label = nullptr;  // null: none is free
    double density = 0.0;                // of its LED where this one is [1/m^3]
    double sum = 0.0;                    // of the densities of all LEDs that this one may be
    int candidates = 0;                  // these LEDs

    void add(double candidate_density) {
      sum += candidate_density;
      candidates += candidate_density > 0.0;
    }

    /// Probability that this is the LED that was seen at the label's place [0..1].
    double probability() const { return sum > 0.0 ? density / sum : 0.0; }

    /// Probability that the label is right [0..1]: it was right at its place, and this is the LED
    /// from there; or it was wrong there, and this is that one of the others whose label it is.
    /// @param right_at_place probability that it was right there
    double confidence(double right_at_place) const {
      const int others = candidates - (density > 0.0);
      const double another = others > 0 ? (1.0 - probability()) / others : 0.0;
      return right_at_place * probability() + (1.0 - right_at_place) * another;
    }
  };

  void exchange(const std::string& label, const std::string& right, bool is_listed);
  void agePlaces(double time);
  void giveLabel(double time, const tracking::TrackedLed& led, const Identifier* identifier);
  void takeIdentity(std::uint32_t id, const Identifier& identifier);
  Choice choiceFor(const tracking::TrackedLed& led) const;
  void giveFreeLabel(double time, const tracking::TrackedLed& led);
  void notePlace(const tracking::TrackedLed& led);
  void setConfidence(double confidence, double same, LedLabel* given);
  bool hasTrack(const std::string& label) const;
  const LedLabel* holderOf(const std::string& label) const;

  std::vector<std::string> listed_;
  std::map<std::uint32_t, LedLabel> given_;  // by the track's id
  std::vector<std::uint32_t> tracked_;       // in the last update
  std::vector<std::uint32_t> lost_;          // since the last update began
  std::vector<std::uint32_t> forgotten_;     // lost before that; their labels are free
  Places places_;
  Places former_;  // where a label's LED was when the label was given again, or when it met another
  std::optional<double> newest_;  // snapshot [s]
  bool is_updated_ = false;       // since the places were kept
  std::vector<std::string> doubtful_;
};

}  // namespace wiimote_tracker::identity
