#include "recording/replay.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <utility>

namespace wiimote_tracker::recording {
namespace {

using protocol::Report;

// A recorded request matches the host's if it was recorded at most this much later [s]: the
// recorded remote may have answered more slowly than this class.
constexpr double kLookAhead = 0.25;
// Time that open() waits for a recorded connection [s]; longer than the pause between two attempts.
constexpr double kConnectTimeout = 1.0;

// A request recorded at `time` comes after it: it was sent when that wait was over. Recorded times
// are rounded.
bool isAfter(const Record& record, double time) {
  return record.time > (record.kind == Record::Kind::kSent ? time - 1e-8 : time);
}

}  // namespace

Pace realTime(double speed) {
  using Clock = std::chrono::steady_clock;
  if (!(speed > 0.0))
    throw std::invalid_argument("a recording is played at a speed above 0");
  struct Start {
    Clock::time_point present;
    double recorded;  // [s]
  };
  return [speed, start = std::optional<Start>()](double time) mutable {
    if (!start)
      start = Start{Clock::now(), time};
    const std::chrono::duration<double> duration((time - start->recorded) / speed);
    std::this_thread::sleep_until(start->present +
                                  std::chrono::duration_cast<Clock::duration>(duration));
  };
}

class Replay::Transport : public transport::Transport {
 public:
  explicit Transport(Replay* replay) : replay_(replay) {}

  bool read(Report& report, double timeout) override { return replay_->read(report, timeout); }
  void write(const Report& report) override { replay_->write(report); }
  transport::Remote remote() const override {
    return {replay_->description_.identity, "replay:" + replay_->path_,
            replay_->description_.kernel_driver};
  }

 private:
  Replay* replay_;
};

Replay::Replay(const std::string& path, Pace pace) try
    : path_(path), pace_(std::move(pace)), file_(openRecording(path)), reader_(file_) {
  learn();
  passUntil(now_);
} catch (const BadRecording& e) {
  throw BadRecording(path + ": " + e.what());
}

void Replay::learn() {
  std::ifstream all = openRecording(path_);
  Reader first_reader(all);
  bool any = false;
  for (Record record; first_reader.next(record);) {
    remote_.learn(record);
    if (!any && record.kind == Record::Kind::kConnected) {
      now_ = record.time;
      any = true;
    }
  }
  damage_ = first_reader.damage();
  if (!any)
    throw BadRecording("the recording has no connection to a Wii Remote" +
                       (damage_.empty() ? "" : " (" + damage_ + ")") + ": choose another one");
}

void Replay::passUntil(double time) {
  if (pace_)
    pace_(time);
  now_ = std::max(now_, time);
}

/// Reads all events up to `time` into `ahead_`. @returns false if there is none left.
bool Replay::readAhead(double time) {
  while (ahead_.empty() || ahead_.back().record.time <= time) {
    Event event;
    if (!reader_.next(event.record))
      break;
    ahead_.push_back(std::move(event));
  }
  return !ahead_.empty();
}

Record Replay::take() {
  Record record = std::move(ahead_.front().record);
  ahead_.pop_front();
  return record;
}

std::string Replay::end() {
  ended_ = true;
  return "the recording " + path_ + " has ended" + (damage_.empty() ? "" : ": " + damage_);
}

std::unique_ptr<transport::Transport> Replay::open() {
  answers_.clear();
  // Reports that arrived while the host was not connected are lost.
  while (readAhead(now_) && (!connected_ || ahead_.front().record.time < now_)) {
    const Record& next = ahead_.front().record;
    if (!connected_ && next.time > now_ + kConnectTimeout)
      throw transport::NoSuchDevice("the Wii Remote was away at this time of the recording " +
                                    path_ + ": wait");
    const Record record = take();
    if (record.kind == Record::Kind::kConnected) {
      connected_ = true;
      description_ = record.remote;
      passUntil(record.time);
    } else if (record.kind == Record::Kind::kDisconnected) {
      connected_ = false;
    } else if (record.kind == Record::Kind::kSent) {
      remote_.recordedHostSent(record.report);
    }
  }
  if (ahead_.empty())
    throw transport::NoSuchDevice(end());
  return std::make_unique<Transport>(this);
}

bool Replay::read(Report& report, double timeout) {
  if (!answers_.empty()) {
    report = answers_.front();
    answers_.pop_front();
    return true;
  }
  const double until = now_ + timeout;
  while (readAhead(until)) {
    // What had waited was there when the host read next; by then time had passed.
    const Record& next = ahead_.front().record;
    if (isAfter(next, until) && !next.waited) {
      passUntil(until);
      return false;
    }
    const Record record = take();
    passUntil(record.time);
    switch (record.kind) {
      case Record::Kind::kReceived:
        report = record.report;
        remote_.putOwnValuesInto(report);
        return true;
      case Record::Kind::kSent:
        remote_.recordedHostSent(record.report);
        break;
      case Record::Kind::kConnected:
        description_ = record.remote;
        break;
      case Record::Kind::kDisconnected:
        disconnect(record.reason);
    }
  }
  connected_ = false;
  throw transport::Disconnected(end());
}

void Replay::disconnect(const std::string& reason) {
  connected_ = false;
  if (!readAhead(now_))
    throw transport::Disconnected(end());
  throw transport::Disconnected(
      "in the recording " + path_ + ", " +
      (reason.empty() ? "the driver released the Wii Remote at this time" : reason));
}

void Replay::write(const Report& report) {
  remote_.hostSends(report);
  readAhead(now_ + kLookAhead);
  for (Event& event : ahead_) {
    const Record& record = event.record;
    if (record.time > now_ + kLookAhead || record.kind == Record::Kind::kDisconnected)
      break;
    if (record.kind == Record::Kind::kSent && !event.matched &&
        sameRequest(record.report, report)) {
      event.matched = true;
      return;
    }
  }
  remote_.answer(report, answers_);
}

std::string Replay::notice() const {
  std::string sentences = damage_;
  const auto add = [&sentences](const char* sentence) {
    sentences += (sentences.empty() ? "" : "; ") + std::string(sentence);
  };
  if (remote_.sensitivityDiffers())
    add("the recording was made with another sensitivity of the camera, which is kept");
  if (remote_.formatDiffers())
    add("the recording was made with another infrared format, which is kept");
  return sentences;
}

}  // namespace wiimote_tracker::recording
