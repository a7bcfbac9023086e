// Rate and gaps for the diagnostics.
#include "wiimote/stream_statistics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace wiimote_tracker::wiimote {
namespace {

TEST(StreamStatistics, RateOfAWindow) {
  StreamStatistics statistics(10.0);
  for (int i = 1; i <= 100; ++i)
    statistics.add(10.0 + 0.01 * i);
  StreamStatistics::Summary summary = statistics.take(11.0);
  EXPECT_NEAR(100.0, summary.rate, 1e-9);
  EXPECT_NEAR(0.01, summary.longest_gap, 1e-9);
  EXPECT_EQ(0u, summary.gaps);
  summary = statistics.take(13.0);
  EXPECT_EQ(0.0, summary.rate);
  EXPECT_NEAR(2.0, summary.longest_gap, 1e-9) << "an unfinished gap counts";
}

TEST(StreamStatistics, GapsAreCountedOnceAndNotBeforeTheFirstImage) {
  StreamStatistics statistics(0.0);
  statistics.add(5.0);
  statistics.add(5.04);
  statistics.add(5.14);
  statistics.add(5.15);
  EXPECT_EQ(1u, statistics.take(5.2).gaps);
  statistics.add(5.3);
  EXPECT_EQ(2u, statistics.take(5.4).gaps);
}

TEST(StreamStatistics, TheRateCountsFromTheBeginningOfTheStream) {
  StreamStatistics statistics(0.0);
  for (const double begin : {0.8, 3.2, 5.45}) {  // again after a reconnect
    statistics.begin(begin);
    const double end = std::ceil(begin);
    for (double t = begin; t < end - 1e-6; t += 0.01)
      statistics.add(t);
    const StreamStatistics::Summary summary = statistics.take(end);
    EXPECT_EQ(end - begin >= 0.5, summary.has_rate) << begin;
    if (summary.has_rate) {
      EXPECT_NEAR(100.0, summary.rate, 1.0) << begin;
    }
  }
  EXPECT_TRUE(statistics.take(7.0).has_rate);
}

TEST(StreamStatistics, ReturnsOfTheStreamAreCountedForTenMinutes) {
  StreamStatistics statistics(0.0);
  statistics.begin(1.0);
  EXPECT_EQ(0, statistics.take(1.0).returns) << "it began for the first time";
  for (const double begin : {100.0, 101.0, 300.0}) {
    statistics.add(begin - 5.0);
    statistics.begin(begin - 4.0);  // set up anew, as after another program changed it
    statistics.lose();
    statistics.begin(begin);
  }
  EXPECT_EQ(3, statistics.take(300.0).returns);
  EXPECT_EQ(3, statistics.take(699.0).returns);
  EXPECT_EQ(1, statistics.take(702.0).returns);
  EXPECT_EQ(0, statistics.take(901.0).returns);
}

TEST(StreamStatistics, NothingAtAll) {
  StreamStatistics statistics(1.0);
  const StreamStatistics::Summary summary = statistics.take(1.0);
  EXPECT_EQ(0.0, summary.rate);
  EXPECT_EQ(0.0, summary.longest_gap);
}

}  // namespace
}  // namespace wiimote_tracker::wiimote
