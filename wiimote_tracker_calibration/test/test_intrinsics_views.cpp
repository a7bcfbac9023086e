#include "wiimote_tracker_calibration/simulation/simulated_board.h"

#include "wiimote_tracker_calibration/intrinsics/error.h"
#include "wiimote_tracker_calibration/intrinsics/samples_file.h"
#include "wiimote_tracker_calibration/intrinsics/solve_intrinsics.h"
#include "wiimote_tracker_calibration/intrinsics/view_collector.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

namespace wiimote_tracker::intrinsics {
namespace {

/// The board as a rectangle in the image, LED 0 at its top left.
BoardView frontView(double left, double top, double side) {
  BoardView view;
  for (int led = 0; led < kBoardLeds; ++led)
    view.pixels[static_cast<std::size_t>(led)] =
        Eigen::Vector2d(left + side * (led % 4) / 3.0, top + side * (led / 4) / 3.0);
  return view;
}

TEST(ViewCollector, barsAreThoseOfTheDefinition) {
  ViewCollector collector(Board(), 1024, 768, CollectorOptions());
  EXPECT_FALSE(collector.coverage().enough());
  EXPECT_EQ(collector.add(frontView(0.0, 0.0, 200.0)), "");
  EXPECT_EQ(collector.add(frontView(412.0, 568.0, 200.0)), "");
  const Coverage coverage = collector.coverage();
  EXPECT_NEAR(coverage.x, (412.0 / 824.0) / 0.7, 1e-6);
  EXPECT_NEAR(coverage.y, 1.0, 1e-6);
  EXPECT_NEAR(coverage.size, 200.0 / std::sqrt(1024.0 * 768.0) / 0.4, 1e-6);
  EXPECT_NEAR(coverage.skew, 0.0, 1e-6);
  EXPECT_EQ(coverage.missing.size(), 4u);  // views, x, size, skew
}

TEST(ViewCollector, keepsWhatDiffersAndSaysWhyNot) {
  ViewCollector collector(Board(), 1024, 768, CollectorOptions());
  EXPECT_EQ(collector.add(frontView(100.0, 100.0, 200.0)), "");
  EXPECT_NE(collector.add(frontView(110.0, 105.0, 200.0)).find("too much like"), std::string::npos);
  EXPECT_EQ(collector.samples().views.size(), 1u);
  collector.undo();
  EXPECT_EQ(collector.add(frontView(110.0, 105.0, 200.0)), "");
  BoardView few;
  few.pixels[0] = few.pixels[5] = Eigen::Vector2d(1.0, 2.0);
  EXPECT_NE(collector.add(few).find("fewer than 6"), std::string::npos);
}

TEST(ViewCollector, enoughIsEnoughToSolve) {
  std::mt19937 random(3);
  ViewCollector collector(Board(), 1024, 768, CollectorOptions());
  for (int i = 0; i < 2000 && !collector.coverage().enough(); ++i)
    collector.add(simulatedView(paperCamera(), randomPose(random), 0.5, random));
  ASSERT_TRUE(collector.coverage().enough());
  EXPECT_GE(collector.samples().views.size(), 12u);
  EXPECT_LT(collector.samples().views.size(), 60u);
  const IntrinsicsSolution solution = solveIntrinsics(collector.samples(), SolverOptions());
  EXPECT_NEAR(solution.intrinsics.fx, 1306.3, 40.0);
}

class SamplesFile : public testing::Test {
 protected:
  ~SamplesFile() override { std::remove(path_.c_str()); }
  std::string refusal() const {
    try {
      readSamplesFile(path_);
    } catch (const SamplesFileError& error) {
      return error.what();
    }
    return "was not refused";
  }
  std::string content() const {
    std::ifstream file(path_);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
  void setContent(const std::string& text) const { std::ofstream(path_) << text; }

  std::string path_ = testing::TempDir() + "board_samples_" + std::to_string(::getpid()) + ".yaml";
};

TEST_F(SamplesFile, solvesToTheIdenticalResult) {
  Samples samples = simulatedSamples(paperCamera(), 12, 0.5, 5);
  samples.board.row_spacing = 0.1 + 1e-17;
  samples.views[0].pixels[3].reset();
  for (auto& pixel : samples.views[0].pixels) {
    if (pixel)
      *pixel += Eigen::Vector2d(1.0 / 3.0, M_PI / 100.0);
  }
  const IntrinsicsSolution before = solveIntrinsics(samples, SolverOptions());
  writeSamplesFile(samples, path_);
  const Samples loaded = readSamplesFile(path_);
  EXPECT_FALSE(loaded.views[0].pixels[3]);
  EXPECT_EQ(loaded.views[0].pixels, samples.views[0].pixels);
  const IntrinsicsSolution after = solveIntrinsics(loaded, SolverOptions());
  EXPECT_EQ(before.intrinsics.fx, after.intrinsics.fx);
  EXPECT_EQ(before.intrinsics.cy, after.intrinsics.cy);
  EXPECT_EQ(before.intrinsics.distortion, after.intrinsics.distortion);
  EXPECT_EQ(before.covariance, after.covariance);
  EXPECT_EQ(before.reprojection_error, after.reprojection_error);
}

TEST_F(SamplesFile, refusesWhatIsMissingCutOrForeign) {
  EXPECT_NE(refusal().find("cannot read"), std::string::npos);
  writeSamplesFile(simulatedSamples(paperCamera(), 12, 0.5, 5), path_);
  const std::string whole = content();
  for (std::size_t length = 0; length < whole.size(); length += 97) {
    setContent(whole.substr(0, length));
    EXPECT_NE(refusal().find(path_), std::string::npos) << length;
  }
  setContent("kind: rig\n...\n");
  EXPECT_NE(refusal().find("no samples"), std::string::npos);
  std::string next = whole;
  next.replace(next.find("version: 1"), 10, "version: 2");
  setContent(next);
  EXPECT_NE(refusal().find("version"), std::string::npos);
  EXPECT_THROW(writeSamplesFile(Samples(), path_ + "/no/folder"), SamplesFileError);
  EXPECT_EQ(content(), next);
}

}  // namespace
}  // namespace wiimote_tracker::intrinsics
