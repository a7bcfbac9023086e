#include "events/refusals.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace wiimote_tracker::events {
namespace {

bool holds(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

TEST(Refusals, TheFirstIsSaidAtOnceAndOthersTogether) {
  Refusals refusals{TriggerOptions()};
  EXPECT_FALSE(refusals.next(100.0));
  refusals.add(TriggerResult::kTooOld, "5.0");
  const auto first = refusals.next(100.0);
  ASSERT_TRUE(first);
  EXPECT_TRUE(holds(*first, "for the trigger at 5.0 s: it is older")) << *first;
  int said = 0;
  for (int i = 1; i <= 1000; ++i) {
    const double now = 100.0 + 0.1 * i;
    refusals.add(TriggerResult::kTooOld, std::to_string(i));
    while (const auto sentence = refusals.next(now)) {
      ++said;
      EXPECT_TRUE(holds(*sentence, "triggers, the last at " + std::to_string(i))) << *sentence;
      EXPECT_FALSE(holds(*sentence, "one stamp")) << *sentence;
    }
  }
  EXPECT_EQ(9, said);
  const auto rest = refusals.next(std::numeric_limits<double>::infinity());
  ASSERT_TRUE(rest);
  EXPECT_TRUE(holds(*rest, "at 1000 s")) << *rest;
}

TEST(Refusals, EachReasonIsSaid) {
  Refusals refusals{TriggerOptions()};
  refusals.add(TriggerResult::kTooOld, "5");
  refusals.add(TriggerResult::kTooEarly, "5000");
  EXPECT_TRUE(refusals.next(100.0));
  EXPECT_TRUE(refusals.next(100.0));
  EXPECT_FALSE(refusals.next(100.0));
}

TEST(Refusals, ATriggerAheadOfTheImagesMayMeanThatNoCameraSendsAny) {
  Refusals refusals{TriggerOptions()};
  refusals.add(TriggerResult::kTooEarly, "5000");
  const std::string sentence = *refusals.next(100.0);
  EXPECT_TRUE(holds(sentence, "ahead of the images: check that the cameras' drivers run"))
      << sentence;
}

TEST(Refusals, ARepeatedStampIsNamedAsTheCause) {
  Refusals refusals{TriggerOptions()};
  refusals.add(TriggerResult::kTooOld, "5");
  EXPECT_FALSE(holds(*refusals.next(100.0), "one stamp"));
  for (int i = 0; i < 3; ++i)
    refusals.add(TriggerResult::kTooOld, "5");
  EXPECT_FALSE(refusals.next(105.0));
  const std::string sentence = *refusals.next(111.0);
  EXPECT_TRUE(holds(sentence, "3 triggers, the last at 5 s")) << sentence;
  EXPECT_TRUE(holds(sentence, "all had one stamp")) << sentence;
  for (int i = 0; i < 3; ++i)
    refusals.add(TriggerResult::kNoTime, "0");
  const std::string without = *refusals.next(112.0);
  EXPECT_TRUE(holds(without, "3 triggers, the last at 0 s: it carries no time"));
  EXPECT_FALSE(holds(without, "one stamp")) << without;
}

TEST(Refusals, AreSaidOnceWhileTimeIsNotKnown) {
  Refusals refusals{TriggerOptions()};
  const double never = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < 5; ++i) {
    refusals.add(TriggerResult::kTooMany, "5");
    EXPECT_EQ(i == 0, refusals.next(never).has_value());
  }
  EXPECT_TRUE(refusals.next(100.0)) << "images came";
}

TEST(Refusals, AreSaidAtOnceWhenTimeJumpedBack) {
  Refusals refusals{TriggerOptions()};
  for (const double now : {100.0, 50.0}) {
    refusals.add(TriggerResult::kTooOld, "5");
    EXPECT_TRUE(refusals.next(now)) << now;
  }
}

}  // namespace
}  // namespace wiimote_tracker::events
