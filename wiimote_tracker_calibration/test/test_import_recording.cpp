#include "import_folder.h"
#include "refusal_of.h"
#include "wiimote_tracker_calibration/import/recording.h"

#include <gtest/gtest.h>

#include <string>

namespace wiimote_tracker::import {
namespace {

const char kLens[] =
    "K11 = 400.5\nK12 = 0.0\nK13 = 320.25\nK21 = 0.0\nK22 = 401.5\nK23 = 240.75\n"
    "K31 = 0.0\nK32 = 0.0\nK33 = 1.0\n\nkc1 = -0.28\nkc2 = 0.07\nkc3 = 0.0004\nkc4 = -0.0001\n\n";

/// Two cameras, four frames, in the layout of MultiCamSelfCal.
class MultiCamSelfCal : public testing::Test {
 protected:
  MultiCamSelfCal() { writeFiles(); }

  void writeFiles() {
    folder.write("Res.dat", "640 480\n656 491\n");
    folder.write("camera_order.txt", "left\n2nd camera\n");
    folder.write("basename1.rad", kLens);
    folder.write("basename2.rad", kLens);
    folder.write("points.dat",
                 "1.5 2.5 NaN 0\n11.5 12.5 nan 0\n1 1 NaN 1\n"
                 "3.5 0 7.5 4.5\n13.5 0 17.5 14.5\n1 0 1 1\n");
    folder.write("IdMat.dat", "1 1 0 1\n1 1 1 0\n");
  }

  std::string refusal() const {
    return refusalOf([&] { readRecording(folder.path()); });
  }

  void expectRefusal(const std::string& part) const {
    EXPECT_NE(refusal().find(part), std::string::npos) << refusal();
  }

  Folder folder;
};

TEST_F(MultiCamSelfCal, IsReadAsWritten) {
  const Recording recording = readRecording(folder.path());
  ASSERT_EQ(recording.cameras.size(), 2u);
  EXPECT_EQ(recording.cameras[0].name, "left");
  EXPECT_EQ(recording.cameras[1].name, "camera_2nd_camera");
  const geometry::Intrinsics& lens = recording.cameras[1].intrinsics;
  EXPECT_EQ(lens.width, 656);
  EXPECT_EQ(lens.height, 491);
  EXPECT_EQ(lens.fx, 400.5);
  EXPECT_EQ(lens.fy, 401.5);
  EXPECT_EQ(lens.cx, 320.25);
  EXPECT_EQ(lens.cy, 240.75);
  const std::array<double, 5> distortion = {-0.28, 0.07, 0.0004, -0.0001, 0.0};
  EXPECT_EQ(lens.distortion, distortion);
  EXPECT_FALSE(recording.cameras[0].projection);
  EXPECT_FALSE(recording.cameras[0].center);
  EXPECT_TRUE(recording.points.empty());
}

TEST_F(MultiCamSelfCal, UnseenIsNanOrZeroOrMarkedInIdMat) {
  const Recording recording = readRecording(folder.path());
  ASSERT_EQ(recording.frames.size(), 4u);
  EXPECT_EQ(*recording.frames[0][0], Eigen::Vector2d(1.5, 11.5));
  EXPECT_EQ(*recording.frames[0][1], Eigen::Vector2d(3.5, 13.5));
  EXPECT_EQ(*recording.frames[1][0], Eigen::Vector2d(2.5, 12.5));
  EXPECT_FALSE(recording.frames[1][1]);  // weight 0
  EXPECT_FALSE(recording.frames[2][0]);  // NaN
  EXPECT_TRUE(recording.frames[2][1]);
  EXPECT_FALSE(recording.frames[3][0]);  // pixel 0, 0
  EXPECT_FALSE(recording.frames[3][1]);  // IdMat
}

TEST_F(MultiCamSelfCal, WorksWithoutTheOptionalFiles) {
  folder.remove("IdMat.dat");
  folder.remove("camera_order.txt");
  const Recording recording = readRecording(folder.path());
  EXPECT_EQ(recording.cameras[1].name, "camera_2");
  EXPECT_TRUE(recording.frames[3][1]);
}

TEST_F(MultiCamSelfCal, UnitsScaleTheCentres) {
  folder.write("original_cam_centers.dat", "100 200 300\n400 500 600\n");
  EXPECT_EQ(*readRecording(folder.path()).cameras[1].center, Eigen::Vector3d(400, 500, 600));
  folder.write("calibration_units.txt", "millimeters\n");
  EXPECT_TRUE(readRecording(folder.path())
                  .cameras[1]
                  .center->isApprox(Eigen::Vector3d(0.4, 0.5, 0.6), 1e-15));
  folder.write("calibration_units.txt", "furlongs\n");
  expectRefusal("calibration_units.txt must hold one word");
}

TEST_F(MultiCamSelfCal, HeadersOfOctaveAreSkipped) {
  folder.write("original_cam_centers.dat",
               "# Created by Octave 3.2.4\n# name: centres\n# type: matrix\n# rows: 2\n"
               "# columns: 3\n 100 200 300\n 400 500 600\n\n");
  EXPECT_EQ(*readRecording(folder.path()).cameras[1].center, Eigen::Vector3d(400, 500, 600));
}

TEST_F(MultiCamSelfCal, AMissingFileIsNamed) {
  folder.remove("basename2.rad");
  expectRefusal("basename2.rad is missing");
  folder.remove("points.dat");
  folder.write("basename2.rad", kLens);
  expectRefusal("holds neither points.dat nor cam1.points4cal.dat");
  folder.remove("Res.dat");
  expectRefusal("Res.dat is missing");
}

/// The lens with other words in place of some.
std::string lensWith(const std::string& words, const std::string& others) {
  std::string text = kLens;
  return text.replace(text.find(words), words.size(), others);
}

TEST_F(MultiCamSelfCal, MistakesAreNamedByFileAndPlace) {
  struct Mistake {
    const char* file;
    std::string text;
    const char* refusal;
  };
  const Mistake mistakes[] = {
      {"Res.dat", "640 480\n656 -1\n", "Res.dat row 2 must hold the width and height"},
      {"camera_order.txt", "only_one\n", "camera_order.txt names 1 cameras"},
      {"camera_order.txt", "same\nsame\n", "camera_order.txt names a camera twice"},
      {"points.dat", "1 2 3 4\n1 2 3 4\n1 1 1 1\n", "points.dat has 3 rows, but must have 6"},
      {"points.dat", "1 2\n1 2\n1 1\n3 x4\n3 4\n1 1\n",
       "points.dat line 4 column 2: 'x4' is not a number"},
      {"points.dat", "1 2\n1 2\n1 1\n3 4\n3 inf\n1 1\n",
       "points.dat line 5 column 2: 'inf' is not a finite number"},
      {"points.dat", "1 2\n1 2\n1 1\n3 4\n3\n1 1\n",
       "points.dat line 5 has 1 column, but the first has 2"},
      {"points.dat", "1 2 3 4\n1 2 3 4\n1 1 1 1\n3 4 5 6\n3 4 5 6\n1 0.5 1 1\n",
       "points.dat row 6 column 2 must be 1, 0 or NaN"},
      {"points.dat", "\n", "points.dat is empty"},
      {"IdMat.dat", "1 1 0\n1 1 1\n", "IdMat.dat has 3 columns, but must have 4"},
      {"basename1.rad", "K11 = four\n", "basename1.rad K11: 'four' is not a number"},
      {"basename1.rad", "K11 400\n", "basename1.rad: 'K11 400' is not of the form key = number"},
      {"basename1.rad", lensWith("kc4 = -0.0001\n", ""), "basename1.rad lacks kc4"},
      {"basename1.rad", lensWith("K12 = 0.0", "K12 = 0.5"), "basename1.rad: K12 must be 0"},
      {"basename1.rad", lensWith("K11 = 400.5", "K11 = -400."), "basename1.rad: "},
  };
  for (const Mistake& mistake : mistakes) {
    writeFiles();
    folder.write(mistake.file, mistake.text);
    expectRefusal(mistake.refusal);
  }
}

/// Two cameras in flydra's layout; camera 2 misses a point and sees one that camera 1 does not.
class Flydra : public MultiCamSelfCal {
 protected:
  Flydra() {
    folder.remove("points.dat");
    folder.remove("IdMat.dat");
    folder.write("cam1.points4cal.dat", "1 2 3 1 10 20 1\n4 5 6 1 11 21 1\n7 8 9 1 12 22 1\n");
    folder.write("cam2.points4cal.dat", "1 2 3 1 30 40 1\n5 5 5 1 31 41 1\n7 8 9 1 32 42 1\n");
    folder.write("Pmatrices.dat",
                 "1 2 3 4\n5 6 7 8\n9 10 11 12\n21 22 23 24\n25 26 27 28\n29 30 31 32\n");
    folder.write("calibration_units.txt", "centimeters\n");
  }
};

TEST_F(Flydra, RowsOfOnePointMakeAFrame) {
  const Recording recording = readRecording(folder.path());
  ASSERT_EQ(recording.frames.size(), 4u);
  ASSERT_EQ(recording.points.size(), 4u);
  // In the order of both files.
  EXPECT_TRUE(recording.points[0].isApprox(Eigen::Vector3d(0.01, 0.02, 0.03), 1e-15));
  EXPECT_EQ(*recording.frames[0][0], Eigen::Vector2d(10, 20));
  EXPECT_EQ(*recording.frames[0][1], Eigen::Vector2d(30, 40));
  EXPECT_TRUE(recording.points[1].isApprox(Eigen::Vector3d(0.05, 0.05, 0.05), 1e-15));
  EXPECT_FALSE(recording.frames[1][0]);
  EXPECT_EQ(*recording.frames[1][1], Eigen::Vector2d(31, 41));
  EXPECT_EQ(*recording.frames[2][0], Eigen::Vector2d(11, 21));
  EXPECT_FALSE(recording.frames[2][1]);
  EXPECT_EQ(*recording.frames[3][1], Eigen::Vector2d(32, 42));
}

TEST_F(Flydra, MatricesBelongToTheirCameras) {
  const Recording recording = readRecording(folder.path());
  EXPECT_EQ((*recording.cameras[0].projection)(1, 3), 8.0);
  EXPECT_EQ((*recording.cameras[1].projection)(2, 0), 29.0);
}

TEST_F(Flydra, BadFilesAreNamed) {
  folder.write("Pmatrices.dat", "1 2 3 4\n5 6 7 8\n9 10 11 12\n");
  expectRefusal("Pmatrices.dat has 3 rows, but must have 6");
  folder.remove("Pmatrices.dat");
  folder.write("cam2.points4cal.dat", "1 2 3 1 30 40 1\n5 5 5 1 31 41 0\n");
  expectRefusal("cam2.points4cal.dat row 2 must have 1 in the columns 4 and 7");
  // Headers are no rows.
  folder.write("cam2.points4cal.dat", "# rows: 2\n\n1 2 3 1 30 40 1\n5 5 5 1 31 41 0\n");
  expectRefusal("cam2.points4cal.dat row 2 must have 1 in the columns 4 and 7");
  folder.write("cam2.points4cal.dat", "1 2 3 1 30 NaN 1\n");
  expectRefusal("cam2.points4cal.dat must not hold NaN");
  folder.remove("cam2.points4cal.dat");
  expectRefusal("cam2.points4cal.dat is missing");
}

}  // namespace
}  // namespace wiimote_tracker::import
