#include "wiimote_tracker_msgs/run_node.h"

#include "wiimote_tracker_msgs/argument_parser.h"
#include "wiimote_tracker_msgs/error.h"

#include <ros/network.h>
#include <xmlrpcpp/XmlRpc.h>

#include <cstdint>
#include <cstdlib>
#include <optional>
#include <utility>
#include <vector>

namespace wiimote_tracker {
namespace {

/// What a master or node answers to a call of its XML-RPC API. Nothing when it refuses, or does not
/// answer within a second; ros::master::execute() would wait for ever for one that hangs.
std::optional<XmlRpc::XmlRpcValue> answerOf(const std::string& host,
                                            std::uint32_t port,
                                            const char* method,
                                            const XmlRpc::XmlRpcValue& request) {
  using XmlRpc::XmlRpcDispatch;
  using XmlRpc::XmlRpcValue;
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
  if (!client.executeNonBlock(method, request))
    return std::nullopt;
  XmlRpcDispatch dispatch;
  dispatch.addSource(&client, XmlRpcDispatch::WritableEvent | XmlRpcDispatch::Exception);
  dispatch.work(1.0);
  // The answer is a status, a sentence and the value.
  XmlRpcValue answer;
  if (!client.executeCheckDone(answer) || answer.getType() != XmlRpcValue::TypeArray ||
      answer.size() != 3 || answer[0].getType() != XmlRpcValue::TypeInt ||
      static_cast<int>(answer[0]) != 1)
    return std::nullopt;
  return answer[2];
}

/// Where the master says that a node answers: host and port. Nothing when it knows no such node, or
/// does not answer within a second.
std::optional<std::pair<std::string, std::uint32_t>> serverOf(const std::string& node) {
  XmlRpc::XmlRpcValue request;
  request[0] = ros::this_node::getName();
  request[1] = node;
  std::string host;
  std::uint32_t port = 0;
  auto uri = answerOf(ros::master::getHost(), ros::master::getPort(), "lookupNode", request);
  if (!uri || uri->getType() != XmlRpc::XmlRpcValue::TypeString ||
      !ros::network::splitURI(*uri, host, port))
    return std::nullopt;
  return std::make_pair(host, port);
}

/// The process of a node that runs, such as "process 4711 on lab"; empty: it does not run, or does
/// not answer within a second. The master alone cannot tell: it remembers those that were killed.
/// @param node its full name
std::string runningProcess(const std::string& node) {
  const auto server = serverOf(node);
  if (!server)
    return "";
  XmlRpc::XmlRpcValue caller;
  caller[0] = node;
  auto process = answerOf(server->first, server->second, "getPid", caller);
  if (!process || process->getType() != XmlRpc::XmlRpcValue::TypeInt)
    return "";
  return "process " + std::to_string(static_cast<int>(*process)) + " on " + server->first;
}

/// Calls node(nh, private_nh) if there is a master. @returns the exit status.
int runWithMaster(const NodeFunction& node) {
  if (!ros::master::check()) {
    ROS_FATAL("There is no ROS master at %s: start roscore, or use roslaunch.",
              ros::master::getURI().c_str());
    return 1;
  }
  const std::string other = runningProcess(ros::this_node::getName());
  if (!other.empty())
    ROS_WARN(
        "%s runs already (%s): it ends, and this one takes its place. If another launch file "
        "starts it again, both replace each other for ever: end one of the launches, or start the "
        "second in a namespace (ROS_NAMESPACE).",
        ros::this_node::getName().c_str(), other.c_str());
  // Lives longer than the catch block: with the last handle ROS shuts down and prints no more.
  const ros::NodeHandle nh;
  try {
    node(nh, ros::NodeHandle("~"));
    return 0;
  } catch (const ParameterError& error) {
    if (staysRefused(error)) {
      const RefusalReport report(nh, ros::this_node::getName(), error);
      spin();
    }
    return 1;
  } catch (const std::exception& e) {
    ROS_FATAL("%s", e.what());
    return 1;
  }
}

/// Without ROS_MASTER_URI the master is sought at rospy's default address.
/// @throws Error if the master's address is none: ros::init() would abort.
void requireMasterUri(int argc, char** argv) {
  ::setenv("ROS_MASTER_URI", "http://localhost:11311", 0);
  std::string uri = std::getenv("ROS_MASTER_URI");
  const std::string remapping = "__master:=";
  for (const std::string& word : std::vector<std::string>(argv, argv + argc)) {
    if (word.rfind(remapping, 0) == 0)
      uri = word.substr(remapping.size());
  }
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(uri, host, port) || host.empty() || port == 0)
    throw Error("ROS_MASTER_URI is " + (uri.empty() ? "empty" : uri) +
                ", but must be such as http://HOST:11311: correct it");
}

}  // namespace

void spin(std::size_t threads) {
  // ROS ends the wait at shutdown. So it may be long: waking up costs as much as a callback.
  const auto handle = [] {
    while (ros::ok())
      logExceptions(ros::this_node::getName(),
                    [] { ros::getGlobalCallbackQueue()->callOne(ros::WallDuration(1.0)); });
  };
  std::vector<std::thread> others;
  while (others.size() + 1 < threads)
    others.emplace_back(handle);
  handle();
  for (std::thread& other : others)
    other.join();
}

int runNode(int argc,
            char** argv,
            const std::string& name,
            const std::string& purpose,
            const NodeFunction& node) {
  std::vector<std::string> words;
  ros::removeROSArgs(argc, argv, words);
  words.erase(words.begin());  // the program's path
  return ArgumentParser(argv[0], purpose).run(words, [&] {
    requireMasterUri(argc, argv);
    // Without a timeout init() waits forever for a master to set parameters of the command line.
    ros::master::setRetryTimeout(ros::WallDuration(1.0));
    ros::init(argc, argv, name);
    ros::master::setRetryTimeout(ros::WallDuration(0.0));
    return runWithMaster(node);
  });
}

}  // namespace wiimote_tracker
