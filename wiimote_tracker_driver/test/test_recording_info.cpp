// The summary that recording_info prints.
#include "contains.h"
#include "tools/recording_info/summary.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace wiimote_tracker::recording_info {
namespace {

using recording::Record;
using Kind = Record::Kind;

class Info : public testing::Test {
 protected:
  Info() {
    recording::FileHeader header;
    header.wall_time = 1.7e9;
    header.software = "test 1";
    append(header, bytes_);
  }

  void add(Kind kind, double time, const protocol::Report& report = {}, const char* reason = "") {
    Record record;
    record.kind = kind;
    record.time = time;
    record.report = report;
    record.remote = {"00:1f:32:00:00:01", "/dev/hidraw3", "wiimote"};
    record.reason = reason;
    append(record, bytes_);
  }

  Summary summary(std::size_t cut_off = 0) const {
    std::istringstream in(std::string(bytes_.begin(), bytes_.end() - static_cast<int>(cut_off)));
    recording::Reader reader(in);
    return summarize(reader);
  }

  std::vector<std::uint8_t> bytes_;
};

TEST(Recordings, OfVersion1AreRead) {
  std::ifstream in(VERSION_1 "/wiimote_1.wrec", std::ios::binary);
  recording::Reader reader(in);
  const Summary read = summarize(reader);
  EXPECT_EQ("", read.damage);
  EXPECT_EQ("wiimote_tracker_driver 0.1.0", read.header.software);
  EXPECT_EQ(1u, read.connections.size());
  EXPECT_EQ(258u, read.received[0x33]);
}

TEST_F(Info, TwoConnections) {
  add(Kind::kConnected, 1.0);
  add(Kind::kSent, 1.0, {0x15, 0});
  add(Kind::kReceived, 1.01, {0x20, 0, 0, 0, 0, 0, 0xa0});
  for (int i = 0; i < 100; ++i)
    add(Kind::kReceived, 2.0 + 0.01 * i, {0x33, 0, 0});
  add(Kind::kReceived, 3.09, {0x33, 0, 0});  // a gap of 100 ms
  add(Kind::kDisconnected, 3.5, {}, "it has gone");
  add(Kind::kConnected, 10.0);
  add(Kind::kReceived, 10.5, {0x33, 0, 0});  // no interval
  add(Kind::kReceived, 10.52, {0x33, 0, 0});
  add(Kind::kDisconnected, 11.0);

  const Summary found = summary();
  EXPECT_EQ("", found.damage);
  EXPECT_DOUBLE_EQ(11.0, found.duration);
  ASSERT_EQ(2u, found.connections.size());
  EXPECT_DOUBLE_EQ(1.0, found.connections[0].begin);
  EXPECT_DOUBLE_EQ(3.5, found.connections[0].end);
  EXPECT_TRUE(found.connections[0].ended);
  EXPECT_EQ("it has gone", found.connections[0].end_reason);
  EXPECT_TRUE(found.connections[1].ended);
  EXPECT_EQ("", found.connections[1].end_reason);
  EXPECT_EQ(103u, found.received[0x33]);
  EXPECT_EQ(1u, found.received[0x20]);
  EXPECT_EQ(1u, found.sent[0x15]);
  ASSERT_EQ(101u, found.intervals.size());
  EXPECT_NEAR(0.01, found.intervals.front(), 1e-6);
  EXPECT_NEAR(0.1, found.intervals.back(), 1e-6);

  const std::string text = describe(found);
  for (const char* part :
       {"test 1", "2023-11-14 22:13:20 UTC", "duration       11.000 s", "connections    2",
        "00:1f:32:00:00:01 at /dev/hidraw3", "it has gone", "the driver released it",
        "0x33       103  extended infrared", "data           91.0 reports a second",
        "p50 10.0, p99 20.0, longest 100.0 ms", "gaps           1 over 50 ms",
        "complete       yes"})
    EXPECT_TRUE(contains(text, part)) << part << " in\n" << text;
}

TEST_F(Info, CutOff) {
  add(Kind::kConnected, 1.0);
  add(Kind::kReceived, 2.0, {0x33, 0, 0});
  add(Kind::kReceived, 3.0, {0x33, 0, 0});
  const Summary found = summary(1);
  EXPECT_EQ(1u, found.received[0x33]);
  ASSERT_EQ(1u, found.connections.size());
  EXPECT_FALSE(found.connections[0].ended);
  EXPECT_DOUBLE_EQ(2.0, found.connections[0].end);
  EXPECT_TRUE(contains(describe(found), "complete       no: the recording is cut off"));
}

TEST_F(Info, AnEmptyRecording) {
  const Summary found = summary();
  EXPECT_FALSE(contains(describe(found), "interval"));
  EXPECT_TRUE(contains(describe(found), "connections    0"));
}

TEST(OpenRecording, NeitherAFolderNorNothingIsARecording) {
  EXPECT_THROW(recording::openRecording("/"), recording::BadRecording);
  EXPECT_THROW(recording::openRecording("/nowhere/at/all"), recording::BadRecording);
}

}  // namespace
}  // namespace wiimote_tracker::recording_info
