#include "triangulation.h"

#include <nodelet/nodelet.h>
#include <wiimote_tracker_msgs/parameter_reader.h>
#include <pluginlib/class_list_macros.hpp>

#include <memory>

namespace wiimote_tracker {

class TriangulationNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    try {
      // These handles call back from one thread at a time.
      triangulation_ = std::make_unique<Triangulation>(getNodeHandle(), getPrivateNodeHandle());
    } catch (const ParameterError& e) {
      NODELET_FATAL("%s", e.what());
      throw;  // the manager reports that it could not load
    }
  }

  std::unique_ptr<Triangulation> triangulation_;
};

}  // namespace wiimote_tracker

PLUGINLIB_EXPORT_CLASS(wiimote_tracker::TriangulationNodelet, nodelet::Nodelet)
