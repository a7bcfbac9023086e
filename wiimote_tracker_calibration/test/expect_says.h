#ifndef WIIMOTE_TRACKER_CALIBRATION_TEST_EXPECT_SAYS_H
#define WIIMOTE_TRACKER_CALIBRATION_TEST_EXPECT_SAYS_H

#include <gtest/gtest.h>

#include <string>

/// The text contains this part. A failure shows the whole text.
#define EXPECT_SAYS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

#endif  // WIIMOTE_TRACKER_CALIBRATION_TEST_EXPECT_SAYS_H
