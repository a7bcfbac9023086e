#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_msgs/text.h>

#include <gtest/gtest.h>
#include <boost/locale/encoding_utf.hpp>

#include <random>
#include <string>

namespace wiimote_tracker {
namespace {

bool isUtf8(const std::string& text) {
  return boost::locale::conv::utf_to_utf<char>(text) == text;
}

TEST(UtcDate, IsOfThePatternAndEmptyWithoutADate) {
  EXPECT_EQ("2023-11-14 22:13:20 UTC", utcDate(1.7e9));
  EXPECT_EQ("20231114_221320", utcDate(1.7e9, "%Y%m%d_%H%M%S"));
  EXPECT_EQ("", utcDate(9e18));
}

TEST(Counted, HasAPluralButForOne) {
  EXPECT_EQ(counted(0, "LED"), "0 LEDs");
  EXPECT_EQ(counted(1, "LED"), "1 LED");
  EXPECT_EQ(counted(2, "LED"), "2 LEDs");
}

TEST(ValidUtf8, KeepsEveryCharacter) {
  for (const std::string text :
       {"", "a\n~", "\xC2\x80\xDF\xBF", "\xE0\xA0\x80\xED\x9F\xBF\xEE\x80\x80\xEF\xBF\xBF",
        "\xF0\x90\x80\x80\xF4\x8F\xBF\xBF", "\xEF\xBF\xBD"})
    EXPECT_EQ(validUtf8(text), text);
}

TEST(ValidUtf8, ReplacesEveryOtherByte) {
  const std::string mark = "\xEF\xBF\xBD";
  EXPECT_EQ(validUtf8("a\xE9z"), "a" + mark + "z");
  EXPECT_EQ(validUtf8("\xC3"), mark);                        // cut off
  EXPECT_EQ(validUtf8("\xE2\x82z"), mark + mark + "z");      // cut off
  EXPECT_EQ(validUtf8("\xC1\xBF"), mark + mark);             // longer than needed
  EXPECT_EQ(validUtf8("\xED\xA0\x80"), mark + mark + mark);  // a surrogate
  EXPECT_EQ(validUtf8("\xF4\x90\x80\x80"), mark + mark + mark + mark);
}

TEST(ValidUtf8, IsValidWhateverCame) {
  std::mt19937 random(1);
  const std::string likely = "az\x80\xA0\xBF\xC3\xE0\xE2\xED\xF0\xF4\xFF";
  for (int i = 0; i < 20000; ++i) {
    std::string text;
    for (int k = 0; k < 6; ++k)
      text +=
          random() % 4 == 0 ? static_cast<char>(random() % 256) : likely[random() % likely.size()];
    const std::string valid = validUtf8(text);
    ASSERT_TRUE(isUtf8(valid)) << i;
    ASSERT_EQ(valid == text, isUtf8(text)) << i;
  }
}

TEST(Error, IsUtf8) {
  EXPECT_STREQ(FileError("caf\xE9").what(), "caf\xEF\xBF\xBD");
}

}  // namespace
}  // namespace wiimote_tracker
