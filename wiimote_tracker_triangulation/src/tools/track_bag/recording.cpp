#include "recording.h"

#include <wiimote_tracker_msgs/IrBlobArray.h>
#include <wiimote_tracker_msgs/RigCalibration.h>
#include <wiimote_tracker_msgs/text.h>
#include <boost/algorithm/string/predicate.hpp>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>

namespace wiimote_tracker {
namespace {

using wiimote_tracker_msgs::IrBlobArray;
using wiimote_tracker_msgs::RigCalibration;

/// A driver needs longer to start again and count its images from 0 [ns].
constexpr std::uint64_t kShortestRestart = 100'000'000;

/// When an image arrived [ns], as the tracker reads it.
std::uint64_t arrivalOf(const IrBlobArray& image) {
  return (image.arrival.isZero() ? image.header.stamp : image.arrival).toNSec();
}

}  // namespace

Recording::Recording(const std::string& path) : path_(path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored))
    throw BagError("there is no file " + path + " that can be read: name a bag");
  try {
    bag_.open(path, rosbag::bagmode::Read);
    view_ = std::make_unique<rosbag::View>(bag_);
    for (const rosbag::MessageInstance& message : *view_)
      messages_.push_back(message);
    sort();
  } catch (const rosbag::BagUnindexedException&) {
    throw BagError(path +
                   " has no index, its recording was cut off: repair it with rosbag reindex");
  } catch (const rosbag::BagException& e) {
    throw BagError(path + " cannot be read as a bag (" + e.what() +
                   "): see what rosbag info says, rosbag reindex may help");
  }
}

/// Gives every other message the earliest arrival time of the images recorded after it.
void Recording::sort() {
  struct Place {
    std::uint64_t arrival;
    bool is_image;
    std::size_t message;
    std::uint64_t frame;
  };
  std::vector<Place> places;
  places.reserve(messages_.size());
  for (std::size_t i = 0; i < messages_.size(); ++i) {
    const auto image = read<IrBlobArray>(messages_[i]);
    if (read<RigCalibration>(messages_[i]) &&
        boost::algorithm::ends_with(messages_[i].getTopic(), "/calibration/rig"))
      rig_topics_.insert(messages_[i].getTopic());
    places.push_back(
        {image ? arrivalOf(*image) : UINT64_MAX, image != nullptr, i, image ? image->frame : 0});
    images_ += image != nullptr;
  }
  std::uint64_t earliest = UINT64_MAX;
  for (auto place = places.rbegin(); place != places.rend(); ++place) {
    if (!place->is_image)
      place->arrival = earliest;
    earliest = std::min(earliest, place->arrival);
  }
  std::stable_sort(places.begin(), places.end(), [&](const Place& a, const Place& b) {
    if (a.arrival != b.arrival)
      return a.arrival < b.arrival;
    if (a.is_image != b.is_image)
      return b.is_image;
    return a.is_image && messages_[a.message].getTopic() < messages_[b.message].getTopic();
  });
  order_.reserve(places.size());
  std::map<std::string, const Place*> last_images;  // by topic
  for (const Place& place : places) {
    order_.push_back(place.message);
    if (!place.is_image)
      continue;
    const std::string& topic = messages_[place.message].getTopic();
    const Place*& last = last_images[topic];
    if (mixed_times_.empty() && last && place.frame < last->frame &&
        place.arrival - last->arrival < kShortestRestart)
      mixed_times_ = format(
          "from %.6f s on, images of two times are mixed on %s, because its clock was set "
          "back, and points are wrong: keep those of one time with rosbag filter",
          1e-9 * static_cast<double>(place.arrival), topic.c_str());
    last = &place;
  }
}

ros::Time Recording::justBefore() const {
  const ros::Time start = messages_.front().getTime();
  return start > ros::TIME_MIN ? start - ros::Duration(0, 1) : start;
}

Topics Recording::topics() const {
  if (rig_topics_.empty())
    return Topics();
  if (rig_topics_.size() > 1)
    throw BagError(path_ + " holds the rigs of several trackers (" + joined(rig_topics_) +
                   "): say whose with --namespace");
  const std::string& topic = *rig_topics_.begin();
  return Topics(topic.substr(0, topic.size() - std::string("calibration/rig").size()));
}

}  // namespace wiimote_tracker
