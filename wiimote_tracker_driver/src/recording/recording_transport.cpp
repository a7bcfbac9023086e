#include "recording/recorder.h"
#include "transport/queue_watch.h"

#include <utility>

namespace wiimote_tracker::recording {
namespace {

class RecordingTransport : public transport::Transport {
 public:
  RecordingTransport(std::unique_ptr<transport::Transport> transport,
                     std::shared_ptr<Recorder> recorder,
                     std::function<double()> clock)
      : transport_(std::move(transport)),
        recorder_(std::move(recorder)),
        clock_(std::move(clock)),
        queue_(clock_()) {
    recorder_->connected(transport_->remote(), clock_());
  }
  ~RecordingTransport() override { lose(""); }
  RecordingTransport(const RecordingTransport&) = delete;
  RecordingTransport& operator=(const RecordingTransport&) = delete;

  bool read(protocol::Report& report, double timeout) override {
    bool received = false;
    orLose([&] { received = transport_->read(report, timeout); });
    const double now = clock_();
    queue_.readEnded(received, timeout, now);
    if (received)
      recorder_->received(report, now, queue_.waited());
    return received;
  }

  void write(const protocol::Report& report) override {
    orLose([&] { transport_->write(report); });
    recorder_->sent(report, clock_());
  }

  transport::Remote remote() const override { return transport_->remote(); }

 private:
  template <typename Action>
  void orLose(Action action) {
    try {
      action();
    } catch (const transport::TransportError& e) {
      lose(e.what());
      throw;
    }
  }

  void lose(const std::string& reason) {
    if (!lost_)
      recorder_->disconnected(reason, clock_());
    lost_ = true;
  }

  std::unique_ptr<transport::Transport> transport_;
  std::shared_ptr<Recorder> recorder_;
  std::function<double()> clock_;
  transport::QueueWatch queue_;
  bool lost_ = false;
};

}  // namespace

std::unique_ptr<transport::Transport> record(std::unique_ptr<transport::Transport> transport,
                                             std::shared_ptr<Recorder> recorder,
                                             std::function<double()> clock) {
  return std::make_unique<RecordingTransport>(std::move(transport), std::move(recorder),
                                              std::move(clock));
}

}  // namespace wiimote_tracker::recording
