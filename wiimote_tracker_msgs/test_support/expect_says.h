#pragma once

#include <gtest/gtest.h>

#include <string>

/// The text contains this part. A failure shows the whole text.
#define EXPECT_SAYS(text, part) EXPECT_PRED_FORMAT2(testing::IsSubstring, part, text)
