#pragma once

#include <gtest/gtest.h>
#include <ros/ros.h>

#include <map>
#include <string>

namespace wiimote_tracker {

/// Calls a service as soon as there is one, over a connection that stays open: ros::service::call
/// opens one for each call, and on a busy computer roscpp 1.15 loses about one in ten thousand.
template <typename Service>
typename Service::Response callService(const std::string& name,
                                       typename Service::Request request = {}) {
  constexpr double kPatience = 30.0;  // [s] far beyond what starting a node takes
  // By thread, because calls over one connection wait for one another.
  thread_local std::map<std::string, ros::ServiceClient> clients;
  ros::ServiceClient& client = clients[name];
  typename Service::Response response;
  if (!client.isValid()) {
    EXPECT_TRUE(ros::service::waitForService(name, ros::Duration(kPatience))) << name;
    client = ros::NodeHandle().serviceClient<Service>(name, true);
  }
  EXPECT_TRUE(client.call(request, response)) << name;
  return response;
}

}  // namespace wiimote_tracker
