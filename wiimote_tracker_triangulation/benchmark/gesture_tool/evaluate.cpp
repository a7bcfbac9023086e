#include "evaluate.h"

#include "baselines.h"
#include "wiimote_tracker_triangulation/geometry/error.h"

#include <wiimote_tracker_msgs/median.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <utility>

namespace wiimote_tracker::gesture_tool {
namespace {

using Distance = double (*)(const Cloud&, const Cloud&);

constexpr std::pair<const char*, Distance> kOtherMethods[] = {
    {"$P point cloud", pointCloudDistance},
    {"dynamic time warping", timeWarpingDistance}};

/// The examples for testing one person.
std::vector<const Sample*> examplesFor(const Person& person,
                                       const std::vector<Person>& train,
                                       std::size_t count) {
  const auto own = std::find_if(train.begin(), train.end(),
                                [&](const Person& p) { return p.folder == person.folder; });
  const auto first = own == train.end() ? 0 : static_cast<std::size_t>(own - train.begin()) + 1;
  std::vector<const Sample*> samples;
  std::size_t people = 0;
  for (std::size_t k = 0; k < train.size(); ++k) {
    const Person& teacher = train[(first + k) % train.size()];
    if (teacher.folder == person.folder || (count > 0 && people == count))
      continue;
    ++people;
    for (const Sample& sample : teacher.samples)
      samples.push_back(&sample);
  }
  if (samples.empty())
    throw Error("there is nobody but " + person.folder +
                " to learn from; give --train another person's gestures");
  return samples;
}

std::size_t indexOf(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<std::size_t>(std::lower_bound(names.begin(), names.end(), name) -
                                  names.begin());
}

}  // namespace

Evaluation evaluate(const std::vector<Person>& train,
                    const std::vector<Person>& test,
                    std::size_t examples,
                    const gesture::RecognizerOptions& options) {
  Evaluation result;
  std::set<std::string> names;
  for (const std::vector<Person>* people : {&train, &test}) {
    for (const Person& person : *people) {
      for (const Sample& sample : person.samples)
        names.insert(sample.gesture);
    }
  }
  result.gestures.assign(names.begin(), names.end());
  result.confusion.assign(names.size(), std::vector<std::size_t>(names.size(), 0));
  for (const auto& [name, distance] : kOtherMethods)
    result.others.push_back({name, 0});

  std::vector<double> seconds;
  for (const Person& person : test) {
    const std::vector<const Sample*> teachers = examplesFor(person, train, examples);
    result.examples = std::max(result.examples, teachers.size());
    gesture::Recognizer recognizer(options);
    std::vector<Cloud> clouds;
    for (const Sample* sample : teachers) {
      recognizer.add({sample->gesture, "", sample->path});
      clouds.push_back(cloudOf(sample->path));
    }
    for (const Sample& sample : person.samples) {
      ++result.tested;
      const auto start = std::chrono::steady_clock::now();
      const auto recognition = recognizer.recognize(sample.path);
      seconds.push_back(
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
      if (!recognition || !recognition->accepted())
        ++result.rejected;
      if (recognition) {
        result.right += recognition->gesture == sample.gesture ? 1 : 0;
        ++result.confusion[indexOf(result.gestures, sample.gesture)]
                          [indexOf(result.gestures, recognition->gesture)];
      }

      gesture::Recognizer without = recognizer;
      without.remove(sample.gesture);
      const auto unknown = without.recognize(sample.path);
      result.unknown_rejected += !unknown || !unknown->accepted() ? 1 : 0;

      const Cloud cloud = cloudOf(sample.path);
      for (std::size_t m = 0; m < result.others.size(); ++m) {
        std::vector<double> distances;
        for (const Cloud& example : clouds)
          distances.push_back(kOtherMethods[m].second(cloud, example));
        const auto nearest = std::min_element(distances.begin(), distances.end());
        const Sample& taken = *teachers[static_cast<std::size_t>(nearest - distances.begin())];
        result.others[m].right += taken.gesture == sample.gesture ? 1 : 0;
      }
    }
  }
  result.median_seconds = medianOf(&seconds);
  return result;
}

}  // namespace wiimote_tracker::gesture_tool
