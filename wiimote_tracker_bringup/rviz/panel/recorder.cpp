#include "recorder.h"

#include <signal.h>

namespace wiimote_tracker::panel {
namespace {

constexpr int kLongestEnd = 5000;  // until the bag is closed [ms]

}  // namespace

Recorder::~Recorder() {
  stop();
  if (isRunning())
    process_.waitForFinished(kLongestEnd);
}

void Recorder::start(const QString& prefix) {
  is_wanted_ = true;
  words_ = "Recording to " + prefix + "_DATE.bag";
  process_.setProcessChannelMode(QProcess::ForwardedChannels);
  process_.start("roslaunch", {"wiimote_tracker_bringup", "record.launch", "output:=" + prefix});
}

void Recorder::stop() {
  is_wanted_ = false;
  if (isRunning() && process_.processId() > 0)
    ::kill(static_cast<pid_t>(process_.processId()), SIGINT);  // as Ctrl-C: the bag is closed
}

QString Recorder::words() {
  if (is_wanted_ && !isRunning()) {
    is_wanted_ = false;
    words_ = "The recording has ended by itself: see the terminal in which rviz was started.";
  } else if (!is_wanted_ && words_.startsWith("Recording")) {
    words_.replace("Recording", "Recorded");
  }
  return words_;
}

}  // namespace wiimote_tracker::panel
