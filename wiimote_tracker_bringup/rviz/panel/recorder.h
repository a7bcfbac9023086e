#pragma once

#include <QDateTime>
#include <QElapsedTimer>
#include <QProcess>
#include <QString>

namespace wiimote_tracker::panel {

/// Runs record.launch.
class Recorder {
 public:
  /// Ends the recording.
  ~Recorder();

  /// @param prefix path and prefix of the bag's name
  void start(const QString& prefix);
  void stop();
  bool isRunning() const { return process_.state() != QProcess::NotRunning; }

  /// To be called often: asks roslaunch once more when it does not end, and finds the words.
  void poll();

  /// The bag that it records to, or how it ended.
  const QString& words() const { return words_; }

 private:
  QString refusal(const QString& prefix) const;
  /// Path of the newest bag; empty: there is none yet.
  QString bag() const;

  QProcess process_;
  QString prefix_;  // absolute
  QDateTime started_;
  QString words_;
  bool is_wanted_ = false;
  QElapsedTimer asked_;  // since it was last asked to end
};

}  // namespace wiimote_tracker::panel
