#include "geometry/output_file.h"
#include "ros/measurements/writer.h"

#include <map>
#include <sstream>

namespace wiimote_tracker::measurements {
namespace {

using wiimote_tracker_msgs::TrackedBody;

class TumWriter : public Writer {
 public:
  explicit TumWriter(const std::string& folder) : folder_(folder) {}

  void addBodies(const wiimote_tracker_msgs::TrackedBodyArray& bodies) override {
    for (const TrackedBody& body : bodies.bodies) {
      if (body.state != TrackedBody::TRACKED)
        continue;
      std::ostringstream line = plainText(9);
      line << secondsOf(bodies.header.stamp);
      const geometry_msgs::Point& p = body.pose.pose.position;
      const geometry_msgs::Quaternion& q = body.pose.pose.orientation;
      for (const double value : {p.x, p.y, p.z, q.x, q.y, q.z, q.w})
        line << ' ' << value;
      line << '\n';
      OutputFile*& file = files_[body.name];
      if (!file)
        file = open(tumPath(folder_, body.name));
      file->write(line.str());
    }
  }

  std::string finish() override {
    Writer::finish();
    if (!files_.empty())
      return "";
    return folder_ +
           ": no files, since no body was tracked: check that the tracker has a file of bodies, "
           "that the LEDs' places in it are right, and that the cameras saw the bodies";
  }

 private:
  std::string folder_;
  std::map<std::string, OutputFile*> files_;  // by body
};

}  // namespace

std::string tumPath(const std::string& folder, const std::string& body) {
  return folder + "/" + body + ".tum";
}

std::unique_ptr<Writer> makeTumWriter(const std::string& folder) {
  return std::make_unique<TumWriter>(folder);
}

}  // namespace wiimote_tracker::measurements
