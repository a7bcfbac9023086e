#pragma once

#include "dataset.h"
#include "gesture/recognizer.h"

#include <cstddef>
#include <string>
#include <vector>

namespace wiimote_tracker::gesture_tool {

/// The result of one method.
struct MethodResult {
  std::string name;
  std::size_t right = 0;
};

struct Evaluation {
  std::vector<std::string> gestures;                ///< Names, sorted.
  std::vector<std::vector<std::size_t>> confusion;  ///< [drawn][recognised], of this package.
  std::size_t tested = 0;
  std::size_t right = 0;     ///< By this package, accepted or not.
  std::size_t rejected = 0;  ///< Of those tested, by this package.

  /// Unknown gestures that were rejected: each sample is tested once more without the examples of
  /// its own gesture.
  std::size_t unknown_rejected = 0;

  std::size_t examples = 0;     ///< Largest number of examples used at once.
  double median_seconds = 0.0;  ///< Of one recognition of this package [s].
  std::vector<MethodResult> others;
};

/// Tests every sample of `test` with the examples of the people in `train`, never with those of the
/// same person (the same folder).
/// @param examples per gesture, each of another person, in cyclic order from the one after the
/// person tested; 0: all.
/// @throws Error: no person is left to learn from.
Evaluation evaluate(const std::vector<Person>& train,
                    const std::vector<Person>& test,
                    std::size_t examples,
                    const gesture::RecognizerOptions& options);

/// Gestures found in motion that contains none, summed over all markers.
struct FalseAlarms {
  double minutes = 0.0;           ///< Of motion, summed over the markers [min].
  std::size_t continuous = 0;     ///< Found by the spotter.
  std::size_t between_rests = 0;  ///< Found in segments between rests.
};

/// @param motion  CSV with a header line: time [s], then x, y, z [mm] of each marker.
/// @throws Error.
FalseAlarms countFalseAlarms(const std::vector<Person>& teachers,
                             const std::string& motion,
                             const gesture::RecognizerOptions& options);

}  // namespace wiimote_tracker::gesture_tool
