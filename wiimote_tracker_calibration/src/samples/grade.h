#pragma once

#include <cstddef>
#include <string>

namespace wiimote_tracker::samples {

/// How good a rig is. Values as in CalibrationVerdict.msg.
enum class Grade { kGood = 0, kUsable = 1, kRedo = 2 };

/// The word that a verdict begins with.
inline std::string nameOf(Grade grade) {
  constexpr const char* kNames[] = {"good", "usable", "redo"};
  return kNames[static_cast<std::size_t>(grade)];
}

/// The grade of a verdict, of which a rig's file has only the text. Without its word: kUsable.
inline Grade gradeOf(const std::string& verdict) {
  for (const Grade grade : {Grade::kGood, Grade::kRedo}) {
    if (verdict.rfind(nameOf(grade), 0) == 0)
      return grade;
  }
  return Grade::kUsable;
}

}  // namespace wiimote_tracker::samples
