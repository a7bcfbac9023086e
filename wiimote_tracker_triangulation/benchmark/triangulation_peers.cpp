// Other libraries' methods, called as their users call them: many points at once where the method
// takes many, without covariance. All take two views.
#include "triangulation_scene.h"

#ifdef WIIMOTE_TRACKER_HAVE_OPENCV
#include <opencv2/calib3d.hpp>
#endif
#ifdef WIIMOTE_TRACKER_HAVE_OPENGV
#include <opengv/relative_pose/CentralRelativeAdapter.hpp>
#include <opengv/triangulation/methods.hpp>
#endif
#ifdef WIIMOTE_TRACKER_HAVE_MRCAL
extern "C" {
#include <mrcal/triangulation.h>
}
#endif

namespace wiimote_tracker {
namespace {

using Eigen::Vector3d;
using Run = std::function<void(TriangulationOutput*)>;

/// Direction of a pixel in its camera's axes, depth 1.
[[maybe_unused]] Vector3d directionOf(const geometry::Camera& camera,
                                      const Eigen::Vector2d& pixel) {
  return {(pixel.x() - camera.intrinsics.cx) / camera.intrinsics.fx,
          (pixel.y() - camera.intrinsics.cy) / camera.intrinsics.fy, 1.0};
}

[[maybe_unused]] Eigen::Isometry3d firstFromSecond(const TriangulationScene& scene) {
  return scene.cameras[0].world_from_camera.inverse(Eigen::Isometry) *
         scene.cameras[1].world_from_camera;
}

#ifdef WIIMOTE_TRACKER_HAVE_OPENCV
cv::Mat_<double> projectionOf(const geometry::Camera& camera) {
  Eigen::Matrix3d K;
  K << camera.intrinsics.fx, 0, camera.intrinsics.cx, 0, camera.intrinsics.fy, camera.intrinsics.cy,
      0, 0, 1;
  Eigen::Matrix<double, 3, 4, Eigen::RowMajor> P =
      K * camera.world_from_camera.inverse(Eigen::Isometry).matrix().topRows<3>();
  return cv::Mat_<double>(3, 4, P.data()).clone();
}

Run opencv(const TriangulationScene& scene) {
  const int count = static_cast<int>(scene.pixels.size());
  std::vector<cv::Mat_<double>> P, pixels;
  for (std::size_t c = 0; c < 2; ++c) {
    P.push_back(projectionOf(scene.cameras[c]));
    pixels.emplace_back(2, count);
    for (int i = 0; i < count; ++i) {
      pixels[c](0, i) = scene.pixels[static_cast<std::size_t>(i)][c].x();
      pixels[c](1, i) = scene.pixels[static_cast<std::size_t>(i)][c].y();
    }
  }
  return [P, pixels](TriangulationOutput* output) {
    cv::Mat_<double> h;
    cv::triangulatePoints(P[0], P[1], pixels[0], pixels[1], h);
    for (int i = 0; i < h.cols; ++i) {
      output->positions[static_cast<std::size_t>(i)] =
          Vector3d(h(0, i), h(1, i), h(2, i)) / h(3, i);
    }
  };
}
#endif

#ifdef WIIMOTE_TRACKER_HAVE_OPENGV
using OpenGvMethod = opengv::point_t (*)(const opengv::relative_pose::RelativeAdapterBase&,
                                         std::size_t);

struct OpenGvScene {
  explicit OpenGvScene(const TriangulationScene& scene) {
    for (const auto& pixels : scene.pixels) {
      first.push_back(directionOf(scene.cameras[0], pixels[0]).normalized());
      second.push_back(directionOf(scene.cameras[1], pixels[1]).normalized());
    }
    const Eigen::Isometry3d pose = firstFromSecond(scene);
    translation = pose.translation();
    rotation = pose.linear();
  }
  opengv::bearingVectors_t first, second;
  opengv::translation_t translation;
  opengv::rotation_t rotation;
};

Run opengvRun(const TriangulationScene& scene, OpenGvMethod method) {
  return [data = OpenGvScene(scene), method](TriangulationOutput* output) {
    const opengv::relative_pose::CentralRelativeAdapter adapter(data.first, data.second,
                                                                data.translation, data.rotation);
    for (std::size_t i = 0; i < output->positions.size(); ++i)
      output->positions[i] = method(adapter, i);
  };
}
#endif

#ifdef WIIMOTE_TRACKER_HAVE_MRCAL
using MrcalMethod = mrcal_point3_t (*)(mrcal_point3_t*,
                                       mrcal_point3_t*,
                                       mrcal_point3_t*,
                                       const mrcal_point3_t*,
                                       const mrcal_point3_t*,
                                       const mrcal_point3_t*);

mrcal_point3_t toMrcal(const Vector3d& v) {
  mrcal_point3_t point;
  point.x = v.x();
  point.y = v.y();
  point.z = v.z();
  return point;
}

/// `pose`: what the method reads as its last argument; `second_in_own_axes`: its second direction
/// is in the second camera's axes, not the first one's.
Run mrcalRun(const TriangulationScene& scene,
             MrcalMethod method,
             const std::vector<mrcal_point3_t>& pose,
             bool second_in_own_axes) {
  const Eigen::Matrix3d rotation = firstFromSecond(scene).linear();
  std::vector<mrcal_point3_t> first, second;
  for (const auto& pixels : scene.pixels) {
    first.push_back(toMrcal(directionOf(scene.cameras[0], pixels[0])));
    const Vector3d direction = directionOf(scene.cameras[1], pixels[1]);
    second.push_back(toMrcal(second_in_own_axes ? direction : rotation * direction));
  }
  return [first, second, pose, method](TriangulationOutput* output) {
    for (std::size_t i = 0; i < output->positions.size(); ++i) {
      const mrcal_point3_t p =
          method(nullptr, nullptr, nullptr, &first[i], &second[i], pose.data());
      output->positions[i] = Vector3d(p.x, p.y, p.z);
    }
  };
}

std::function<Run(const TriangulationScene&)> mrcalInFirstCamera(MrcalMethod method) {
  return [method](const TriangulationScene& scene) {
    return mrcalRun(scene, method, {toMrcal(firstFromSecond(scene).translation())}, false);
  };
}

Run mrcalLindstrom(const TriangulationScene& scene) {
  const Eigen::Isometry3d pose = firstFromSecond(scene);
  std::vector<mrcal_point3_t> Rt;
  for (int r = 0; r < 3; ++r)
    Rt.push_back(toMrcal(pose.linear().row(r)));
  Rt.push_back(toMrcal(pose.translation()));
  return mrcalRun(scene, mrcal_triangulate_lindstrom, Rt, true);
}
#endif

}  // namespace

std::vector<TriangulationMethod> peerMethods() {
  std::vector<TriangulationMethod> methods;
#ifdef WIIMOTE_TRACKER_HAVE_OPENCV
  methods.push_back({"OpenCV triangulatePoints", false, opencv});
#endif
#ifdef WIIMOTE_TRACKER_HAVE_OPENGV
  methods.push_back({"OpenGV triangulate (DLT)", true, [](const auto& scene) {
                       return opengvRun(scene, opengv::triangulation::triangulate);
                     }});
  methods.push_back({"OpenGV triangulate2 (midpoint)", true, [](const auto& scene) {
                       return opengvRun(scene, opengv::triangulation::triangulate2);
                     }});
#endif
#ifdef WIIMOTE_TRACKER_HAVE_MRCAL
  methods.push_back(
      {"mrcal geometric (midpoint)", true, mrcalInFirstCamera(mrcal_triangulate_geometric)});
  methods.push_back({"mrcal lindstrom", true, mrcalLindstrom});
  methods.push_back(
      {"mrcal leecivera_l1", true, mrcalInFirstCamera(mrcal_triangulate_leecivera_l1)});
  methods.push_back(
      {"mrcal leecivera_mid2", true, mrcalInFirstCamera(mrcal_triangulate_leecivera_mid2)});
#endif
  return methods;
}

}  // namespace wiimote_tracker
