#include "invariants.h"
#include "targets.h"

#include "recording/reader.h"
#include "recording/replay.h"
#include "wiimote/wiimote.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <sstream>
#include <string>

namespace wiimote_tracker::fuzz {
namespace {

using recording::BadRecording;

// Turns of the driver; recordings can be years long.
constexpr int kMostTurns = 3000;

/// A file that exists in memory only.
class MemoryFile {
 public:
  MemoryFile(const std::uint8_t* data, std::size_t size) : fd_(::memfd_create("recording", 0)) {
    require(fd_ >= 0 && ::write(fd_, data, size) == static_cast<ssize_t>(size),
            "there is memory for the recording");
  }
  ~MemoryFile() { ::close(fd_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string path() const { return "/proc/self/fd/" + std::to_string(fd_); }

 private:
  int fd_;
};

/// @returns whether it can be played.
bool readThrough(const std::string& bytes) {
  std::istringstream in(bytes);
  try {
    recording::Reader reader(in);
    require(std::isfinite(reader.header().wall_time), "the recording has a date");
    std::size_t records = 0;
    double time = 0.0;
    bool connected = false;
    for (recording::Record record; reader.next(record);) {
      require(++records <= bytes.size() / recording::kRecordHeaderSize, "a record takes its bytes");
      require(record.time >= time && std::isfinite(record.time), "time does not go back");
      require(record.report.size <= protocol::Report::kCapacity, "a report fits");
      time = record.time;
      connected = connected || record.kind == recording::Record::Kind::kConnected;
    }
    recording::Record record;
    require(!reader.next(record), "the end is the end");
    return connected;
  } catch (const BadRecording&) {
    return false;
  }
}

void play(const std::string& path) {
  recording::Replay replay(path);
  wiimote::Options options;
  options.ir_format = replay.irFormat().value_or(protocol::IrFormat::kExtended);
  wiimote::Wiimote wiimote(
      options, [&](bool) { return replay.open(); }, [&] { return replay.now(); });
  for (int turn = 0; turn < kMostTurns && !replay.ended(); ++turn) {
    const double before = replay.now();
    replay.pass(wiimote.idleTime());
    const auto image = wiimote.step(0.1);
    if (image)
      requireImage(*image, options.ir_format);
    require(std::isfinite(replay.now()) && replay.now() >= before, "time does not go back");
  }
  require(replay.notice().size() < 1000, "a notice is some sentences");
}

}  // namespace

void fuzzReplay(const std::uint8_t* data, std::size_t size) {
  const bool playable = readThrough(std::string(reinterpret_cast<const char*>(data), size));
  const MemoryFile file(data, size);
  try {
    play(file.path());
    require(playable, "who can be played can be read");
  } catch (const BadRecording&) {
    require(!playable, "who can be read can be played");
  }
}

}  // namespace wiimote_tracker::fuzz
