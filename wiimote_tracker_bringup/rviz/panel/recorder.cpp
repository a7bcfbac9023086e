#include "recorder.h"

#include <QDir>
#include <QFileInfo>

#include <signal.h>

namespace wiimote_tracker::panel {
namespace {

constexpr int kLongestEnd = 5000;  // until the bag is closed [ms]
const char* const kStarts = "The recording starts.";

}  // namespace

Recorder::~Recorder() {
  stop();
  if (isRunning())
    process_.waitForFinished(kLongestEnd);
}

void Recorder::start(const QString& prefix) {
  // The folder where roslaunch was called: nodes run elsewhere.
  prefix_ = QDir(qEnvironmentVariable("PWD")).absoluteFilePath(prefix);
  words_ = refusal(prefix);
  is_wanted_ = words_.isEmpty();
  if (!is_wanted_)
    return;
  words_ = kStarts;
  started_ = QDateTime::currentDateTime();
  process_.setProcessChannelMode(QProcess::ForwardedChannels);
  process_.start("roslaunch", {"wiimote_tracker_bringup", "record.launch", "output:=" + prefix_});
}

void Recorder::stop() {
  is_wanted_ = false;
  asked_.start();
  if (isRunning() && process_.processId() > 0)
    ::kill(static_cast<pid_t>(process_.processId()), SIGINT);  // as Ctrl-C: the bag is closed
}

/// Why bags cannot be written there; empty: they can.
QString Recorder::refusal(const QString& prefix) const {
  const QFileInfo bags(prefix_);
  if (prefix.isEmpty() || bags.fileName().isEmpty())
    return "Nothing is recorded: end the path with the beginning of the bag's name.";
  const QFileInfo folder(bags.path());
  if (!folder.isDir())
    return "Nothing is recorded: make the folder " + folder.filePath() + ", or choose another.";
  if (!folder.isWritable())
    return "Nothing is recorded: you may not write to " + folder.filePath() + "; choose another.";
  return {};
}

QString Recorder::bag() const {
  const QFileInfo prefix(prefix_);
  const QString bags = prefix.fileName() + "_*.bag", written = ".active";
  const QFileInfoList newest_first =
      prefix.dir().entryInfoList({bags, bags + written}, QDir::Files, QDir::Time);
  if (newest_first.empty() || newest_first[0].lastModified() < started_)
    return {};
  return newest_first[0].filePath().remove(written);
}

void Recorder::poll() {
  if (isRunning()) {
    if (!bag().isEmpty())
      words_ = "Recording to " + bag();
    if (!is_wanted_ && asked_.hasExpired(kLongestEnd))
      stop();  // once more: roslaunch does not hear it while it starts
  } else if (is_wanted_) {
    is_wanted_ = false;
    words_ = "The recording has ended by itself: see the terminal in which rviz was started.";
  } else if (words_ == kStarts || words_.startsWith("Recording")) {
    words_ = bag().isEmpty() ? "Nothing was recorded." : "Recorded to " + bag();
  }
}

}  // namespace wiimote_tracker::panel
