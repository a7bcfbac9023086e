#include "image_arrivals.h"

#include <ros/this_node.h>
#include <boost/make_shared.hpp>

#include <cstddef>
#include <utility>

namespace wiimote_tracker {
namespace {

using wiimote_tracker_msgs::IrBlobArray;

// As many may wait: some seconds of eight cameras.
constexpr std::size_t kMostWaiting = 4000;

class Task : public ros::CallbackInterface {
 public:
  explicit Task(std::function<void()> task) : task_(std::move(task)) {}

  CallResult call() override {
    task_();
    return Success;
  }

 private:
  std::function<void()> task_;
};

/// Whether it came from a thread of this process that just published it.
template <typename Event>
bool isOfThisProcess(const Event& event) {
  const ros::M_string& header = event.getConnectionHeader();
  const auto node = header.find("callerid");
  const auto latching = header.find("latching");
  return node != header.end() && node->second == ros::this_node::getName() &&
         (latching == header.end() || latching->second != "1");
}

}  // namespace

ImageArrivals::ImageArrivals(const ros::NodeHandle& nh,
                             std::function<void(const ArrivedImage&)> handle,
                             std::function<void()> task)
    : nh_(nh),
      inbox_(std::move(handle), kMostWaiting),
      task_(boost::make_shared<Task>([this, task] { alone(task); })) {}

ImageArrivals::~ImageArrivals() {
  subscribers_.clear();  // waits for images that are being delivered
  nh_.getCallbackQueue()->removeByID(id());
}

void ImageArrivals::subscribe(const std::vector<std::string>& cameras) {
  std::map<std::string, ros::Subscriber> subscribers;
  for (const std::string& camera : cameras) {
    const auto old = subscribers_.find(camera);
    if (old != subscribers_.end()) {
      subscribers.insert(*old);
      continue;
    }
    ros::SubscribeOptions options;
    options.initByFullCallbackType<const Event&>(
        camera + "/ir_blobs", 100, [this, camera](const Event& event) { onImage(camera, event); });
    options.callback_queue = &at_once_;
    options.transport_hints = ros::TransportHints().tcpNoDelay();
    subscribers[camera] = nh_.subscribe(options);
  }
  subscribers_ = std::move(subscribers);
}

void ImageArrivals::onImage(const std::string& camera, const Event& event) {
  inbox_.put({camera, event.getConstMessage(), event.getPublisherName()});
  if (isOfThisProcess(event))
    inbox_.handle();
  else
    askForTask();
}

void ImageArrivals::askForTask() {
  nh_.getCallbackQueue()->addCallback(task_, id());
}

std::uint64_t ImageArrivals::id() const {
  return reinterpret_cast<std::uint64_t>(this);
}

}  // namespace wiimote_tracker
