// Pages and tiles of the Tracker panel without nodes.

#include "boxes.h"
#include "calibrate_page.h"
#include "camera_tile.h"
#include "health_page.h"
#include "screenshot.h"
#include "track_page.h"

#include <QApplication>
#include <QComboBox>
#include <QElapsedTimer>
#include <QFile>
#include <QKeyEvent>
#include <QLabel>
#include <QLineEdit>
#include <QLocale>
#include <QPushButton>
#include <QStringList>
#include <QTemporaryDir>
#include <QThread>
#include <QTreeWidget>

#include <gtest/gtest.h>

#include <functional>
#include <string>

namespace wiimote_tracker::panel {
namespace {

const char kLongHealth[] =
    "drifted: its images are 20.3 px (+- 0.3 px) on average off what the other cameras see; "
    "wiimote_2 was turned by 1.0 degrees and moved by 2 mm, and its images then fit to 0.3 px; "
    "apply (A in calibrate) uses that";

TEST(CalibratePage, HidesTheRemarksOfANodeThatIsGone) {
  CalibratePage page(nullptr, [](const Request&) {});
  Guide guide;
  wiimote_tracker_msgs::CalibrationStatus status;
  status.missing = {"put the LED on corner 1"};
  guide.onStatus(status, 0.0);
  page.show(guide, 0.1);
  EXPECT_FALSE(page.findChild<QLabel*>("remarks")->isHidden());
  page.show(guide, 100.0);
  EXPECT_TRUE(page.findChild<QLabel*>("remarks")->isHidden());
}

TEST(CalibratePage, AppliesAndRevertsWhatContinuousCalibrationProposes) {
  std::string sent;
  CalibratePage page(nullptr, [&](const Request& request) { sent = request.name; });
  page.resize(440, 740);
  Guide guide;
  wiimote_tracker_msgs::CalibrationStatus status;
  status.step = status.SAVED;
  status.rig_id = "f00";
  status.next_title = "Correct wiimote_2";
  status.next_sentence = "Cameras have changed, most of all wiimote_2. How is known.";
  status.next_request = "continuous/apply";
  status.next_label = "correct it";
  status.cameras.resize(1);
  status.cameras[0].name = "wiimote_2";
  status.cameras[0].health = kLongHealth;
  guide.onStatus(status, 0.0);
  page.show(guide, 0.1);
  screenshot("calibrate_proposal", &page);
  auto* next = page.findChild<QPushButton*>("next");
  EXPECT_EQ(next->text().toStdString(), "Correct it");
  next->click();
  EXPECT_EQ(sent, "continuous/apply");
  page.findChild<QPushButton*>("Revert")->click();
  EXPECT_EQ(sent, "continuous/revert");
}

TEST(CalibratePage, OffersCamerasToSolveAddAndRemove) {
  std::string sent;
  CalibratePage page(nullptr, [&](const Request& request) { sent = request.name; });
  Guide guide;
  wiimote_tracker_msgs::CalibrationStatus status;
  status.step = status.SAVED;
  status.rig_id = "f00";
  status.cameras.resize(1);
  status.cameras[0].name = "new";
  wiimote_tracker_msgs::CalibrationVerdict verdict;
  verdict.rig_id = status.rig_id;
  verdict.cameras.resize(1);
  verdict.cameras[0].name = "gone";
  guide.onStatus(status, 0.0);
  guide.onVerdict(verdict);
  page.show(guide, 0.1);
  auto* cameras = page.findChild<QComboBox*>("camera");
  cameras->setCurrentIndex(cameras->findText("gone"));
  page.findChild<QPushButton*>("Remove it")->click();
  EXPECT_EQ(sent, "remove_camera");
  // Of another rig: what was chosen does not become another camera.
  status.rig_id = "f01";
  guide.onStatus(status, 0.2);
  page.show(guide, 0.3);
  EXPECT_EQ(cameras->currentText().toStdString(), "gone");
  cameras->setCurrentIndex(cameras->findText("new"));
  page.show(guide, 0.4);
  EXPECT_EQ(cameras->findText("gone"), -1);
  page.findChild<QPushButton*>("Solve or add it")->click();
  EXPECT_EQ(sent, "recalibrate_camera");
}

TEST(CalibratePage, ItsButtonWaitsWhenAProposalChangesIt) {
  std::string sent;
  CalibratePage page(nullptr, [&](const Request& request) { sent = request.name; });
  Guide guide;
  wiimote_tracker_msgs::CalibrationStatus status;
  status.step = status.SOLVED;
  status.next_label = "do it";
  auto* next = page.findChild<QPushButton*>("next");
  double now = 0.0;
  status.next_request = "save";
  guide.onStatus(status, now);
  page.show(guide, now);
  EXPECT_TRUE(next->isEnabled());
  for (const char* request : {"continuous/apply", "save"}) {
    status.next_request = request;
    guide.onStatus(status, now += 1.0);
    page.show(guide, now);
    next->click();
    EXPECT_EQ(sent, "") << request;
    page.show(guide, now + 0.6);
    next->click();
    EXPECT_EQ(sent, request);
    sent.clear();
  }
}

TEST(CameraTile, KeepsLongWordsToThreeLinesAndItsTooltipHasAll) {
  CameraTile tile(nullptr);
  tile.resize(200, 190);
  static_cast<QWidget&>(tile).show();
  CameraView camera("wiimote_2", 0.0);
  camera.battery = 0.75;
  tile.show(camera, CameraState::kKnocked, "turned", 0.0);
  EXPECT_EQ(tile.shownWords().toStdString(), "turned");
  tile.show(camera, CameraState::kKnocked, kLongHealth, 0.0);
  const QStringList lines = tile.shownWords().split('\n');
  EXPECT_EQ(lines.size(), 3);
  EXPECT_TRUE(lines.last().endsWith(QChar(0x2026))) << lines.last().toStdString();
  EXPECT_EQ(tile.toolTip().toStdString(), std::string(kLongHealth) + "\nbattery: 75 %");
  screenshot("tile_with_long_words", &tile);
}

/// Polls the page, without showing it, until the condition holds. @return false: not in time
bool pollUntil(TrackPage* page, const std::function<bool()>& condition) {
  QElapsedTimer since;
  since.start();
  while (!condition()) {
    if (since.hasExpired(60000))
      return false;
    page->poll();
    QApplication::processEvents();
    QThread::msleep(5);
  }
  return true;
}

TEST(TrackPage, EndsARecordingThatDoesNotHearItAtOnceBehindAnotherPage) {
  const QTemporaryDir folder;
  const QString began = folder.filePath("began"), ended = folder.filePath("ended");
  // Like roslaunch while it starts, it hears only the second signal.
  QFile program(folder.filePath("roslaunch"));
  ASSERT_TRUE(program.open(QIODevice::WriteOnly));
  program.write(
      QString("#!/usr/bin/env python3\n"
              "import pathlib, signal, time\n"
              "def end(*_):\n"
              "    pathlib.Path('%2').touch()\n"
              "    raise SystemExit\n"
              "signal.signal(signal.SIGINT, lambda *_: signal.signal(signal.SIGINT, end))\n"
              "pathlib.Path('%1').touch()\n"
              "while True:\n"
              "    time.sleep(0.1)\n")
          .arg(began, ended)
          .toUtf8());
  program.close();
  program.setPermissions(QFile::ReadOwner | QFile::ExeOwner);
  const QByteArray path = qgetenv("PATH");
  qputenv("PATH", folder.path().toUtf8() + ":" + path);
  TrackPage page(nullptr);
  page.findChild<QLineEdit*>("path")->setText(folder.filePath("take"));
  auto* record = page.findChild<QPushButton*>("record");
  record->click();
  qputenv("PATH", path);
  ASSERT_TRUE(pollUntil(&page, [&] { return QFile::exists(began); }));
  record->click();
  EXPECT_TRUE(pollUntil(&page, [&] { return QFile::exists(ended); }));
}

TEST(HealthPage, WrapsLongWords) {
  HealthPage page(nullptr);
  page.resize(440, 300);
  static_cast<QWidget&>(page).show();
  diagnostic_msgs::DiagnosticArray diagnostics;
  diagnostics.status.resize(1);
  diagnostics.status[0].name = "calibration: cameras";
  diagnostics.status[0].message = kLongHealth;
  HealthView health;
  health.onDiagnostics(diagnostics, 1.0);
  page.show(health, 1.0);
  screenshot("health_with_long_words", &page);
  const auto* tree = page.findChild<QTreeWidget*>("health");
  EXPECT_GT(tree->visualItemRect(tree->topLevelItem(0)).height(), 3 * tree->fontMetrics().height());
}

TEST(NumberBox, TakesAPointAndACommaInEveryLanguage) {
  for (const QLocale::Language language : {QLocale::English, QLocale::German}) {
    QLocale::setDefault(QLocale(language));
    for (const char* typed : {"2.5", "2,5"}) {
      NumberBox box(nullptr);
      box.setRange(0.0, 100.0);
      box.setDecimals(3);
      box.setSuffix(" m");
      box.selectAll();
      for (const QChar letter : QString(typed)) {
        QKeyEvent press(QEvent::KeyPress, 0, Qt::NoModifier, letter);
        QApplication::sendEvent(&box, &press);
      }
      EXPECT_EQ(box.value(), 2.5) << box.text().toStdString();
    }
  }
  QLocale::setDefault(QLocale::c());
}

}  // namespace
}  // namespace wiimote_tracker::panel
