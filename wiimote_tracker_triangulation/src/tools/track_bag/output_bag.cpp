#include "output_bag.h"

#include "wiimote_tracker_triangulation/measurements/part_file.h"

#include <unistd.h>

namespace wiimote_tracker {

OutputBag::OutputBag(const std::string& path) : path_(path), bag_(new rosbag::Bag) {
  measurements::createPart(path_);
  try {
    bag_->open(measurements::partOf(path_), rosbag::bagmode::Write);
  } catch (const rosbag::BagException& e) {
    fail(e.what());
  }
}

OutputBag::~OutputBag() {
  if (!bag_)
    return;
  try {
    bag_->close();
  } catch (const rosbag::BagException&) {
    bag_.release();  // its destructor would try again, and end the program
  }
  ::unlink(measurements::partOf(path_).c_str());
}

void OutputBag::finish() {
  try {
    bag_->close();
  } catch (const rosbag::BagException& e) {
    fail(e.what());
  }
  bag_.reset();
  measurements::finishPart(path_);
}

void OutputBag::fail(const std::string& why) {
  throw BagError("cannot write " + path_ + " (" + why +
                 "): choose another place or make room there");
}

}  // namespace wiimote_tracker
