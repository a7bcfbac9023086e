// join_rooms: one rig from those of two rooms that share no view, by recordings of an LED that was
// carried through the door between them.

#include "rooms/join_rooms.h"

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <wiimote_tracker_msgs/TrackedPointArray.h>
#include <wiimote_tracker_msgs/argument_parser.h>
#include <wiimote_tracker_triangulation/geometry/error.h>
#include <wiimote_tracker_triangulation/geometry/rig_file.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace {

using namespace wiimote_tracker;
using wiimote_tracker_msgs::TrackedPoint;
using wiimote_tracker_msgs::TrackedPointArray;

// Without a measurement for longer, a track ends [s].
constexpr double kLongestGap = 0.3;
// A point is measured if it is known to this: not while only one camera sees the LED [m].
constexpr double kMeasured = 0.1;

/// The tracks of one room: of each LED a new one wherever it was not seen.
class RoomTracks {
 public:
  /// @param source what numbers the LEDs
  void add(const std::string& source, const TrackedPointArray& points) {
    for (const TrackedPoint& point : points.points) {
      const auto& covariance = point.position_covariance;
      const double variance = (covariance[0] + covariance[4] + covariance[8]) / 3.0;
      if (point.state != TrackedPoint::TRACKED || !(variance <= kMeasured * kMeasured))
        continue;
      const double time = points.header.stamp.toSec();
      std::vector<rooms::Path>& tracks = of_leds_[{source, point.id}];
      if (tracks.empty() || time - tracks.back().back().time > kLongestGap)
        tracks.emplace_back();
      rooms::Path& track = tracks.back();
      if (track.empty() || time > track.back().time)
        track.push_back({time, {point.position.x, point.position.y, point.position.z}, variance});
    }
  }

  std::vector<rooms::Path> all() const {
    std::vector<rooms::Path> all;
    for (const auto& [led, tracks] : of_leds_)
      all.insert(all.end(), tracks.begin(), tracks.end());
    return all;
  }

 private:
  std::map<std::pair<std::string, std::uint32_t>, std::vector<rooms::Path>> of_leds_;
};

/// Adds the tracks of a bag to the rooms whose rig they were computed with.
void readTracks(const std::string& path, std::map<std::string, RoomTracks>* rooms_by_rig) {
  try {
    rosbag::Bag bag(path);
    rosbag::View view(bag, rosbag::TypeQuery("wiimote_tracker_msgs/TrackedPointArray"));
    for (const rosbag::MessageInstance& message : view) {
      const auto points = message.instantiate<TrackedPointArray>();
      const auto room = points ? rooms_by_rig->find(points->rig_id) : rooms_by_rig->end();
      if (room != rooms_by_rig->end() && message.getTopic().find("triggered") == std::string::npos)
        room->second.add(path + message.getTopic(), *points);
    }
  } catch (const rosbag::BagException& error) {
    throw geometry::Error(path + " cannot be read as a bag (" + error.what() +
                          "): see what rosbag info says");
  }
}

int join(const std::string& first_path,
         const std::string& second_path,
         const std::string& target,
         const std::vector<std::string>& bags,
         const rooms::JoinOptions& options) {
  const geometry::Rig first = geometry::readRigFile(first_path);
  const geometry::Rig second = geometry::readRigFile(second_path);
  std::map<std::string, RoomTracks> tracks = {{first.id(), {}}, {second.id(), {}}};
  for (const std::string& bag : bags)
    readTracks(bag, &tracks);
  for (const auto& [path, id] : {std::pair(first_path, first.id()), {second_path, second.id()}}) {
    if (tracks[id].all().empty())
      throw geometry::Error("the bags hold no points that were computed with " + path + " (rig " +
                            id + "): compute them with track_bag --rig " + path);
  }
  const rooms::JoinedRooms joined =
      rooms::joinRooms(first, second, tracks[first.id()].all(), tracks[second.id()].all(), options);
  geometry::writeRigFile(joined.rig, target);
  std::printf("%s\n", joined.message.c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::string first, second, target;
  std::vector<std::string> bags;
  rooms::JoinOptions options;
  double slope = options.slope * 180.0 / M_PI;
  ArgumentParser parser("join_rooms",
                        "Moves the rig SECOND.yaml into the world of FIRST.yaml and writes both as "
                        "OUT.yaml. BAGs hold the\npoints of both rooms while an LED was carried "
                        "through the door between them several times.");
  parser.positional("FIRST.yaml", &first);
  parser.positional("SECOND.yaml", &second);
  parser.positional("OUT.yaml", &target);
  parser.positional("BAG...", &bags);
  parser.option("--slope DEGREES", &slope, 0.01, 180.0,
                "standard deviation of the angle between both worlds' z axes, about each "
                "horizontal axis; 180: not level");
  parser.option("--slowing SHARE", &options.slowing, 0.0, 0.5,
                "standard deviation of the share by which a walker is slower while the LED is "
                "hidden, in all passages alike; 0: nobody slows down at the door");
  return parser.run(argc, argv, [&] {
    options.slope = slope < 180.0 ? slope * M_PI / 180.0 : std::numeric_limits<double>::infinity();
    return join(first, second, target, bags, options);
  });
}
