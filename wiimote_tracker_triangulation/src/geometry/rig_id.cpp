// The id of a rig: FNV-1a (64 bit, http://www.isthe.com/chongo/tech/comp/fnv) over the IEEE 754
// bits of its numbers, most significant byte first.
#include "geometry/rotation.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <wiimote_tracker_msgs/text.h>

#include <cmath>
#include <cstring>
#include <limits>

namespace wiimote_tracker::geometry {
namespace {

class Hash {
 public:
  void add(std::uint64_t value) {
    for (int shift = 56; shift >= 0; shift -= 8)
      addByte(static_cast<unsigned char>(value >> shift));
  }

  void add(double value) {
    // 0 and -0 hash alike, and so do all NaNs.
    if (value == 0.0)
      value = 0.0;
    else if (std::isnan(value))
      value = std::numeric_limits<double>::quiet_NaN();
    std::uint64_t bits;
    static_assert(sizeof bits == sizeof value, "a double must have 64 bits");
    std::memcpy(&bits, &value, sizeof bits);
    add(bits);
  }

  void add(const std::string& text) {
    add(static_cast<std::uint64_t>(text.size()));  // "ab", "c" is not "a", "bc"
    for (const char c : text)
      addByte(static_cast<unsigned char>(c));
  }

  std::string text() const { return format("%016llx", static_cast<unsigned long long>(state_)); }

 private:
  void addByte(unsigned char byte) { state_ = (state_ ^ byte) * 1099511628211ULL; }

  std::uint64_t state_ = 14695981039346656037ULL;
};

void addIntrinsics(const Intrinsics& intrinsics, Hash* hash) {
  hash->add(static_cast<std::uint64_t>(intrinsics.width));
  hash->add(static_cast<std::uint64_t>(intrinsics.height));
  hash->add(intrinsics.fx);
  hash->add(intrinsics.fy);
  hash->add(intrinsics.cx);
  hash->add(intrinsics.cy);
  for (const double k : intrinsics.distortion)
    hash->add(k);
  // Only other models: the ids of older rigs, which had no choice, stay valid.
  if (intrinsics.distortion_model != DistortionModel::kPlumbBob)
    hash->add(std::string(nameOf(intrinsics.distortion_model)));
}

void addPose(const Eigen::Isometry3d& pose, Hash* hash) {
  const Eigen::Quaterniond q = canonicalQuaternion(pose.linear());
  for (const double value : {pose.translation().x(), pose.translation().y(), pose.translation().z(),
                             q.w(), q.x(), q.y(), q.z()})
    hash->add(value);
}

void addCamera(const RigCamera& camera, Hash* hash) {
  hash->add(camera.camera.name);
  hash->add(camera.camera.identity);
  addIntrinsics(camera.camera.intrinsics, hash);
  addPose(camera.camera.world_from_camera, hash);
  hash->add(static_cast<std::uint64_t>(camera.time_offset_rule));
  hash->add(camera.time_offset);
  hash->add(static_cast<std::uint64_t>(camera.time_offset_epoch));
  hash->add(static_cast<std::uint64_t>(camera.masks.size()));
  for (const ImageMask& mask : camera.masks) {
    hash->add(mask.center.x());
    hash->add(mask.center.y());
    hash->add(mask.radius);
  }
}

}  // namespace

std::string Rig::id() const {
  Hash hash;
  hash.add(world_frame);
  hash.add(static_cast<std::uint64_t>(ray_model));
  hash.add(virtual_hfov);
  hash.add(static_cast<std::uint64_t>(cameras.size()));
  for (const RigCamera& camera : cameras)
    addCamera(camera, &hash);
  return hash.text();
}

}  // namespace wiimote_tracker::geometry
