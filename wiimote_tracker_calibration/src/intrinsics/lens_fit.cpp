// Fits a lens with cv::calibrateCamera or cv::fisheye::calibrate.
#include "lens_fit.h"

#include <wiimote_tracker_msgs/error.h>

#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

namespace wiimote_tracker::intrinsics {

namespace {

// Termination: number of iterations, relative change of the parameters.
const cv::TermCriteria kPrecise(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 50, 1e-8);
const cv::TermCriteria kRough(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 20, 1e-3);

int plumbBobFlags(LensModel model) {
  int flags = cv::CALIB_USE_INTRINSIC_GUESS;
  if (model != LensModel::kFull)
    flags |= cv::CALIB_FIX_K3 | cv::CALIB_ZERO_TANGENT_DIST;
  if (model == LensModel::kK1 || model == LensModel::kNoDistortion)
    flags |= cv::CALIB_FIX_K2;
  if (model == LensModel::kNoDistortion)
    flags |= cv::CALIB_FIX_K1;
  return flags;
}

int equidistantFlags(LensModel model) {
  int flags = cv::fisheye::CALIB_USE_INTRINSIC_GUESS | cv::fisheye::CALIB_RECOMPUTE_EXTRINSIC |
              cv::fisheye::CALIB_FIX_SKEW;
  if (model != LensModel::kEquidistant)
    flags |= cv::fisheye::CALIB_FIX_K1 | cv::fisheye::CALIB_FIX_K2 | cv::fisheye::CALIB_FIX_K3 |
             cv::fisheye::CALIB_FIX_K4;
  return flags;
}

bool isEquidistant(const Fit& fit) {
  return fit.distortion.total() == 4;
}

void calibrate(const Points& points, const cv::TermCriteria& end, Fit* fit) {
  if (!isEquidistant(*fit)) {
    cv::calibrateCamera(points.board, points.image, points.image_size, fit->camera_matrix,
                        fit->distortion, fit->rotations, fit->translations,
                        plumbBobFlags(fit->model), end);
    return;
  }
  std::vector<cv::Vec3d> rotations;
  std::vector<cv::Vec3d> translations;
  cv::fisheye::calibrate(points.board, points.image, points.image_size, fit->camera_matrix,
                         fit->distortion, rotations, translations, equidistantFlags(fit->model),
                         end);
  fit->rotations.assign(rotations.begin(), rotations.end());
  fit->translations.assign(translations.begin(), translations.end());
}

/// Pixels of a view's LEDs, with the derivatives in OpenCV's order.
std::vector<cv::Point2f> project(const Fit& fit,
                                 const Points& points,
                                 std::size_t view,
                                 cv::Mat* derivative) {
  std::vector<cv::Point2f> projected;
  if (isEquidistant(fit))
    cv::fisheye::projectPoints(points.board[view], projected, fit.rotations[view],
                               fit.translations[view], fit.camera_matrix, fit.distortion, 0.0,
                               *derivative);
  else
    cv::projectPoints(points.board[view], fit.rotations[view], fit.translations[view],
                      fit.camera_matrix, fit.distortion, projected, *derivative);
  return projected;
}

double reprojectionError(const Fit& fit, const Points& points) {
  double sum = 0.0;
  cv::Mat derivative;
  for (std::size_t view = 0; view < points.board.size(); ++view) {
    const std::vector<cv::Point2f> projected = project(fit, points, view, &derivative);
    for (std::size_t i = 0; i < projected.size(); ++i) {
      const cv::Point2f d = projected[i] - points.image[view][i];
      sum += d.dot(d);
    }
  }
  return std::sqrt(sum / static_cast<double>(points.count));
}

}  // namespace

Points::Points(const Samples& samples) : image_size(samples.width, samples.height) {
  for (const BoardView& view : samples.views) {
    board.emplace_back();
    image.emplace_back();
    for (int led = 0; led < kBoardLeds; ++led) {
      const auto& pixel = view.pixels[static_cast<std::size_t>(led)];
      if (!pixel)
        continue;
      const Eigen::Vector3f p = samples.board.position(led).cast<float>();
      board.back().emplace_back(p.x(), p.y(), p.z());
      image.back().emplace_back(static_cast<float>(pixel->x()), static_cast<float>(pixel->y()));
      ++count;
    }
  }
}

Fit firstFit(const Points& points, bool equidistant, double focal_length) {
  Fit best;
  for (const double factor : {1.0, 0.35}) {  // without and with a wide-angle lens in front
    Fit start;
    start.camera_matrix =
        (cv::Mat_<double>(3, 3) << factor * focal_length, 0.0, (points.image_size.width - 1) / 2.0,
         0.0, factor * focal_length, (points.image_size.height - 1) / 2.0, 0.0, 0.0, 1.0);
    // A column: with a row OpenCV before 4.6 refuses to fit an equidistant lens.
    start.distortion = cv::Mat::zeros(equidistant ? 4 : 5, 1, CV_64F);
    const Fit fit = refined(start, LensModel::kNoDistortion, points, true);
    if (fit.error < best.error)
      best = fit;
  }
  if (best.ok())
    best = refined(best, LensModel::kNoDistortion, points);
  if (!best.ok())
    throw Error(
        "the views fit no camera: check the board's spacings, and show it again "
        "from at least 12 different sides");
  return best;
}

Fit refined(const Fit& start, LensModel model, const Points& points, bool roughly) {
  Fit fit;
  fit.model = model;
  fit.camera_matrix = start.camera_matrix.clone();
  fit.distortion = start.distortion.clone();
  try {
    calibrate(points, roughly ? kRough : kPrecise, &fit);
    if (cv::checkRange(fit.camera_matrix) && cv::checkRange(fit.distortion))
      fit.error = reprojectionError(fit, points);
  } catch (const cv::Exception&) {
    // No solution from this start; the caller tries others.
  }
  return fit;
}

geometry::Intrinsics intrinsicsOf(const Fit& fit, const Points& points) {
  geometry::Intrinsics result;
  result.width = points.image_size.width;
  result.height = points.image_size.height;
  result.fx = fit.camera_matrix.at<double>(0, 0);
  result.fy = fit.camera_matrix.at<double>(1, 1);
  result.cx = fit.camera_matrix.at<double>(0, 2);
  result.cy = fit.camera_matrix.at<double>(1, 2);
  result.distortion_model = isEquidistant(fit) ? geometry::DistortionModel::kEquidistant
                                               : geometry::DistortionModel::kPlumbBob;
  for (std::size_t i = 0; i < fit.distortion.total(); ++i)
    result.distortion[i] = fit.distortion.at<double>(static_cast<int>(i));
  return result;
}

int parameterCount(LensModel model) {
  constexpr int kCounts[] = {4, 5, 6, 9, 8};  // in the order of LensModel
  return kCounts[static_cast<std::size_t>(model)];
}

ViewDerivative differentiate(const Fit& fit, const Points& points, std::size_t view) {
  cv::Mat derivative;
  project(fit, points, view, &derivative);
  Eigen::MatrixXd by;
  cv::cv2eigen(derivative, by);
  const int parameters = parameterCount(fit.model);
  // OpenCV's columns: pose, then lens; for a fisheye lens its eight parameters, then pose.
  if (isEquidistant(fit))
    return {by.middleCols<kPoseParameters>(8), by.leftCols(parameters)};
  return {by.leftCols<kPoseParameters>(), by.middleCols(kPoseParameters, parameters)};
}

}  // namespace wiimote_tracker::intrinsics
