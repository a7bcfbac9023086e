#include "gesture_tool/baselines.h"
#include "gesture_tool/dataset.h"
#include "gesture_tool/evaluate.h"
#include "gesture_tool/report.h"
#include "refusal_of.h"
#include "wiimote_tracker_triangulation/geometry/error.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

namespace wiimote_tracker::gesture_tool {
namespace {

namespace fs = std::filesystem;

/// A folder of its own for each test.
class GestureTool : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + "_" +
               std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& file, const std::string& content) {
    fs::create_directories((folder_ / file).parent_path());
    std::ofstream(folder_ / file) << content;
  }

  std::string messageOf(const std::string& folder) {
    return refusalOf([&] { readPeople((folder_ / folder).string()); });
  }

  fs::path folder_;
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A stroke whose bends depend on `kind`, with small deviations by person.
gesture::Path stroke(unsigned kind, unsigned person) {
  std::mt19937 kinds(kind);
  std::mt19937 hands(1000 * person + kind);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Eigen::Matrix3d waves;
  Eigen::Matrix3d phases;
  for (int i = 0; i < 9; ++i) {
    waves(i) = uniform(kinds) + 0.1 * uniform(hands);
    phases(i) = M_PI * uniform(kinds) + 0.2 * uniform(hands);
  }
  gesture::Path path;
  for (int i = 0; i < 120; ++i) {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      for (int wave = 0; wave < 3; ++wave)
        position(axis) +=
            100.0 * waves(axis, wave) * std::sin(0.02 * (wave + 1) * i + phases(axis, wave));
    }
    path.push_back({i / 60.0, position});
  }
  return path;
}

std::vector<Person> people(unsigned count) {
  std::vector<Person> people;
  for (unsigned p = 0; p < count; ++p) {
    people.push_back({"/people/" + std::to_string(p), {}});
    for (unsigned kind = 0; kind < 12; ++kind)
      people.back().samples.push_back({"kind " + std::to_string(10 + kind), stroke(kind, p)});
  }
  return people;
}

gesture::RecognizerOptions anyLength() {
  gesture::RecognizerOptions options;
  options.shape.minimum_length = 0.0;
  return options;
}

TEST_F(GestureTool, ReadsAFolderPerPersonAndAFilePerGesture) {
  write("b/circle.csv", "1 2 3 1409586036818\n4 5 6 1409586036835\n");
  write("a/v.csv", "x,y,z,t_ms\n1.5,-2,3e1,1000\r\n\n2,3,4,1017\r\n");
  write("a/notes.txt", "not a gesture");
  const std::vector<Person> read = readPeople(folder_.string());
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[0].folder, fs::canonical(folder_ / "a").string());
  ASSERT_EQ(read[0].samples.size(), 1u);
  EXPECT_EQ(read[0].samples[0].gesture, "v");
  EXPECT_EQ(read[0].samples[0].path[0].position, Eigen::Vector3d(1.5, -2.0, 30.0));
  EXPECT_NEAR(read[0].samples[0].path[1].time, 0.017, 1e-12);
  EXPECT_NEAR(read[1].samples[0].path[1].time, 0.017, 1e-12);
}

TEST_F(GestureTool, SaysWhatIsWrongWithTheFiles) {
  EXPECT_TRUE(contains(messageOf("absent"), "is not a folder"));
  write("empty/a/readme.txt", "");
  EXPECT_TRUE(contains(messageOf("empty"), "holds no gesture"));
  write("short/a/v.csv", "1 2 3\n");
  EXPECT_TRUE(contains(messageOf("short"), "no row of 4 numbers"));
  write("broken/a/v.csv", "1 2 3 4\n1 2 x 5\n");
  EXPECT_TRUE(contains(messageOf("broken"), "v.csv, line 2"));
}

TEST_F(GestureTool, APersonsOwnExamplesAreExcluded) {
  const Evaluation evaluation = evaluate(people(5), people(5), 0, anyLength());
  EXPECT_EQ(evaluation.tested, 60u);
  EXPECT_EQ(evaluation.examples, 48u);
  EXPECT_EQ(evaluation.gestures.size(), 12u);
  std::size_t cells = 0;
  std::size_t diagonal = 0;
  for (std::size_t i = 0; i < 12; ++i) {
    diagonal += evaluation.confusion[i][i];
    for (const std::size_t count : evaluation.confusion[i])
      cells += count;
  }
  EXPECT_EQ(cells, 60u);
  EXPECT_EQ(diagonal, evaluation.right);
  EXPECT_GE(evaluation.right, 57u);
  EXPECT_GE(evaluation.unknown_rejected, 30u);
  EXPECT_LE(evaluation.rejected, 12u);

  EXPECT_EQ(evaluate(people(5), people(5), 1, anyLength()).examples, 12u);
  EXPECT_THROW(evaluate(people(1), people(1), 0, anyLength()), Error);
}

TEST_F(GestureTool, AGestureWithoutExamplesCountsAsWrong) {
  std::vector<Person> teachers = people(3);
  for (Person& teacher : teachers)
    teacher.samples.erase(teacher.samples.begin());
  std::vector<Person> pupils = people(4);
  pupils.erase(pupils.begin(), pupils.begin() + 3);
  const Evaluation evaluation = evaluate(teachers, pupils, 0, anyLength());
  EXPECT_EQ(evaluation.tested, 12u);
  EXPECT_EQ(evaluation.confusion[0][0], 0u);
  EXPECT_LE(evaluation.right, 11u);
}

TEST_F(GestureTool, JsonHoldsAccuracyAndConfusion) {
  const Evaluation evaluation = evaluate(people(3), people(3), 0, anyLength());
  const std::string file = (folder_ / "out.json").string();
  writeJson(file, evaluation, FalseAlarms{2.0, 3, 4});
  const YAML::Node json = YAML::LoadFile(file);  // JSON is YAML
  EXPECT_DOUBLE_EQ(json["accuracy"].as<double>(), evaluation.right / 36.0);
  EXPECT_EQ(json["confusion"].as<std::vector<std::vector<std::size_t>>>(), evaluation.confusion);
  EXPECT_EQ(json["gestures"].as<std::vector<std::string>>(), evaluation.gestures);
  EXPECT_EQ(json["others"].size(), 2u);
  EXPECT_EQ(json["false_alarms_continuous"].as<int>(), 3);
}

TEST(Baselines, APointCloudHasNoOrder) {
  gesture::Path path = stroke(3, 0);
  const Cloud cloud = cloudOf(path);
  Cloud reversed = cloud;
  std::reverse(reversed.begin(), reversed.end());
  EXPECT_EQ(pointCloudDistance(cloud, cloud), 0.0);
  EXPECT_EQ(pointCloudDistance(cloud, reversed), 0.0);
  EXPECT_GT(timeWarpingDistance(cloud, reversed), 1.0);
}

TEST(Baselines, TimeWarpingForgivesAPause) {
  Cloud even;
  Cloud paused;
  for (std::size_t i = 0; i < even.size(); ++i) {
    even[i] = Eigen::Vector3d(static_cast<double>(i), 0.0, 0.0);
    paused[i] = even[i < 10 ? i : std::max<std::size_t>(10, i - 5)];
  }
  // What is left over is the end that `paused` never reaches: 5 points, 1 to 5 away.
  EXPECT_DOUBLE_EQ(timeWarpingDistance(even, paused), 1.0 + 2.0 + 3.0 + 4.0 + 5.0);
}

TEST(Baselines, ACloudHasUnitSize) {
  const Cloud cloud = cloudOf(stroke(5, 2));
  Eigen::Array3d low = cloud[0];
  Eigen::Array3d high = cloud[0];
  for (const Eigen::Vector3d& point : cloud) {
    low = low.min(point.array());
    high = high.max(point.array());
  }
  EXPECT_NEAR((high - low).maxCoeff(), 1.0, 1e-12);
  EXPECT_THROW(cloudOf(gesture::Path(9, {0.0, {1.0, 1.0, 1.0}})), Error);
}

}  // namespace
}  // namespace wiimote_tracker::gesture_tool
