// Which reports form an image.
#include "wiimote/image_assembler.h"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

namespace wiimote_tracker::wiimote {
namespace {

using protocol::DataReport;
using protocol::IrFormat;
using protocol::Report;

/// One half of image `number`; both halves show a light at x = number in the first slot.
Report half(bool second, int number) {
  Report report{static_cast<std::uint8_t>(second ? 0x3f : 0x3e), 0, 0, 0x80};
  report.size = 22;
  std::fill(report.bytes.begin() + 4, report.bytes.end(), 0xff);
  report.bytes[4] = static_cast<std::uint8_t>(number);
  report.bytes[5] = 10;
  report.bytes[6] = static_cast<std::uint8_t>(number >> 8 << 4 | 2);
  std::fill_n(report.bytes.begin() + 7, 6, 1);
  return report;
}

Report first(int number) {
  return half(false, number);
}
Report second(int number) {
  return half(true, number);
}

TEST(ImageAssembler, OneReportAnImageUnlessTheFormatIsFull) {
  ImageAssembler basic(IrFormat::kBasic);
  ImageAssembler extended(IrFormat::kExtended);
  EXPECT_EQ(0x37, basic.reportMode());
  EXPECT_EQ(0x33, extended.reportMode());
  Report report{0x33, 0, 0, 0, 0, 0};
  report.size = 18;
  EXPECT_TRUE(extended.add(report, 0.0));
  EXPECT_FALSE(basic.add(report, 0.0));
  EXPECT_FALSE(extended.add(first(1), 0.0));
  EXPECT_TRUE(extended.expects(0x33));
  EXPECT_FALSE(extended.expects(0x37));
  EXPECT_FALSE(extended.expects(0x3f));
  EXPECT_THROW(ImageAssembler{IrFormat::kNone}, std::invalid_argument);
}

class ImageHalves : public testing::Test {
 protected:
  /// The number of the image that the report completes; -1: none; -2: a mixed one.
  int add(const Report& report, double now) {
    const std::optional<DataReport> image = images_.add(report, now);
    if (!image)
      return -1;
    EXPECT_TRUE(image->spots[0].seen && image->spots[2].seen);
    return image->spots[0].x == image->spots[2].x ? image->spots[0].x : -2;
  }

  ImageAssembler images_{IrFormat::kFull};
};

TEST_F(ImageHalves, HalvesMakeAnImage) {
  EXPECT_EQ(0x3e, images_.reportMode());
  EXPECT_TRUE(images_.expects(0x3e) && images_.expects(0x3f));
  EXPECT_FALSE(images_.expects(0x33));
  for (int number = 0; number < 10; ++number) {
    EXPECT_EQ(-1, add(first(number), 0.02 * number));
    EXPECT_EQ(number, add(second(number), 0.02 * number + 0.01));
  }
}

TEST_F(ImageHalves, LostHalfGivesNoImage) {
  EXPECT_EQ(-1, add(first(1), 0.00));
  EXPECT_EQ(-1, add(first(2), 0.02));  // the second half of 1 was lost
  EXPECT_EQ(2, add(second(2), 0.03));
  EXPECT_EQ(-1, add(second(3), 0.05));  // the first half of 3 was lost
  EXPECT_EQ(-1, add(first(4), 0.06));
  EXPECT_EQ(4, add(second(4), 0.07));
}

TEST_F(ImageHalves, HalvesOfDifferentImagesAreNeverPutTogether) {
  EXPECT_EQ(-1, add(first(1), 0.00));
  EXPECT_EQ(-1, add(second(2), 0.03));  // two reports between them were lost
  EXPECT_EQ(-1, add(second(3), 0.05));
}

TEST_F(ImageHalves, LateSecondHalfStillCounts) {
  EXPECT_EQ(-1, add(first(1), 0.000));
  EXPECT_EQ(1, add(second(1), 0.024));
}

TEST_F(ImageHalves, SecondHalfIsUsedOnce) {
  EXPECT_EQ(-1, add(first(1), 0.00));
  EXPECT_EQ(1, add(second(1), 0.01));
  EXPECT_EQ(-1, add(second(1), 0.01));
}

TEST_F(ImageHalves, TruncatedHalfGivesNoImage) {
  Report cut = second(1);
  cut.size = 21;
  EXPECT_EQ(-1, add(first(1), 0.00));
  EXPECT_EQ(-1, add(cut, 0.01));
  EXPECT_EQ(-1, add(second(1), 0.01));
}

// Random losses, alone and in bursts, with reports in order and on time.
TEST_F(ImageHalves, NoLossMixesImages) {
  std::mt19937 random(5);
  int complete = 0;
  int whole = 0;
  bool burst = false;
  bool got_first = false;
  for (int i = 0; i < 200000; ++i) {
    burst = random() % (burst ? 3 : 50) == 0;
    const int number = i / 2 % 1000;
    const bool is_second = i % 2 == 1;
    if (burst) {
      got_first = false;
      continue;
    }
    whole += is_second && got_first;
    got_first = !is_second;
    const int image = add(half(is_second, number), 0.01 * i + 1e-5 * (random() % 400));
    ASSERT_NE(-2, image) << "report " << i;
    complete += image >= 0;
  }
  EXPECT_EQ(whole, complete) << "every image whose halves both came";
}

}  // namespace
}  // namespace wiimote_tracker::wiimote
