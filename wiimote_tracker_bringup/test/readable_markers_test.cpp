// The texts and balls of rviz's display Markers, in the pixels that rviz draws, and the numbers of
// its display Coverage.

#include "contrast.h"

#include <QApplication>
#include <QCursor>
#include <QFontMetrics>
#include <QImage>
#include <QTemporaryDir>
#include <QThread>
#include <QToolTip>

#include <OgreRenderWindow.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <rviz/display.h>
#include <rviz/properties/property.h>
#include <rviz/render_panel.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <rviz/visualization_manager.h>
#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace wiimote_tracker::panel {
namespace {

constexpr auto kDeadline = std::chrono::seconds(30);

/// Where pixels differ from the first one.
QRect drawnIn(const QImage& image) {
  QRect area;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      if (image.pixel(x, y) != image.pixel(0, 0))
        area |= QRect(x, y, 1, 1);
    }
  }
  return area;
}

/// Part of the picture: one half of its width, the middle of its height.
QImage half(const QImage& image, int number) {
  const int width = image.width() / 2;
  return image.copy(number * width, image.height() / 4, width, image.height() / 2);
}

/// A view along -x from (5, 0, 0) with two texts of one colour at the height of its middle: the
/// left one 5 m away, the right one 20 m.
class View {
 public:
  View() : manager_(&panel_) {
    panel_.resize(600, 400);
    panel_.show();
    panel_.initialize(manager_.getSceneManager(), &manager_);
    manager_.initialize();
    manager_.setFixedFrame("world");
    manager_.startUpdate();
    rviz::Property* view = manager_.getViewManager()->getCurrent();
    view->subProp("Distance")->setValue(5.0);
    view->subProp("Yaw")->setValue(0.0);
    view->subProp("Pitch")->setValue(0.0);
    manager_.createDisplay("wiimote_tracker/Markers", "texts", true)
        ->subProp("Marker Topic")
        ->setValue("texts");
  }

  void setGround(float brightness) {
    panel_.setBackgroundColor(Ogre::ColourValue(brightness, brightness, brightness));
  }

  /// Shows two cells behind each other in the middle of the view.
  void showCells() {
    manager_.createDisplay("wiimote_tracker/Coverage", "cells", true)
        ->subProp("Topic")
        ->setValue("cells");
    cells_publisher_.publish(cells());
  }

  /// Moves the cursor there from the middle of the view [px] and waits until the words stand there.
  bool says(const QPoint& place, const QString& words) {
    QCursor::setPos(panel_.mapToGlobal(panel_.rect().center() + place));
    const auto end = std::chrono::steady_clock::now() + kDeadline;
    while (QToolTip::text() != words || QToolTip::isVisible() == words.isEmpty()) {
      if (std::chrono::steady_clock::now() > end)
        return false;
      QApplication::processEvents();
      QThread::msleep(10);
    }
    return true;
  }

  /// The picture of texts that were not there before.
  QImage show(float brightness) { return show(texts(brightness)); }

  /// The same of texts that are both at the place of the left one.
  QImage showTogether() {
    visualization_msgs::MarkerArray array = texts(1.0f);
    array.markers[1].pose = array.markers[0].pose;
    return show(array, true);
  }

  /// The same of two balls with a diameter of 1 cm.
  QImage showBalls() {
    visualization_msgs::MarkerArray balls = texts(1.0f);
    balls.markers.resize(2);
    for (visualization_msgs::Marker& ball : balls.markers) {
      ball.type = visualization_msgs::Marker::SPHERE;
      ball.scale.x = ball.scale.y = ball.scale.z = 0.01;
    }
    return show(balls);
  }

 private:
  /// @param only_left nothing is in the right half
  QImage show(const visualization_msgs::MarkerArray& markers, bool only_left = false) {
    visualization_msgs::MarkerArray clear;
    clear.markers.resize(1);
    clear.markers[0].action = visualization_msgs::Marker::DELETEALL;
    publisher_.publish(clear);
    pictureWhen([](const QImage& image) {
      return drawnIn(half(image, 0)).isNull() && drawnIn(half(image, 1)).isNull();
    });
    publisher_.publish(markers);
    return pictureWhen([only_left](const QImage& image) {
      return !drawnIn(half(image, 0)).isNull() && drawnIn(half(image, 1)).isNull() == only_left;
    });
  }

  static visualization_msgs::MarkerArray texts(float brightness) {
    visualization_msgs::Marker text;
    text.header.frame_id = "world";
    text.type = visualization_msgs::Marker::TEXT_VIEW_FACING;
    text.text = "HH";
    text.pose.orientation.w = 1.0;
    text.pose.position.y = -1.0;
    text.scale.x = text.scale.y = text.scale.z = 0.18;
    text.color.r = text.color.g = text.color.b = brightness;
    text.color.a = 1.0f;
    visualization_msgs::MarkerArray array;
    array.markers.assign(3, text);
    array.markers[1].id = 1;
    array.markers[1].pose.position.x = -15.0;
    array.markers[1].pose.position.y = 4.0;
    // rviz draws no text where there is nothing else: a cube above.
    array.markers[2].id = 2;
    array.markers[2].type = visualization_msgs::Marker::CUBE;
    array.markers[2].pose.position.y = 0.0;
    array.markers[2].pose.position.z = 1.7;
    return array;
  }

  static sensor_msgs::PointCloud2 cells() {
    using sensor_msgs::PointField;
    sensor_msgs::PointCloud2 cloud;
    cloud.header.frame_id = "world";
    sensor_msgs::PointCloud2Modifier modifier(cloud);
    modifier.setPointCloud2Fields(5, "x", 1, PointField::FLOAT32, "y", 1, PointField::FLOAT32, "z",
                                  1, PointField::FLOAT32, "cameras", 1, PointField::FLOAT32,
                                  "stddev", 1, PointField::FLOAT32);
    modifier.resize(2);
    const std::vector<float> numbers = {-1.0f, 0.0f, 0.0f, 2.0f, 0.031f,  //
                                        0.0f,  0.0f, 0.0f, 4.0f, 0.012f};
    std::copy(numbers.begin(), numbers.end(),
              &*sensor_msgs::PointCloud2Iterator<float>(cloud, "x"));
    return cloud;
  }

  QImage pictureWhen(const std::function<bool(const QImage&)>& condition) {
    const QString file = folder_.filePath("view.png");
    QImage image;
    const auto end = std::chrono::steady_clock::now() + kDeadline;
    do {
      QApplication::processEvents();
      QThread::msleep(10);
      panel_.getRenderWindow()->writeContentsToFile(file.toStdString());
      image.load(file);
    } while (!condition(image) && std::chrono::steady_clock::now() < end);
    return image;
  }

  const QTemporaryDir folder_;
  ros::NodeHandle node_;
  ros::Publisher publisher_ = node_.advertise<visualization_msgs::MarkerArray>("texts", 1, true);
  ros::Publisher cells_publisher_ = node_.advertise<sensor_msgs::PointCloud2>("cells", 1, true);
  rviz::RenderPanel panel_;
  rviz::VisualizationManager manager_;
};

/// A process can have only one.
class Texts : public testing::Test {
 protected:
  static void SetUpTestSuite() { view_ = std::make_unique<View>(); }
  static void TearDownTestSuite() { view_.reset(); }

  static std::unique_ptr<View> view_;
};

std::unique_ptr<View> Texts::view_;

TEST_F(Texts, AreAsHighAsTheWindowsFarAndNearAboveWhatTheyName) {
  const QImage image = view_->show(1.0f);
  const int line = QFontMetrics(QApplication::font()).height();
  const QRect near = drawnIn(half(image, 0)), far = drawnIn(half(image, 1));
  EXPECT_NEAR(near.height(), far.height(), 2);
  for (const QRect& text : {near, far}) {
    EXPECT_GT(text.height(), 0.5 * line);
    EXPECT_LT(text.height(), 1.1 * line);
    EXPECT_LE(text.bottom(), image.height() / 4);
  }
}

TEST_F(Texts, DoNotCoverEachOther) {
  const QRect both = drawnIn(half(view_->showTogether(), 0));
  const int line = QFontMetrics(QApplication::font()).height();
  EXPECT_GT(both.height(), 1.5 * line);
  EXPECT_LT(both.height(), 2.1 * line);
}

TEST_F(Texts, BallsFarAndNearAreSeenBesideThem) {
  const int line = QFontMetrics(QApplication::font()).height();
  const QImage image = view_->showBalls();
  for (int number : {0, 1}) {
    const int height = drawnIn(half(image, number)).height();
    EXPECT_GT(height, 0.5 * line) << number;
    EXPECT_LT(height, line) << number;
  }
}

TEST_F(Texts, CanBeReadOnDarkAndOnLightGround) {
  for (const float ground : {0.1f, 0.9f}) {
    view_->setGround(ground);
    for (const float brightness : {0.25f, 1.0f})
      EXPECT_GT(contrastOf(half(view_->show(brightness), 0)), 4.5)
          << brightness << " on " << ground;
  }
}

TEST_F(Texts, TheForemostCellUnderTheCursorShowsItsNumbers) {
  view_->showCells();
  EXPECT_TRUE(view_->says({0, 0}, "4 cameras, 12 mm")) << QToolTip::text().toStdString();
  EXPECT_TRUE(view_->says({100, 0}, "")) << QToolTip::text().toStdString();
}

}  // namespace
}  // namespace wiimote_tracker::panel

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "readable_markers_test");
  const ros::NodeHandle keeps_ros_running;
  const QApplication application(argc, argv);
  return RUN_ALL_TESTS();
}
