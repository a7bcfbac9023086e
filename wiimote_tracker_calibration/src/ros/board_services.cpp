#include "board_services.h"

#include "wiimote_tracker_calibration/intrinsics/error.h"
#include "wiimote_tracker_calibration/intrinsics/solve_intrinsics.h"

#include "replies.h"
#include "rig_storage.h"

#include <wiimote_tracker_msgs/BoardStatus.h>

#include <cmath>

namespace wiimote_tracker {

namespace {

using wiimote_tracker_msgs::SolveBoard;

const workflow::Reply kNothingStarted = {false, "no board is looked at: start with a camera first"};

/// @throws intrinsics::IntrinsicsError: unknown number.
std::optional<intrinsics::LensModel> lensModel(std::uint8_t model) {
  using intrinsics::LensModel;
  switch (model) {
    case SolveBoard::Request::AUTOMATIC:
      return std::nullopt;
    case SolveBoard::Request::NO_DISTORTION:
      return LensModel::kNoDistortion;
    case SolveBoard::Request::K1:
      return LensModel::kK1;
    case SolveBoard::Request::K1_K2:
      return LensModel::kK1K2;
    case SolveBoard::Request::PLUMB_BOB:
      return LensModel::kFull;
    case SolveBoard::Request::EQUIDISTANT:
      return LensModel::kEquidistant;
    default:
      throw intrinsics::IntrinsicsError("there is no lens model " + std::to_string(model) +
                                        ": choose one of SolveBoard");
  }
}

geometry::Camera cameraOf(const std::string& name, const geometry::Intrinsics& lens) {
  geometry::Camera camera;
  camera.name = name;
  camera.intrinsics = lens;
  return camera;
}

}  // namespace

BoardServices::BoardServices(NodeContext* context) : context_(*context) {
  ros::NodeHandle& nh = context_.nh();
  publisher_ = nh.advertise<wiimote_tracker_msgs::BoardStatus>("calibration/board", 1, true);
  services_ = {nh.advertiseService("calibration/board/start", &BoardServices::start, this),
               nh.advertiseService("calibration/board/undo", &BoardServices::undo, this),
               nh.advertiseService("calibration/board/cancel", &BoardServices::cancel, this),
               nh.advertiseService("calibration/board/solve", &BoardServices::solve, this),
               nh.advertiseService("calibration/board/commit", &BoardServices::commit, this)};
  context_.inputs().subscribeImages(
      [this](const capture::Image& image, const Lock& lock) { onImage(image, lock); });
  const Lock lock(context_.mutex());
  publish(kNothingStarted.message, lock);
}

bool BoardServices::start(wiimote_tracker_msgs::StartBoard::Request& request,
                          wiimote_tracker_msgs::StartBoard::Response& response) {
  context_.inputs().discover();
  const Lock lock(context_.mutex());
  fill(start(request, lock), &response);
  if (response.success)
    publish(response.message, lock);
  return true;
}

workflow::Reply BoardServices::start(const wiimote_tracker_msgs::StartBoard::Request& request,
                                     const Lock& lock) {
  const auto input = context_.inputs().cameras().find(request.camera);
  if (input == context_.inputs().cameras().end() || input->second.width == 0)
    return {false, "no image of " + request.camera + " has come: check its name, start its driver"};
  const Parameters& parameters = context_.parameters(lock);
  intrinsics::Board board = parameters.board;
  if (request.column_spacing != 0.0)
    board.column_spacing = board.row_spacing = request.column_spacing;
  if (request.row_spacing != 0.0)
    board.row_spacing = request.row_spacing;
  intrinsics::CollectorOptions options;
  options.minimum_views = parameters.board_views;
  try {
    intrinsics::BoardRun run(board, input->second.width, input->second.height, options);
    run_ = std::move(run);
  } catch (const intrinsics::IntrinsicsError& error) {
    return {false, error.what()};
  }
  camera_ = request.camera;
  lens_.reset();
  return {true, "hold the board still in front of " + camera_ +
                    " for two seconds, then elsewhere: each view is taken by itself"};
}

bool BoardServices::undo(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  const Lock lock(context_.mutex());
  workflow::Reply reply = kNothingStarted;
  if (run_ && run_->samples().views.empty()) {
    reply.message = "there is no view to take back";
  } else if (run_) {
    run_->undo();
    lens_.reset();
    reply = {true, run_->message()};
    publish(reply.message, lock);
  }
  fill(reply, &response);
  return true;
}

bool BoardServices::cancel(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  const Lock lock(context_.mutex());
  workflow::Reply reply = kNothingStarted;
  if (run_) {
    run_.reset();
    lens_.reset();
    camera_.clear();
    reply = {true, "the views of the board are dropped"};
    publish(reply.message, lock);
  }
  fill(reply, &response);
  return true;
}

bool BoardServices::solve(SolveBoard::Request& request, SolveBoard::Response& response) {
  Lock lock(context_.mutex());
  if (!run_) {
    fill(kNothingStarted, &response);
    return true;
  }
  const std::string camera = camera_;
  const intrinsics::Samples samples = run_->samples();
  intrinsics::SolverOptions options;
  options.minimum_views = context_.parameters(lock).board_views;
  options.start_focal_length = context_.parameters(lock).intrinsics.fx;
  lock.unlock();
  intrinsics::IntrinsicsSolution solution;
  try {
    options.model = lensModel(request.model);
    solution = intrinsics::solveIntrinsics(samples, options);
  } catch (const intrinsics::IntrinsicsError& error) {
    response.message = error.what();
    return true;
  }
  response.success = true;
  response.message = solution.summary;
  response.camera_info = cameraInfo(cameraOf(camera, solution.intrinsics));
  response.reprojection_error = solution.reprojection_error;
  const auto parameters = static_cast<Eigen::Index>(4 + response.camera_info.D.size());
  for (Eigen::Index i = 0; i < parameters; ++i)
    response.stddev.push_back(std::sqrt(solution.covariance(i, i)));
  lock.lock();
  if (camera == camera_) {
    lens_ = solution.intrinsics;
    publish("solved: " + solution.summary, lock);
  }
  return true;
}

bool BoardServices::commit(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  Lock lock(context_.mutex());
  if (!lens_) {
    response.message = run_ ? "the lens is not solved: solve it first" : kNothingStarted.message;
    return true;
  }
  const geometry::Camera camera = cameraOf(camera_, *lens_);
  context_.parameters(lock).own_intrinsics[camera.name] = camera.intrinsics;
  const double timeout = context_.parameters(lock).set_camera_info_timeout;
  lock.unlock();
  const std::string problem = sendCameraInfo(camera, context_.nh(), timeout);
  response.success = true;
  response.message = "the next calibration starts with this lens of " + camera.name +
                     (problem.empty() ? ", and its driver has it" : "; but " + problem);
  lock.lock();
  publish(response.message, lock);
  return true;
}

void BoardServices::onImage(const capture::Image& image, const Lock& lock) {
  if (run_ && image.camera == camera_ && run_->add(image.stamp, image.spots))
    publish(run_->message(), lock);
}

void BoardServices::publish(const std::string& message, const Lock& lock) {
  wiimote_tracker_msgs::BoardStatus status;
  status.header.stamp = ros::Time::now();
  status.camera = camera_;
  status.views_needed = static_cast<std::uint32_t>(context_.parameters(lock).board_views);
  status.message = message;
  if (run_) {
    const auto input = context_.inputs().cameras().find(camera_);
    if (input != context_.inputs().cameras().end())
      status.header.frame_id = input->second.optical_frame;
    const intrinsics::Coverage coverage = run_->coverage();
    status.views = static_cast<std::uint32_t>(run_->samples().views.size());
    status.x = coverage.x;
    status.y = coverage.y;
    status.size = coverage.size;
    status.skew = coverage.skew;
    status.missing = coverage.missing;
  }
  publisher_.publish(status);
}

}  // namespace wiimote_tracker
