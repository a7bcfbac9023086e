#include "node_parts.h"

#include "intrinsics/view_collector.h"
#include "rig_storage.h"
#include "wiimote_tracker_calibration/intrinsics/solve_intrinsics.h"
#include "wiimote_tracker_triangulation/ros/conversions.h"

#include <std_srvs/Trigger.h>
#include <wiimote_tracker_msgs/BoardStatus.h>
#include <wiimote_tracker_msgs/SolveBoard.h>
#include <wiimote_tracker_msgs/StartBoard.h>
#include <wiimote_tracker_msgs/error.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker {

using std_srvs::Trigger;
using wiimote_tracker_msgs::SolveBoard;
using workflow::Reply;

namespace {

const char kNothingStarted[] =
    "no lens is being calibrated: start one (service calibration/board/start)";

/// @throws Error: unknown number.
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
      throw Error("there is no lens model " + std::to_string(model) +
                  ": choose one of SolveBoard.srv");
  }
}

geometry::Camera cameraOf(const std::string& name, const geometry::Intrinsics& lens) {
  geometry::Camera camera;
  camera.name = name;
  camera.intrinsics = lens;
  return camera;
}

class BoardServices {
 public:
  explicit BoardServices(NodeContext* context) : context_(*context) {
    publisher_ =
        context_.nh().advertise<wiimote_tracker_msgs::BoardStatus>("calibration/board", 1, true);
    offer("start", &BoardServices::start);
    offer("undo", &BoardServices::undo);
    offer("cancel", &BoardServices::cancel);
    offer("solve", &BoardServices::solve);
    offer("commit", &BoardServices::commit);
    context_.inputs().subscribeImages(
        [this](const capture::Image& image, const Lock& lock) { onImage(image, lock); });
    const Lock lock(context_.mutex());
    publish(kNothingStarted, lock);
  }

 private:
  /// The calibration's status does not show replies: a lens is none of its steps.
  template <typename Handler>
  void offer(const std::string& name, Handler handler) {
    context_.offer("board/" + name, handler, this, false);
  }

  Reply start(wiimote_tracker_msgs::StartBoard& call, Lock& lock) {
    context_.discover(&lock);
    if (const std::string reason = context_.inputs().whyIgnored({call.request.camera});
        !reason.empty())
      throw Refusal(reason);
    const auto input = context_.inputs().cameras().find(call.request.camera);
    if (input == context_.inputs().cameras().end() || input->second.width < 0)
      throw Refusal("no image of a camera '" + call.request.camera +
                    "' has come: check its name, or start its driver");
    const Parameters& parameters = context_.parameters(lock);
    intrinsics::Board board = parameters.board;
    if (call.request.column_spacing != 0.0)
      board.column_spacing = board.row_spacing = call.request.column_spacing;
    if (call.request.row_spacing != 0.0)
      board.row_spacing = call.request.row_spacing;
    run_ = intrinsics::ViewCollector(board, input->second.width, input->second.height,
                                     parameters.board_views);
    camera_ = call.request.camera;
    dropLens();
    const std::string message =
        "hold the board still in front of " + camera_ +
        " for two seconds, then elsewhere: each view is captured automatically";
    publish(message, lock);
    return {true, message};
  }

  Reply undo(Trigger&, Lock& lock) {
    if (run().samples().views.empty())
      throw Refusal("there is no view to undo");
    run_->undo();
    dropLens();
    publish(run_->message(), lock);
    return {true, run_->message()};
  }

  Reply cancel(Trigger&, Lock& lock) {
    run();
    run_.reset();
    dropLens();
    camera_.clear();
    publish("the views of the board are dropped", lock);
    return {true, "the views of the board are dropped"};
  }

  Reply solve(SolveBoard& call, Lock& lock) {
    const std::string camera = camera_;
    const unsigned lens_number = lens_number_;
    const intrinsics::Samples samples = run().samples();
    intrinsics::SolverOptions options;
    options.minimum_views = context_.parameters(lock).board_views;
    options.start_focal_length = context_.parameters(lock).intrinsics.fx;
    options.model = lensModel(call.request.model);
    const intrinsics::IntrinsicsSolution solution =
        context_.compute(&lock, [&] { return intrinsics::solveIntrinsics(samples, options); });
    if (lens_number != lens_number_)
      throw Refusal("the views were changed meanwhile: solve again");
    call.response.camera_info = cameraInfo(cameraOf(camera, solution.intrinsics));
    call.response.reprojection_error = solution.reprojection_error;
    const auto parameters = static_cast<Eigen::Index>(4 + call.response.camera_info.D.size());
    for (Eigen::Index i = 0; i < parameters; ++i)
      call.response.stddev.push_back(std::sqrt(solution.covariance(i, i)));
    lens_ = solution.intrinsics;
    publish("solved: " + solution.summary, lock);
    return {true, solution.summary};
  }

  Reply commit(Trigger&, Lock& lock) {
    run();
    if (!lens_)
      throw Refusal("the lens is not solved: solve it first");
    const geometry::Camera camera = cameraOf(camera_, *lens_);
    context_.parameters(lock).own_intrinsics[camera.name] = camera.intrinsics;
    const double timeout = context_.parameters(lock).set_camera_info_timeout;
    const std::vector<std::string> problems =
        context_.compute(&lock, [&] { return sendCameraInfo({camera}, context_.nh(), timeout); });
    const std::string message = "calibrations start with this lens of " + camera.name +
                                " until this node ends" +
                                (problems.empty() ? ", and its driver has it until a rig is saved"
                                                  : "; but " + problems.front());
    publish(message, lock);
    return {true, message};
  }

  /// @throws Refusal: nothing was started.
  intrinsics::ViewCollector& run() {
    if (!run_)
      throw Refusal(kNothingStarted);
    return *run_;
  }

  /// A lens of dropped views, solved or being solved, is not used.
  void dropLens() {
    lens_.reset();
    ++lens_number_;
  }

  void onImage(const capture::Image& image, const Lock& lock) {
    if (run_ && image.camera == camera_ && run_->addImage(image.stamp, image.spots))
      publish(run_->message(), lock);
  }

  void publish(const std::string& message, const Lock& lock) {
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

  NodeContext& context_;
  ros::Publisher publisher_;
  // All of the following with the mutex locked.
  std::string camera_;  // that sees the board; empty: nothing started
  std::optional<intrinsics::ViewCollector> run_;
  std::optional<geometry::Intrinsics> lens_;  // solved from these views
  unsigned lens_number_ = 0;                  // counts dropLens()
};

}  // namespace

NodePart boardServices(NodeContext* context) {
  return std::make_shared<BoardServices>(context);
}

}  // namespace wiimote_tracker
