// Clicks through the Tracker panel while a simulated hand carries the LED. Where
// WIIMOTE_TRACKER_SCREENSHOTS names a folder, the pages are drawn into it.

#include "contrast.h"
#include "screenshot.h"
#include "tracker_panel.h"

#include <QApplication>
#include <QCheckBox>
#include <QColor>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFile>
#include <QLabel>
#include <QLineEdit>
#include <QPalette>
#include <QPushButton>
#include <QTabWidget>
#include <QTableWidget>
#include <QTemporaryDir>
#include <QThread>
#include <QTreeWidget>
#include <QWheelEvent>

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>
#include <wiimote_tracker_msgs/LoadRig.h>
#include <wiimote_tracker_msgs/SetLed.h>
#include <wiimote_tracker_triangulation/geometry/rig_file.h>
#include <pluginlib/class_loader.hpp>

#include <chrono>
#include <cstdlib>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <utility>

namespace wiimote_tracker::panel {
namespace {

constexpr auto kDeadline = std::chrono::seconds(90);

/// Lets the panel live until the condition holds. @return false: it did not in time
bool waitFor(const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + kDeadline;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end)
      return false;
    QApplication::processEvents();
    QThread::msleep(5);
  }
  return true;
}

class Panel : public testing::Test {
 protected:
  void SetUp() override {
    widget_ = std::make_unique<TrackerPanel>();
    widget_->resize(440, 740);
    widget_->show();
  }

  template <class Widget>
  Widget* find(const char* name) const {
    return widget_->findChild<Widget*>(name);
  }
  QString label(const char* name) const { return find<QLabel>(name)->text(); }
  QString title() const { return label("title"); }
  void open(int page) { widget_->findChild<QTabWidget*>()->setCurrentIndex(page); }
  bool camerasAre(const QString& summary) const { return label("summary") == summary; }

  /// The new answer that begins so; a refusal, since the LED still moves, is followed by another
  /// try.
  QString answerTo(const char* button_name, const QString& beginning) const {
    auto* button = find<QPushButton>(button_name);
    const QString before = label("answer");
    EXPECT_TRUE(waitFor([&] {
      if (label("answer") != before && label("answer").startsWith(beginning))
        return true;
      if (button->isEnabled())
        button->click();
      return false;
    })) << label("answer").toStdString();
    return label("answer");
  }

  /// Distance that the panel states between the LED, as measured, and a known place [mm].
  double check(double x, double y, double z) const {
    find<QDoubleSpinBox>("x")->setValue(x);
    find<QDoubleSpinBox>("y")->setValue(y);
    find<QDoubleSpinBox>("z")->setValue(z);
    return answerTo("Check the LED there", "measured ").section(' ', 1, 1).toDouble();
  }

  void screenshot(const QString& name) const { panel::screenshot(name, widget_.get()); }

  std::unique_ptr<TrackerPanel> widget_;
};

TEST_F(Panel, CanBeReadOnDarkAndOnLightGround) {
  open(1);
  ASSERT_TRUE(waitFor([this] { return title() == "LED off"; }));
  const QPalette usual = QApplication::palette();
  for (const QColor& ground : {QColor(35, 38, 41), QColor(239, 240, 241)}) {
    QApplication::setPalette(QPalette(ground));
    QApplication::processEvents();
    screenshot(QString("calibrate_on_") + (ground.lightness() < 128 ? "dark" : "light"));
    for (const char* name : {"title", "sentence", "next", "square", "side"}) {
      const auto* part = find<QWidget>(name);
      const QRect area(part->mapTo(widget_.get(), QPoint(0, 0)), part->size());
      EXPECT_GT(contrastOf(widget_->grab(area).toImage()), 4.5) << name;
    }
  }
  QApplication::setPalette(usual);
}

TEST_F(Panel, CalibratesByPressingTheButtonThatItOffers) {
  ASSERT_TRUE(waitFor([this] {
    return camerasAre("4 cameras: 4 not calibrated. Open the page Calibrate.");
  })) << label("summary").toStdString();
  screenshot("cameras_before");
  open(1);
  find<QDoubleSpinBox>("side")->setValue(2.5);
  // A person's hand: presses the button whenever it can be pressed. What is refused, since the LED
  // still moves, is asked for again.
  auto* next = find<QPushButton>("next");
  std::set<QString> titles;
  EXPECT_TRUE(waitFor([&] {
    if (titles.insert(title()).second)
      screenshot("calibrate_" + title().toLower().replace(' ', '_'));
    if (next->isVisible() && next->isEnabled())
      next->click();
    return title() == "Ready";
  })) << title().toStdString()
      << ": " << label("answer").toStdString();
  for (const char* step : {"LED off", "LED on", "Square", "Corner 1", "Corner 2", "Corner 3",
                           "Corner 4", "Wave", "Enough", "Solve"})
    EXPECT_EQ(titles.count(step), 1u) << step;
  // On a topic of their own, so perhaps later than the title.
  EXPECT_TRUE(waitFor([this] { return find<QTableWidget>("table")->rowCount() == 4; }));
  EXPECT_TRUE(waitFor([this] { return !label("verdict").isEmpty(); }));
  screenshot("calibrate_ready");
  find<QDoubleSpinBox>("taped")->setValue(3.5355);
  auto* take = find<QPushButton>("Take length");
  ASSERT_TRUE(waitFor([&] { return take->isEnabled(); }));
  take->click();
  EXPECT_TRUE(waitFor([this] {
    return label("answer").startsWith("corner 1 to corner 3 is 3.5355 m");
  })) << label("answer").toStdString();
  open(0);
  EXPECT_TRUE(waitFor([this] { return camerasAre("4 cameras: 4 fine"); }))
      << label("summary").toStdString();
  screenshot("cameras_after");
  open(2);
  EXPECT_TRUE(waitFor([this] { return find<QTableWidget>("leds")->rowCount() == 1; }))
      << label("tracked").toStdString();
  EXPECT_TRUE(waitFor([this] { return label("tracked").endsWith("points/s"); }))
      << label("tracked").toStdString();
  screenshot("track");
  open(3);
  EXPECT_TRUE(waitFor([this] { return find<QTreeWidget>("health")->topLevelItemCount() > 4; }));
  screenshot("health");
  open(1);
  wiimote_tracker_msgs::SetLed rest;
  rest.request.led = "led";
  rest.request.on = 1;
  rest.request.motion = rest.request.LINE;
  rest.request.target.x = rest.request.target.z = 1.0;
  rest.request.target.y = 1.5;
  ASSERT_TRUE(ros::service::call("simulation/set_led", rest));
  constexpr double kThreeSigma = 30.0;  // of this calibration [mm]
  EXPECT_NEAR(check(1.0, 1.5, 1.2), 200.0, kThreeSigma);
  EXPECT_LT(check(1.0, 1.5, 1.0), kThreeSigma);
  screenshot("calibrate_place");
  answerTo("Take this place", "place 1 at (1.000, 1.500, 1.000) m is captured by 4 cameras");
  EXPECT_TRUE(waitFor([this] { return title() == "Solve"; })) << title().toStdString();
}

/// While the tracker runs.
TEST_F(Panel, RemovesACameraAndAddsItAgain) {
  std_srvs::Trigger drop;  // what the test before captured
  ASSERT_TRUE(ros::service::call("calibration/cancel", drop));
  open(1);
  auto* camera = find<QComboBox>("camera");
  ASSERT_TRUE(waitFor([&] { return camera->count() == 4; }));
  camera->setCurrentIndex(camera->findText("wiimote_4"));
  answerTo("Remove it", "wiimote_4 was removed");
  open(0);
  EXPECT_TRUE(waitFor([this] { return label("summary").endsWith("1 not calibrated, 3 fine"); }))
      << label("summary").toStdString();
  open(1);
  answerTo("Solve or add it", "wiimote_4 was added; it is known to ");
  open(0);
  EXPECT_TRUE(waitFor([this] { return camerasAre("4 cameras: 4 fine"); }))
      << label("summary").toStdString();
}

/// With the rig that the first test has saved.
TEST_F(Panel, CorrectsACameraThatWasMovedAndRevertsThat) {
  std::string rig_file;
  ASSERT_TRUE(ros::param::get("calibration/rig_file", rig_file));
  geometry::Rig rig = geometry::readRigFile(rig_file);
  auto& pose = rig.cameras.at(1).camera.world_from_camera;
  pose.linear() = pose.linear() * Eigen::AngleAxisd(0.0175, Eigen::Vector3d::UnitY());
  wiimote_tracker_msgs::LoadRig moved;
  moved.request.path = rig_file.substr(0, rig_file.rfind('/')) + "/moved.yaml";
  geometry::writeRigFile(rig, moved.request.path);
  std_srvs::Trigger drop;  // what was captured after saving
  ASSERT_TRUE(ros::service::call("calibration/cancel", drop));
  ASSERT_TRUE(ros::service::call("calibration/load", moved) && moved.response.success)
      << moved.response.message;
  open(1);
  ASSERT_TRUE(waitFor([this] { return title() == "Ready"; })) << title().toStdString();
  wiimote_tracker_msgs::SetLed wave;
  wave.request.led = "led";
  wave.request.on = 1;
  wave.request.motion = wave.request.WAVE;
  wave.request.target.x = wave.request.target.y = wave.request.target.z = 1.25;
  wave.request.box.x = wave.request.box.y = wave.request.box.z = 2.0;
  wave.request.speed = 1.0;
  // The hand may still be about to carry the LED in circles, which are in a plane: then once more.
  auto next_wave = std::chrono::steady_clock::now();
  ASSERT_TRUE(waitFor([&] {
    const auto now = std::chrono::steady_clock::now();
    if (now >= next_wave && ros::service::call("simulation/set_led", wave))
      next_wave = now + std::chrono::seconds(20);
    return title() == "Correct wiimote_2";
  })) << title().toStdString();
  screenshot("calibrate_correct");
  find<QPushButton>("next")->click();
  EXPECT_TRUE(waitFor([this] {
    return label("answer").startsWith("in use: wiimote_2 was turned by ");
  })) << label("answer").toStdString();
  screenshot("calibrate_corrected");
  answerTo("Revert", "the rig before the last change is in use again");
}

TEST_F(Panel, NamesTheBagThatItRecords) {
  open(2);
  const QTemporaryDir folder;
  find<QLineEdit>("path")->setText(folder.filePath("take"));
  auto* record = find<QPushButton>("record");
  record->click();
  EXPECT_TRUE(waitFor([&] {
    return label("recording").startsWith("Recording to " + folder.filePath("take_2"));
  })) << label("recording").toStdString();
  record->click();
  EXPECT_TRUE(waitFor([&] { return label("recording").startsWith("Recorded to "); }));
  EXPECT_TRUE(QFile::exists(label("recording").remove("Recorded to ")))
      << label("recording").toStdString();
}

TEST_F(Panel, SaysWhatBecameOfARecordingThatIsStoppedAtOnce) {
  open(2);
  const QTemporaryDir folder;
  find<QLineEdit>("path")->setText(folder.filePath("take"));
  auto* record = find<QPushButton>("record");
  record->click();
  record->click();
  EXPECT_TRUE(waitFor([&] {
    return label("recording") == "Nothing was recorded." ||
           label("recording").startsWith("Recorded to ");
  })) << label("recording").toStdString();
}

TEST_F(Panel, RefusesToRecordWhereNoBagCanBe) {
  open(2);
  const QTemporaryDir folder;
  auto* record = find<QPushButton>("record");
  for (const auto& [path, refusal] :
       {std::pair(folder.filePath("none/take"), "make the folder " + folder.filePath("none")),
        {folder.path() + "/", "end the path with the beginning of the bag's name"},
        {QString(), "end the path with the beginning of the bag's name"}}) {
    find<QLineEdit>("path")->setText(path);
    record->click();
    EXPECT_TRUE(waitFor([&, words = "Nothing is recorded: " + refusal] {
      return label("recording").startsWith(words);
    })) << label("recording").toStdString();
    EXPECT_EQ(record->text(), "Record");
  }
}

TEST_F(Panel, AsksForTheWandOnTheFloor) {
  open(1);
  auto* again = find<QPushButton>("Start again");
  ASSERT_TRUE(waitFor([&] { return again->isEnabled(); }));
  find<QDoubleSpinBox>("wand")->setValue(0.5);
  find<QCheckBox>("without_square")->click();
  again->click();
  EXPECT_TRUE(waitFor([this] { return title() == "Leave it"; }));
  EXPECT_TRUE(waitFor([this] { return title() == "Wave"; })) << "captured where the hand laid it";
  find<QPushButton>("Stop")->click();
  EXPECT_TRUE(waitFor([this] { return title() == "Wand"; })) << title().toStdString();
}

TEST_F(Panel, ShowsLongWordsOfHealthInFull) {
  open(3);
  const auto* tree = find<QTreeWidget>("health");
  ASSERT_TRUE(waitFor(
      [&] { return tree->topLevelItemCount() > 0 && tree->topLevelItem(0)->childCount() > 0; }));
  const auto* value = tree->topLevelItem(0)->child(0);
  for (const int column : {0, 1})
    EXPECT_EQ(value->toolTip(column), value->text(column));
}

TEST_F(Panel, LearnsTheLightsAgain) {
  open(1);
  auto* learn = find<QPushButton>("Learn the lights");
  ASSERT_TRUE(waitFor([&] { return learn->isEnabled(); }));
  learn->click();
  EXPECT_TRUE(waitFor([this] { return title() == "LED off"; })) << title().toStdString();
  find<QPushButton>("Stop")->click();
  EXPECT_TRUE(waitFor([&] { return learn->isEnabled(); })) << title().toStdString();
}

TEST_F(Panel, IsScrolledByTheWheelAndNothingElse) {
  find<QDoubleSpinBox>("side")->setValue(2.5);
  for (const char* name : {"side", "x", "from"}) {
    QWheelEvent down(QPointF(5, 5), QPointF(5, 5), QPoint(), QPoint(0, -120), Qt::NoButton,
                     Qt::NoModifier, Qt::NoScrollPhase, false);
    QApplication::sendEvent(find<QWidget>(name), &down);
  }
  EXPECT_EQ(find<QDoubleSpinBox>("side")->value(), 2.5);
  EXPECT_EQ(find<QDoubleSpinBox>("x")->value(), 0.0);
  EXPECT_EQ(find<QComboBox>("from")->currentIndex(), 0);
}

TEST_F(Panel, SaysWhatUndoDrops) {
  const auto* undo = find<QPushButton>("Undo");
  ASSERT_NE(undo, nullptr);
  for (const char* dropped : {"length", "place", "wave", "corner"})
    EXPECT_GE(undo->toolTip().indexOf(dropped), 0) << dropped;
}

TEST_F(Panel, EndsWhileARequestRuns) {
  open(1);
  auto* connection = find<QPushButton>("Check the LED there");
  ASSERT_TRUE(waitFor([&] { return connection->isEnabled(); }));
  TrackerPanel second;
  second.findChild<QTabWidget*>()->setCurrentIndex(1);
  connection->click();
  widget_.reset();
}

TEST(Plugin, KeepsItsSettingsInTheRvizFile) {
  static pluginlib::ClassLoader<rviz::Panel> loader("rviz", "rviz::Panel");  // outlives the panels
  rviz::Config config;
  {
    const std::unique_ptr<rviz::Panel> panel(
        loader.createUnmanagedInstance("wiimote_tracker/Tracker"));
    panel->findChild<QTabWidget*>()->setCurrentIndex(1);
    panel->findChild<QDoubleSpinBox*>("side")->setValue(3.2);
    panel->save(config);
  }
  const std::unique_ptr<rviz::Panel> panel(
      loader.createUnmanagedInstance("wiimote_tracker/Tracker"));
  panel->load(config);
  EXPECT_EQ(panel->findChild<QTabWidget*>()->currentIndex(), 1);
  EXPECT_NEAR(panel->findChild<QDoubleSpinBox*>("side")->value(), 3.2, 1e-6);
}

}  // namespace
}  // namespace wiimote_tracker::panel

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "panel_test");
  const ros::NodeHandle keeps_ros_running;
  qputenv("QT_QPA_PLATFORM", "offscreen");
  const QApplication application(argc, argv);
  return RUN_ALL_TESTS();
}
