#include "output_bag.h"

#include "error.h"
#include "wiimote_tracker_triangulation/measurements/part_file.h"

#include <unistd.h>

#include <algorithm>

namespace wiimote_tracker {

OutputBag::OutputBag(const std::string& path) : path_(path) {
  measurements::createPart(path_);
  try {
    file_ = std::make_unique<BagFile>(measurements::partOf(path_));
  } catch (const BagError& e) {
    fail(e.what());
  }
}

OutputBag::~OutputBag() {
  if (file_)
    ::unlink(measurements::partOf(path_).c_str());
}

void OutputBag::copy(const std::string& topic,
                     const ros::Time& time,
                     const MessageBytes& message,
                     const boost::shared_ptr<ros::M_string>& header) {
  auto connection = copied_.find(header);
  if (connection == copied_.end())
    connection = copied_.emplace(header, file_->addConnection(topic, *header)).first;
  std::copy(message.begin(), message.end(),
            add(connection->second, time, static_cast<std::uint32_t>(message.size())));
}

void OutputBag::finish() {
  try {
    file_->finish();
  } catch (const BagError& e) {
    fail(e.what());
  }
  file_.reset();
  measurements::finishPart(path_);
}

std::uint8_t* OutputBag::add(std::uint32_t connection, const ros::Time& time, std::uint32_t size) {
  try {
    return file_->add(connection, time, size);
  } catch (const BagError& e) {
    fail(e.what());
  }
}

void OutputBag::fail(const std::string& why) {
  throw BagError("cannot write " + path_ + " (" + why +
                 "): choose another place or make room there");
}

}  // namespace wiimote_tracker
