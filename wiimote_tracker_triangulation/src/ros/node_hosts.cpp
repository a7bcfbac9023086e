#include "node_hosts.h"

#include <wiimote_tracker_msgs/run_node.h>

#include <chrono>

namespace wiimote_tracker {

std::string NodeHosts::of(const std::string& node) {
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

}  // namespace wiimote_tracker
