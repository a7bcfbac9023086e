#include "wiimote_tracker_triangulation/geometry/shared_views.h"

#include "association/simulated_views.h"

#include <gtest/gtest.h>

namespace wiimote_tracker::geometry::test {
namespace {

using association::test::ringRig;
using Eigen::Vector3d;

constexpr double kRange = 10.0;  // [m]
using Cameras = std::vector<std::vector<std::size_t>>;

TEST(SharedViews, AreOnlyCamerasWithCommonVolume) {
  // Two rooms of four cameras, 30 m apart, and one camera that looks away.
  Rig rig = ringRig(4);
  const Rig other = ringRig(4);
  for (RigCamera camera : other.cameras) {
    camera.camera.name += "_far";
    camera.camera.world_from_camera.pretranslate(Vector3d(30.0, 0.0, 0.0));
    rig.cameras.push_back(camera);
  }
  RigCamera away = rig.cameras[0];
  away.camera.world_from_camera = lookAt({0.0, 8.0, 2.0}, {0.0, 20.0, 2.0}, Vector3d::UnitZ());
  rig.cameras.push_back(away);
  const auto shared = sharedViews(rig, kRange);
  const Cameras expected = {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}, {5, 6, 7},
                            {4, 6, 7}, {4, 5, 7}, {4, 5, 6}, {}};
  EXPECT_EQ(expected, shared);
}

TEST(SharedViews, AreThoseOfTheRaysOfTheRig) {
  Rig rig;
  for (const double x : {0.0, 1.0}) {
    RigCamera camera;
    camera.camera.intrinsics.fx = camera.camera.intrinsics.fy = 20000.0;
    camera.camera.world_from_camera = lookAt({x, 0.0, 0.0}, {x, 1.0, 0.0}, Vector3d::UnitZ());
    rig.cameras.push_back(camera);
  }
  EXPECT_TRUE(sharedViews(rig, kRange)[0].empty()) << "the lenses are long";
  rig.ray_model = RayModel::kImageCenter;
  rig.virtual_hfov = 0.7;  // [rad]
  EXPECT_EQ(std::vector<std::size_t>{1}, sharedViews(rig, kRange)[0]);
}

TEST(GroupsOf, CamerasAreLinkedByOthers) {
  EXPECT_EQ((Cameras{{0, 1, 2, 3}}), groupsOf({{3}, {2}, {1, 3}, {0, 2}}));
}

TEST(GroupsOf, RoomsAndALoneCameraAreApart) {
  EXPECT_EQ((Cameras{{0, 2}, {1, 4}, {3}}), groupsOf({{2}, {4}, {0}, {}, {1}}));
  EXPECT_TRUE(groupsOf({}).empty());
}

}  // namespace
}  // namespace wiimote_tracker::geometry::test
