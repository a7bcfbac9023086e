#ifndef WIIMOTE_TRACKER_MSGS_TEST_SUPPORT_EXPECT_SAYS_H
#define WIIMOTE_TRACKER_MSGS_TEST_SUPPORT_EXPECT_SAYS_H

#include <gtest/gtest.h>

#include <string>

/// The text contains this part. A failure shows the whole text.
#define EXPECT_SAYS(text, part) EXPECT_PRED_FORMAT2(testing::IsSubstring, part, text)

#endif  // WIIMOTE_TRACKER_MSGS_TEST_SUPPORT_EXPECT_SAYS_H
