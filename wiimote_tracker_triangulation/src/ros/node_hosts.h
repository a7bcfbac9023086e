#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_NODE_HOSTS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_NODE_HOSTS_H

#include <wiimote_tracker_msgs/run_node.h>

#include <chrono>
#include <future>
#include <map>
#include <string>

namespace wiimote_tracker {

/// The computers of nodes. The master is asked in another thread, since it may take a second, and
/// longer where its name has to be looked up.
class NodeHosts {
 public:
  /// As the master answered last; empty: it has not yet, or does not know the node. Never waits,
  /// and has the master asked for the next call.
  std::string of(const std::string& node) {
    Host& host = hosts_[node];
    if (host.asked.valid()) {
      if (host.asked.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
        return host.name;
      host.name = host.asked.get();
    }
    host.asked = std::async(std::launch::async, [node] {
      const auto server = serverOf(node);
      return server ? server->first : std::string();
    });
    return host.name;
  }

 private:
  struct Host {
    std::string name;
    std::future<std::string> asked;
  };

  std::map<std::string, Host> hosts_;  // by node
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_NODE_HOSTS_H
