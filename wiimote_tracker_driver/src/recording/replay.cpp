#include "recording/replay.h"

#include "recorded_remote.h"
#include "recording/reader.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <fstream>
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

struct Replay::State {
  State(const std::string& file_path, Pace replay_pace)
      : path(file_path), pace(std::move(replay_pace)), file(openRecording(path)), reader(file) {
    learn();
    passUntil(now);
  }

  const std::string path;
  const Pace pace;
  std::ifstream file;
  Reader reader;

  double now = 0.0;
  bool ended = false;
  bool connected = false;
  transport::Remote description;
  RecordedRemote remote;
  std::string damage;

  struct Event {
    Record record;
    bool matched = false;  ///< A request that the present host has sent, too.
  };
  std::deque<Event> ahead;  ///< Read but not yet played.
  std::deque<Report> answers;

  void learn() {
    std::ifstream all = openRecording(path);
    Reader first_reader(all);
    bool any = false;
    for (Record record; first_reader.next(record);) {
      remote.learn(record);
      if (!any && record.kind == Record::Kind::kConnected) {
        now = record.time;
        any = true;
      }
    }
    damage = first_reader.damage();
    if (!any)
      throw BadRecording("the recording has no connection to a Wii Remote" +
                         (damage.empty() ? "" : " (" + damage + ")") + ": choose another one");
  }

  void passUntil(double time) {
    if (pace)
      pace(time);
    now = std::max(now, time);
  }

  /// Reads all events up to `time` into `ahead`. @returns false if there is none left.
  bool readAhead(double time) {
    while (ahead.empty() || ahead.back().record.time <= time) {
      Event event;
      if (!reader.next(event.record))
        break;
      ahead.push_back(std::move(event));
    }
    return !ahead.empty();
  }

  Record take() {
    Record record = std::move(ahead.front().record);
    ahead.pop_front();
    return record;
  }

  std::string end() {
    ended = true;
    return "the recording " + path + " has ended" + (damage.empty() ? "" : ": " + damage);
  }

  void connect() {
    answers.clear();
    // Reports that arrived while the host was not connected are lost.
    while (readAhead(now) && (!connected || ahead.front().record.time < now)) {
      const Record& next = ahead.front().record;
      if (!connected && next.time > now + kConnectTimeout)
        throw transport::NoSuchDevice("the Wii Remote was away at this time of the recording " +
                                      path + ": wait");
      const Record record = take();
      if (record.kind == Record::Kind::kConnected) {
        connected = true;
        description = record.remote;
        passUntil(record.time);
      } else if (record.kind == Record::Kind::kDisconnected) {
        connected = false;
      } else if (record.kind == Record::Kind::kSent) {
        remote.recordedHostSent(record.report);
      }
    }
    if (ahead.empty())
      throw transport::NoSuchDevice(end());
  }

  bool read(Report& report, double timeout) {
    if (!answers.empty()) {
      report = answers.front();
      answers.pop_front();
      return true;
    }
    const double until = now + timeout;
    while (readAhead(until)) {
      if (isAfter(ahead.front().record, until)) {
        passUntil(until);
        return false;
      }
      const Record record = take();
      passUntil(record.time);
      switch (record.kind) {
        case Record::Kind::kReceived:
          report = record.report;
          remote.putOwnValuesInto(report);
          return true;
        case Record::Kind::kSent:
          remote.recordedHostSent(record.report);
          break;
        case Record::Kind::kConnected:
          description = record.remote;
          break;
        case Record::Kind::kDisconnected:
          disconnect(record.reason);
      }
    }
    connected = false;
    throw transport::Disconnected(end());
  }

  [[noreturn]] void disconnect(const std::string& reason) {
    connected = false;
    if (!readAhead(now))
      throw transport::Disconnected(end());
    throw transport::Disconnected(
        "in the recording " + path + ", " +
        (reason.empty() ? "the driver released the Wii Remote at this time" : reason));
  }

  void write(const Report& report) {
    remote.hostSends(report);
    readAhead(now + kLookAhead);
    for (Event& event : ahead) {
      const Record& record = event.record;
      if (record.time > now + kLookAhead || record.kind == Record::Kind::kDisconnected)
        break;
      if (record.kind == Record::Kind::kSent && !event.matched &&
          sameRequest(record.report, report)) {
        event.matched = true;
        return;
      }
    }
    remote.answer(report, answers);
  }
};

class Replay::Transport : public transport::Transport {
 public:
  explicit Transport(std::shared_ptr<State> state) : state_(std::move(state)) {}

  bool read(Report& report, double timeout) override { return state_->read(report, timeout); }
  void write(const Report& report) override { state_->write(report); }
  transport::Remote remote() const override {
    return {state_->description.identity, "replay:" + state_->path,
            state_->description.kernel_driver};
  }

 private:
  std::shared_ptr<State> state_;
};

Replay::Replay(const std::string& path, Pace pace) {
  try {
    state_ = std::make_shared<State>(path, std::move(pace));
  } catch (const BadRecording& e) {
    throw BadRecording(path + ": " + e.what());
  }
}

Replay::~Replay() = default;

std::unique_ptr<transport::Transport> Replay::open() {
  state_->connect();
  return std::make_unique<Transport>(state_);
}

double Replay::now() const {
  return state_->now;
}

double Replay::wallTime() const {
  return state_->reader.header().wall_time + state_->now;
}

void Replay::pass(double duration) {
  state_->passUntil(state_->now + duration);
}

bool Replay::ended() const {
  return state_->ended;
}

std::optional<protocol::IrFormat> Replay::irFormat() const {
  return state_->remote.irFormat();
}

std::string Replay::notice() const {
  std::string sentences = state_->damage;
  const auto add = [&sentences](const char* sentence) {
    sentences += (sentences.empty() ? "" : "; ") + std::string(sentence);
  };
  if (state_->remote.sensitivityDiffers())
    add("the recording was made with another sensitivity of the camera, which is kept");
  if (state_->remote.formatDiffers())
    add("the recording was made with another infrared format, which is kept");
  return sentences;
}

}  // namespace wiimote_tracker::recording
