#pragma once

#include "wiimote_tracker_triangulation/geometry/error.h"

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <cstddef>
#include <deque>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// A bag cannot be read, used or written. what() is one sentence that says what to do.
struct BagError : geometry::Error {
  using Error::Error;
};

/// The recorded message if it is of this type, otherwise null. @throws BagError: another version of
/// the type's definition.
template <typename Message>
boost::shared_ptr<const Message> read(const rosbag::MessageInstance& recorded) {
  if (recorded.getDataType() != ros::message_traits::datatype<Message>())
    return nullptr;
  if (!recorded.isType<Message>())
    throw BagError(recorded.getTopic() + " was recorded with another version of " +
                   recorded.getDataType() + ": convert the bag with rosbag fix");
  return recorded.instantiate<Message>();
}

/// Names of the topics of a tracker that runs in a namespace.
class Topics {
 public:
  /// @param name_space slashes at its ends may be left out.
  explicit Topics(const std::string& name_space = "/") : name_space_(name_space) {
    if (name_space_.empty() || name_space_.front() != '/')
      name_space_ = "/" + name_space_;
    if (name_space_.back() != '/')
      name_space_ += "/";
  }

  /// The topic that the tracker means by a name.
  std::string operator()(const std::string& name) const {
    return name[0] == '/' ? name : name_space_ + name;
  }

 private:
  std::string name_space_;
};

/// The messages of a bag in the order in which a tracker gets them without delays: images by
/// arrival time, then topic; every other message before all images recorded after it. Otherwise the
/// recorded times do not matter, nor does the recorder's clock.
class Recording {
 public:
  /// @throws BagError: no such file, no bag, no index, recorded with other message definitions.
  explicit Recording(const std::string& path);

  std::size_t size() const { return order_.size(); }

  /// The i-th message in that order.
  const rosbag::MessageInstance& operator[](std::size_t i) const { return messages_[order_[i]]; }

  std::size_t images() const { return images_; }
  /// Topics of the trackers whose rigs the bag holds.
  const std::set<std::string>& rigTopics() const { return rig_topics_; }

  /// A sentence if a camera's clock was set back, so that images of two times are mixed; else
  /// empty.
  const std::string& mixedTimes() const { return mixed_times_; }

  /// A time before the first recorded one, if there is one. Needs a message.
  ros::Time justBefore() const;

  /// Topics of the tracker whose rig the bag holds; without a namespace when it holds no rig.
  /// @throws BagError: rigs of several trackers.
  Topics topics() const;

  /// Calls take(message) for each message of this type on a topic.
  template <typename Message, typename Take>
  void forEach(const std::string& topic, const Take& take) const {
    for (const rosbag::MessageInstance& recorded : messages_) {
      const auto message = recorded.getTopic() == topic ? read<Message>(recorded) : nullptr;
      if (message)
        take(*message);
    }
  }

 private:
  void sort();

  std::string path_;
  rosbag::Bag bag_;
  std::unique_ptr<rosbag::View> view_;            // the messages refer to it
  std::deque<rosbag::MessageInstance> messages_;  // as recorded
  std::vector<std::size_t> order_;
  std::size_t images_ = 0;
  std::set<std::string> rig_topics_;
  std::string mixed_times_;
};

}  // namespace wiimote_tracker
