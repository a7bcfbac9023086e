// What the diagnostics say of a body.
#include "ros/bodies/body_diagnostics.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/ros.h>

#include <string>

namespace wiimote_tracker {
namespace {

using wiimote_tracker_msgs::TrackedBody;
using wiimote_tracker_msgs::TrackedBodyArray;

/// The message of the next report on this body; empty when none comes.
std::string nextReport(const std::string& body, BodyDiagnostics* diagnostics) {
  std::string message;
  ros::NodeHandle nh;
  const ros::Subscriber subscriber = nh.subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", 10, [&](const diagnostic_msgs::DiagnosticArrayConstPtr& array) {
        for (const diagnostic_msgs::DiagnosticStatus& status : array->status) {
          if (status.name.find("body " + body) != std::string::npos)
            message = status.message;
        }
      });
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(20.0);
  while (message.empty() && ros::WallTime::now() < deadline) {
    if (subscriber.getNumPublishers() > 0)
      diagnostics->update();
    ros::spinOnce();
    ros::WallDuration(0.02).sleep();
  }
  return message;
}

TEST(BodyDiagnostics, ForgetWhenABodyWasSeenWhereTimeJumpsBack) {
  BodyDiagnostics diagnostics(ros::NodeHandle(), ros::NodeHandle("~"));
  diagnostics.setBodies({{"wand", {{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}, {0.0, 0.2, 0.0}}}});
  TrackedBodyArray bodies;
  bodies.header.stamp = ros::Time::now() + ros::Duration(35.0);
  bodies.bodies.resize(1);
  bodies.bodies[0].name = "wand";
  bodies.bodies[0].state = TrackedBody::TRACKED;
  bodies.bodies[0].last_observed = bodies.header.stamp;
  diagnostics.addBodies(bodies);
  ASSERT_EQ("tracked", nextReport("wand", &diagnostics));
  bodies.bodies[0].state = TrackedBody::LOST;  // its last place, of the time before
  bodies.header.stamp -= ros::Duration(35.0);
  diagnostics.addBodies(bodies);
  EXPECT_EQ("not seen yet", nextReport("wand", &diagnostics));

  bodies.bodies[0].last_observed = bodies.header.stamp;
  diagnostics.addBodies(bodies);
  EXPECT_EQ(0u, nextReport("wand", &diagnostics).find("not seen for "));
}

TEST(BodyDiagnostics, DistinguishAHiddenBodyFromMissingImages) {
  BodyDiagnostics diagnostics(ros::NodeHandle(), ros::NodeHandle("~"));
  diagnostics.setBodies({{"wand", {{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}, {0.0, 0.2, 0.0}}}});
  TrackedBodyArray bodies;
  bodies.header.stamp = ros::Time::now();
  bodies.bodies.resize(1);
  bodies.bodies[0].name = "wand";
  bodies.bodies[0].state = TrackedBody::LOST;
  bodies.bodies[0].last_observed = bodies.header.stamp;
  diagnostics.addBodies(bodies);
  const std::string hidden = nextReport("wand", &diagnostics);
  EXPECT_NE(std::string::npos, hidden.find("uncover it")) << hidden;
  EXPECT_EQ("no images come, its topics are silent: see what is said of triangulation",
            nextReport("wand", &diagnostics));
}

/// The last test: time stays simulated.
TEST(BodyDiagnostics, AreReportedAlsoWhenTimeStandsStillOrJumpsBack) {
  ros::Time::setNow(ros::Time(1000.0));
  BodyDiagnostics diagnostics(ros::NodeHandle(), ros::NodeHandle("~"));
  diagnostics.setBodies({{"wand", {{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}, {0.0, 0.2, 0.0}}}});
  EXPECT_EQ("not seen yet", nextReport("wand", &diagnostics));
  ros::Time::setNow(ros::Time(10.0));
  EXPECT_EQ("not seen yet", nextReport("wand", &diagnostics));
}

}  // namespace
}  // namespace wiimote_tracker
