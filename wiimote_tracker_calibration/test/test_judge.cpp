// The grade of a rig whose errors are known.
#include "expect_says.h"
#include "simulated_rig.h"

#include "samples/judge.h"

#include <gtest/gtest.h>

namespace wiimote_tracker::samples {
namespace {

Verdict judged(const Samples& samples, const geometry::Rig& rig) {
  square::Solution found;
  found.rig = rig;
  return judge(samples, found);
}

/// Of the paper's rig and square, where the positions of the cameras have this error [m].
Verdict verdictWith(double position_stddev) {
  Samples samples;
  samples.recording.square = square::paperSquare();
  RigErrors errors = wellCalibrated();
  errors.position = position_stddev;
  return judged(samples, paperRigWith(errors));
}

TEST(Judge, GradesByTheErrorOfPoints) {
  // Points are off by about twice the error of each position; the LED is 6 m away.
  const Verdict good = verdictWith(0.0005);
  EXPECT_EQ(good.grade, Grade::kGood) << good.text;
  EXPECT_SAYS(good.text, "good; points are known to ");
  const Verdict usable = verdictWith(0.025);
  EXPECT_EQ(usable.grade, Grade::kUsable) << usable.text;
  EXPECT_SAYS(usable.text, "usable: it is not as accurate as it could be");
  const Verdict redo = verdictWith(0.2);
  EXPECT_EQ(redo.grade, Grade::kRedo) << redo.text;
  EXPECT_SAYS(redo.text, "redo: points would be far off");
}

TEST(Judge, AdvisesWhatWasNotDoneYet) {
  Samples samples;
  samples.recording.square = square::paperSquare();
  RigErrors errors = wellCalibrated();
  errors.position = 0.025;
  EXPECT_SAYS(judged(samples, paperRigWith(errors)).text,
              "wave an LED or a wand through the volume, or use a larger square");
  samples.recording.cameras.resize(1);
  samples.recording.cameras[0].frames.push_back({0.0, {}});
  EXPECT_SAYS(judged(samples, paperRigWith(errors)).text,
              "wave longer, through the whole volume, or use a larger square");
}

TEST(Judge, ACameraThatSawOtherLightsIsNamed) {
  Samples samples;
  samples.recording.square = square::paperSquare();
  geometry::Rig rig = paperRigWith(wellCalibrated());
  for (geometry::RigCamera& camera : rig.cameras)
    camera.observations = camera.inliers = 200;
  EXPECT_EQ(judged(samples, rig).grade, Grade::kGood);
  rig.cameras[1].inliers = 140;
  const Verdict verdict = judged(samples, rig);
  EXPECT_EQ(verdict.grade, Grade::kUsable);
  EXPECT_SAYS(verdict.text, "usable: 30 % of what camera_2 saw was not the LED");
}

TEST(Judge, SaysOnceWhatTheSolverSaid) {
  Samples samples;
  samples.recording.square = square::paperSquare();
  square::Solution found;
  found.rig = paperRigWith(wellCalibrated());
  found.rig.verdict = "4 cameras solved";
  found.warnings = {"one", "two"};
  const std::string text = judge(samples, found).text;
  EXPECT_SAYS(text, "usable: read the warnings; points are known to ");
  EXPECT_SAYS(text, "; 4 cameras solved; warning: one; warning: two");
}

TEST(Judge, AWaveIsJudgedByItsDistanceFromTheCameras) {
  // Without a square the first camera is the world's origin; the other one stands beside it.
  square::Solution found;
  for (const double x : {0.0, 0.5}) {
    geometry::RigCamera& camera = found.rig.cameras.emplace_back();
    camera.camera.world_from_camera.translation().x() = x;
  }
  found.wave.emplace().expected_shape_error = 0.012;
  found.path = {{0.0, 0.0, 3.5}, {0.5, 0.0, 4.5}};
  EXPECT_EQ(judge({}, found).grade, Grade::kGood);
  found.wave->expected_shape_error = 0.024;
  EXPECT_EQ(judge({}, found).grade, Grade::kUsable);
  found.wave->expected_shape_error = 0.1;
  EXPECT_EQ(judge({}, found).grade, Grade::kRedo);
}

}  // namespace
}  // namespace wiimote_tracker::samples
