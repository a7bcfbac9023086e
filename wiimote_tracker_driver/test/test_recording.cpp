// The file of a recording, byte by byte, and the recorder that writes it.
#include "contains.h"
#include "recording/reader.h"
#include "recording/recorder.h"
#include "refusal_of.h"
#include "temporary_folder.h"
#include "waiting.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

namespace wiimote_tracker::recording {
namespace {

using protocol::Report;
using Kind = Record::Kind;

std::string text(std::initializer_list<int> bytes) {
  return std::string(bytes.begin(), bytes.end());
}

// Written by hand from doc/recording_format.md.
const std::string kHeader = "\x89WII\r\n\x1a\n" + text({1, 0, 0, 0}) +
                            // 1 700 000 000 500 000 000 ns
                            text({0x00, 0x65, 0xf7, 0x53, 0xfe, 0x9c, 0x97, 0x17}) + "\x04test";
const std::string kConnected = text({1, 33, 0x40, 0x42, 0x0f, 0, 0, 0, 0, 0}) +  // 1 ms
                               "00:1f:32:00:00:01\nwiimote\nhidraw0";
const std::string kSent = text({3, 2, 0x80, 0x84, 0x1e, 0, 0, 0, 0, 0, 0x15, 0x00});  // 2 ms
const std::string kReceived =                                                         // 5 s
    text({2, 7, 0x00, 0xf2, 0x05, 0x2a, 1, 0, 0, 0, 0x20, 0, 0, 0x10, 0, 0, 0xa0});
const std::string kDisconnected = text({4, 4, 0x00, 0xf2, 0x05, 0x2a, 1, 0, 0, 0}) + "gone";
const std::string kAll = kHeader + kConnected + kSent + kReceived + kDisconnected;

struct Contents {
  FileHeader header;
  std::vector<Record> records;
  std::string damage;
};

Contents read(std::istream& in) {
  Reader reader(in);
  Contents contents;
  contents.header = reader.header();
  for (Record record; reader.next(record);)
    contents.records.push_back(record);
  contents.damage = reader.damage();
  Record record;
  EXPECT_FALSE(reader.next(record)) << "the end stays the end";
  return contents;
}

Contents read(const std::string& bytes) {
  std::istringstream in(bytes);
  return read(in);
}

std::string refusal(const std::string& bytes) {
  return refusalOf([&] { read(bytes); });
}

TEST(RecordingFormat, HandWrittenBytesAreRead) {
  const Contents contents = read(kAll);
  EXPECT_EQ("", contents.damage);
  EXPECT_DOUBLE_EQ(1700000000.5, contents.header.wall_time);
  EXPECT_EQ("test", contents.header.software);
  ASSERT_EQ(4u, contents.records.size());
  EXPECT_EQ(Kind::kConnected, contents.records[0].kind);
  EXPECT_DOUBLE_EQ(0.001, contents.records[0].time);
  EXPECT_EQ("00:1f:32:00:00:01", contents.records[0].remote.identity);
  EXPECT_EQ("wiimote", contents.records[0].remote.kernel_driver);
  EXPECT_EQ("hidraw0", contents.records[0].remote.description);
  EXPECT_EQ(Kind::kSent, contents.records[1].kind);
  EXPECT_DOUBLE_EQ(0.002, contents.records[1].time);
  EXPECT_EQ((Report{0x15, 0x00}), contents.records[1].report);
  EXPECT_EQ(Kind::kReceived, contents.records[2].kind);
  EXPECT_DOUBLE_EQ(5.0, contents.records[2].time);
  EXPECT_EQ((Report{0x20, 0, 0, 0x10, 0, 0, 0xa0}), contents.records[2].report);
  EXPECT_EQ(Kind::kDisconnected, contents.records[3].kind);
  EXPECT_EQ("gone", contents.records[3].reason);
}

TEST(RecordingFormat, AReportThatWaitedIsOfAKindOfItsOwn) {
  std::string waited = kReceived;
  waited[0] = 5;
  const Contents contents = read(kHeader + kReceived + waited);
  ASSERT_EQ(2u, contents.records.size());
  EXPECT_EQ(Kind::kReceived, contents.records[1].kind);
  EXPECT_EQ(contents.records[0].report, contents.records[1].report);
  EXPECT_FALSE(contents.records[0].waited);
  EXPECT_TRUE(contents.records[1].waited);
  std::vector<std::uint8_t> bytes;
  append(contents.records[1], bytes);
  EXPECT_EQ(waited, std::string(bytes.begin(), bytes.end()));
}

TEST(RecordingFormat, SameBytesAreWritten) {
  const Contents contents = read(kAll);
  std::vector<std::uint8_t> bytes;
  append(contents.header, bytes);
  for (const Record& record : contents.records)
    append(record, bytes);
  EXPECT_EQ(kAll, std::string(bytes.begin(), bytes.end()));
}

TEST(RecordingFormat, TruncatedAnywhereItIsReadUpToThereWithAnError) {
  std::vector<std::size_t> ends{kHeader.size()};
  for (const std::string& record : {kConnected, kSent, kReceived, kDisconnected})
    ends.push_back(ends.back() + record.size());
  for (std::size_t size = 0; size < kAll.size(); ++size) {
    const std::string bytes = kAll.substr(0, size);
    if (size < kHeader.size()) {
      EXPECT_TRUE(contains(refusal(bytes), "cut off")) << size;
      continue;
    }
    const Contents contents = read(bytes);
    const auto whole = std::upper_bound(ends.begin(), ends.end(), size) - ends.begin() - 1;
    EXPECT_EQ(static_cast<std::size_t>(whole), contents.records.size()) << size;
    const bool between_records = ends[static_cast<std::size_t>(whole)] == size;
    EXPECT_EQ(between_records, contents.damage.empty()) << size;
    EXPECT_EQ(!between_records,
              contains(contents.damage,
                       "cut off at byte " + std::to_string(ends[static_cast<std::size_t>(whole)])))
        << size << contents.damage;
  }
}

TEST(RecordingFormat, OtherFilesAreRefused) {
  EXPECT_TRUE(contains(refusal("#ROSBAG V2.0\n and so on, and so on"), "not a recording"));
  std::string sent_as_text = kAll;
  sent_as_text.erase(4, 1);  // the carriage return
  EXPECT_TRUE(contains(refusal(sent_as_text), "not a recording"));
  std::string future = kAll;
  future[8] = 7;
  EXPECT_TRUE(contains(refusal(future), "version 7"));
  std::string no_time = kAll;
  no_time[19] = 0x7f;
  EXPECT_TRUE(contains(refusal(no_time), "damaged"));
}

TEST(RecordingFormat, ADamagedRecordEndsIt) {
  const auto damage = [](const std::string& record) {
    const Contents contents = read(kHeader + kReceived + record + kReceived);
    EXPECT_EQ(1u, contents.records.size());
    return contents.damage;
  };
  const std::string time = kReceived.substr(2, 8);
  const std::string place = "damaged at byte " + std::to_string(kHeader.size() + kReceived.size());
  EXPECT_TRUE(contains(damage(text({0, 2}) + time + "xx"), place)) << "kind 0";
  EXPECT_TRUE(contains(damage(text({6, 2}) + time + "xx"), place)) << "kind 6";
  EXPECT_TRUE(contains(damage(text({2, 0}) + time), place)) << "empty report";
  EXPECT_TRUE(contains(damage(text({2, 23}) + time + std::string(23, 'x')), place)) << "too long";
  EXPECT_TRUE(contains(damage(kSent), place)) << "back in time";
  EXPECT_TRUE(contains(damage(text({2, 2}) + std::string(7, '\0') + "\x40xx"), place))
      << "146 years";
}

TEST(RecordingFormat, NoBytesMakeItCrash) {
  std::mt19937 random(7);
  for (int round = 0; round < 20000; ++round) {
    std::string bytes = kAll;
    const int changes = 1 + static_cast<int>(random() % 4);
    for (int i = 0; i < changes; ++i)
      bytes[random() % bytes.size()] = static_cast<char>(random());
    try {
      const Contents contents = read(bytes);
      EXPECT_LE(contents.records.size(), bytes.size() / kRecordHeaderSize);
      double last = 0.0;
      for (const Record& record : contents.records) {
        EXPECT_LE(last, record.time);
        EXPECT_LE(record.report.size, Report::kCapacity);
        last = record.time;
      }
    } catch (const BadRecording&) {
      // Its header was hit.
    }
  }
}

/// A separate directory for the recordings of each test.
class Recording : public testing::Test {
 protected:
  static Contents readFile(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return read(in);
  }

  const TemporaryFolder folder_;
  const std::string path_ = folder_ / "a.wiirec";
};

TEST_F(Recording, HoldsAllRecordsAtTheirTimes) {
  {
    Recorder recorder(path_, 1000.0, 1.7e9);
    EXPECT_EQ(path_, recorder.path());
    recorder.connected({"00:1f:32:00:00:01", "virtual:/tmp/x", "wiimote"}, 1000.25);
    recorder.sent({0x15, 0x00}, 1000.5);
    recorder.received({0x20, 0, 0, 0x10, 0, 0, 0xa0}, 1000.5078125);
    recorder.disconnected("it has gone", 1003.0);
    EXPECT_EQ("", recorder.error());
  }
  const Contents contents = readFile(path_);
  EXPECT_EQ("", contents.damage);
  EXPECT_DOUBLE_EQ(1.7e9, contents.header.wall_time);
  EXPECT_TRUE(contains(contents.header.software, "wiimote_tracker_driver "));
  ASSERT_EQ(4u, contents.records.size());
  EXPECT_DOUBLE_EQ(0.25, contents.records[0].time);
  EXPECT_EQ("virtual:/tmp/x", contents.records[0].remote.description);
  EXPECT_EQ((Report{0x15, 0x00}), contents.records[1].report);
  EXPECT_DOUBLE_EQ(0.5078125, contents.records[2].time);
  EXPECT_EQ((Report{0x20, 0, 0, 0x10, 0, 0, 0xa0}), contents.records[2].report);
  EXPECT_EQ("it has gone", contents.records[3].reason);
}

TEST_F(Recording, IsOnDiskWithoutBeingClosed) {
  Recorder recorder(path_, 0.0, 1.7e9);
  recorder.received({0x30, 0, 0}, 0.1);
  EXPECT_TRUE(eventually([&] {
    try {
      return readFile(path_).records.size() == 1;
    } catch (const BadRecording&) {
      return false;  // nothing has been written yet
    }
  }));
}

TEST_F(Recording, KeepsEarlierOnes) {
  const Recorder first(path_, 0.0, 0.0);
  const Recorder second(path_, 0.0, 0.0);
  const Recorder third(path_, 0.0, 0.0);
  EXPECT_EQ(folder_ / "a_2.wiirec", second.path());
  EXPECT_EQ(folder_ / "a_3.wiirec", third.path());
}

TEST_F(Recording, RefusesAFolderThatCannotBeWritten) {
  const std::string path = folder_ / "none/a.wiirec";
  try {
    const Recorder recorder(path, 0.0, 0.0);
    ADD_FAILURE() << "not refused";
  } catch (const BadRecording& e) {
    EXPECT_TRUE(contains(e.what(), path)) << e.what();
  }
}

TEST_F(Recording, RefusesAFolderADeviceAndAPipe) {
  const std::string path = folder_ / "recordings";
  std::filesystem::create_directory(path);
  const std::string pipe = folder_ / "pipe";
  ASSERT_EQ(0, ::mkfifo(pipe.c_str(), 0600));
  for (const std::string& name : {path, path + "/", std::string("/dev/null"), pipe}) {
    try {
      const Recorder recorder(name, 0.0, 0.0);
      ADD_FAILURE() << "not refused: " << name << " became " << recorder.path();
    } catch (const BadRecording& e) {
      EXPECT_TRUE(contains(e.what(), "(it is a ")) << e.what();
    }
  }
}

TEST_F(Recording, AFullDiskEndsItAndKeepsTheRest) {
  rlimit before{};
  ASSERT_EQ(0, ::getrlimit(RLIMIT_FSIZE, &before));
  rlimit small = before;
  small.rlim_cur = 1000;
  ASSERT_EQ(0, ::setrlimit(RLIMIT_FSIZE, &small));
  {
    Recorder recorder(path_, 0.0, 0.0);
    for (int i = 0; i < 100; ++i)
      recorder.received({0x30, 0, 0}, 0.01 * i);
    EXPECT_TRUE(eventually([&] { return !recorder.error().empty(); }));
    EXPECT_TRUE(contains(recorder.error(), path_)) << recorder.error();
    recorder.received({0x30, 0, 0}, 2.0);  // no harm
  }
  ASSERT_EQ(0, ::setrlimit(RLIMIT_FSIZE, &before));
  const Contents contents = readFile(path_);
  EXPECT_LT(50u, contents.records.size());
  EXPECT_TRUE(contains(contents.damage, "cut off"));
}

TEST_F(Recording, DeletedFileIsNoticed) {
  Recorder recorder(path_, 0.0, 0.0);
  ::unlink(path_.c_str());
  EXPECT_TRUE(eventually([&] { return contains(recorder.error(), "deleted"); }));
}

TEST_F(Recording, FinishTellsThatTheLastWriteFailed) {
  Recorder recorder(path_, 0.0, 0.0);
  ::unlink(path_.c_str());
  EXPECT_TRUE(contains(recorder.finish(), "deleted"));
}

/// This process's descriptor of an open file.
int descriptorOf(const std::string& path) {
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    std::error_code ignored;
    if (std::filesystem::read_symlink(entry.path(), ignored) == path)
      return std::stoi(entry.path().filename());
  }
  return -1;
}

TEST_F(Recording, FinishTellsThatTheFileCannotBeClosed) {
  Recorder recorder(path_, 0.0, 0.0);
  ASSERT_TRUE(eventually([&] { return std::filesystem::file_size(path_) > 0; }));
  // In place of a network drive that finds its disk full: close() fails for what is closed. By
  // number, since ThreadSanitizer reports close() while another thread has the file.
  ASSERT_EQ(0, ::syscall(SYS_close, descriptorOf(std::filesystem::canonical(path_))));
  EXPECT_TRUE(contains(recorder.finish(), "cannot be written (Bad file"));
}

}  // namespace
}  // namespace wiimote_tracker::recording
