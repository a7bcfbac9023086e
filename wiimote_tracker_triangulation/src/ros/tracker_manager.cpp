#include <nodelet/loader.h>
#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_msgs/run_node.h>

/// A nodelet manager that loads the nodelet `triangulation` itself. A process that loads it from
/// outside notices by a bond when the manager ends, but bonds also break when it pauses for 4 s.
int main(int argc, char** argv) {
  return wiimote_tracker::runNode(
      argc, argv, "manager",
      "A nodelet manager that loads the nodelet triangulation itself, which tracks LEDs in space.\n"
      "Parameters of triangulation, with units, ranges and defaults:\n"
      "  less $(rospack find wiimote_tracker_triangulation)/config/triangulation.yaml",
      [](const auto& nh, const auto&) {
        nodelet::Loader loader;
        if (!loader.load(nh.resolveName("triangulation"),
                         "wiimote_tracker_triangulation/Triangulation", {}, {}))
          throw wiimote_tracker::Error("The tracker could not be loaded, see above.");
        wiimote_tracker::spin();
      });
}
