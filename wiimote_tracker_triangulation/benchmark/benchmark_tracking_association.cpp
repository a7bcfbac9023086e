#include "association/associate_views.h"
#include "association/exhaustive.h"
#include "association/simulated_views.h"
#include "benchmark_sections.h"
#include "wiimote_tracker_triangulation/geometry/shared_views.h"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace wiimote_tracker {
namespace {

using association::test::Disturbance;
using association::test::Division;
using association::test::Random;
using association::test::SimulatedViews;
using association::test::Tuple;

constexpr int kLeds = 4;
constexpr int kTimedTogether = 100;  // frames per timing

/// The LEDs that at least two cameras see.
Division truthOf(const SimulatedViews& views) {
  Division truth;
  for (int led = 0; led < kLeds; ++led) {
    Tuple tuple;
    int rays = 0;
    for (const std::vector<int>& leds : views.leds) {
      const auto spot = std::find(leds.begin(), leds.end(), led);
      tuple.push_back(spot == leds.end() ? -1 : static_cast<int>(spot - leds.begin()));
      rays += spot != leds.end();
    }
    if (rays >= 2)
      truth.points.insert(tuple);
  }
  return truth;
}

struct Case {
  std::string name;
  int cameras;
  Disturbance disturbance;
  /// The optimum; null where computing it takes too long.
  Division (*oracle)(const geometry::Rig&,
                     const SimulatedViews&,
                     const association::AssociationOptions&);
};

BenchmarkRow runCase(const Case& c, const BenchmarkSettings& settings) {
  Random random(settings.seed);
  const geometry::Rig rig = association::test::ringRig(c.cameras);
  const auto options = association::typicalCosts(rig, c.disturbance.pixel_stddev);
  association::ViewAssociator associator(rig, geometry::sharedViews(rig, 10.0), options);
  const std::size_t cameras = rig.cameras.size();
  int frames = 0;
  int identical = 0;
  int right = 0;
  int proven = 0;
  double seconds = 0.0;
  double longest = 0.0;
  for (int run = 0; run < settings.runs; ++run) {
    std::vector<SimulatedViews> batch;
    for (int i = 0; i < kTimedTogether; ++i) {
      const auto leds = association::test::randomLeds(random, rig, kLeds);
      batch.push_back(association::test::simulateViews(random, rig, leds, c.disturbance));
    }
    const double start = processorTime();
    for (const SimulatedViews& views : batch)
      associator.associate(views.views);
    seconds += processorTime() - start;
    for (const SimulatedViews& views : batch) {
      const double frame_start = processorTime();
      const association::Association& association = associator.associate(views.views);
      longest = std::max(longest, processorTime() - frame_start);
      const Division found = association::test::divisionOf(association, cameras);
      ++frames;
      proven += association.proven;
      right += found.points == truthOf(views).points;
      if (c.oracle)
        identical += found.points == c.oracle(rig, views, options).points;
    }
  }
  const double count = frames;
  return {c.name,
          {{"frames", count},
           {"identical", c.oracle ? identical / count : std::numeric_limits<double>::quiet_NaN()},
           {"proven", proven / count},
           {"right", right / count},
           {"us", 1e6 * seconds / count},
           {"us_worst", 1e6 * longest}}};
}

void runAssociation(const BenchmarkSettings& settings, const RowCallback& row) {
  using association::test::bestDivision;
  using association::test::bestPermutation;
  Disturbance clean;
  Disturbance noisy;
  noisy.pixel_stddev = 1.0;
  Disturbance disturbed;
  disturbed.dropout = 0.1;
  disturbed.ghosts = 1;
  for (const Case& c :
       {Case{"2 cameras", 2, clean, bestPermutation}, Case{"4 cameras", 4, clean, bestPermutation},
        Case{"4 cameras, 1 px", 4, noisy, bestPermutation}, Case{"8 cameras", 8, clean, nullptr},
        Case{"2 cameras, 10 % missing, a ghost each", 2, disturbed, bestDivision},
        Case{"4 cameras, 10 % missing, a ghost each", 4, disturbed, bestDivision},
        Case{"8 cameras, 10 % missing, a ghost each", 8, disturbed, nullptr}})
    row(runCase(c, settings));
}

}  // namespace

BenchmarkSection associationSection() {
  return {"association",
          "four identical LEDs at random places in the paper's cube, 0.5 px of noise, single "
          "frames of at most four spots. identical: share of frames with the same points as an "
          "exhaustive search; right: share with all points that two cameras see, and no other; "
          "proven: optimal; us, us_worst: processor time per frame, mean and longest.",
          runAssociation};
}

}  // namespace wiimote_tracker
