// Tables of measurements: numbers survive bit for bit, files are complete or absent, errors are
// reported. test_track_bag.py reads the MATLAB file with other programs. More than 400 lines,
// because all formats are compared on the same measurements.
#include "german_locale.h"
#include "ros/measurements/writer.h"
#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <locale>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker::measurements {
namespace {

namespace fs = std::filesystem;
using wiimote_tracker_msgs::TrackedPoint;
using wiimote_tracker_msgs::TrackedPointArray;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::string contentOf(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// A line's cells; the quotes of RFC 4180 are undone.
std::vector<std::string> cellsOf(const std::string& line) {
  std::vector<std::string> cells(1);
  bool is_quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && is_quoted && i + 1 < line.size() && line[i + 1] == '"')
      cells.back() += line[i++];
    else if (line[i] == '"')
      is_quoted = !is_quoted;
    else if (line[i] == ',' && !is_quoted)
      cells.emplace_back();
    else
      cells.back() += line[i];
  }
  return cells;
}

/// 0 is not -0.
bool isSame(double a, double b) {
  return a == b && std::signbit(a) == std::signbit(b);
}

class WriterTest : public testing::Test {
 protected:
  WriterTest() {
    std::string name = (fs::temp_directory_path() / "test_writer_XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~WriterTest() override { fs::remove_all(folder_); }

  static TrackedPointArray measurement() {
    TrackedPointArray m;
    m.header.stamp.fromNSec(1700000000123456789);
    m.header.frame_id = "world";
    m.rig_id = "0123456789abcdef";
    m.method = "track";
    m.points.resize(1);
    TrackedPoint& led = m.points[0];
    led.id = 4294967295u;
    led.label = "led";
    led.label_confidence = 0.75f;
    led.label_since.fromNSec(1700000000000000002);
    led.state = TrackedPoint::TRACKED;
    setVector({0.1, -2.0 / 3.0, 1e-300}, &led.position);
    setVector(Eigen::Vector3d::Constant(kNaN), &led.velocity);
    led.position_covariance = {1e-6, 2e-7, 3e-7, 2e-7, 4e-6, 5e-7, 3e-7, 5e-7, 6e-6};
    led.velocity_covariance.fill(kNaN);
    led.rays_used = 3;
    led.rays_possible = 4;
    led.residual = 0.3;
    led.last_observed.fromNSec(1700000000003000001);
    led.age = 12.5;
    led.remapped = true;
    return m;
  }

  /// Cells of the rows, without the header.
  std::vector<std::vector<std::string>> written(
      const std::vector<TrackedPointArray>& measurements) {
    const fs::path path = folder_ / "out.csv";
    const auto writer = makeCsvWriter(path.string());
    for (const TrackedPointArray& m : measurements)
      writer->addAll(m, false);
    writer->finish();
    std::istringstream stream(contentOf(path));
    std::string line;
    std::vector<std::vector<std::string>> rows;
    while (std::getline(stream, line))
      rows.push_back(cellsOf(line));
    header_ = rows.at(0);
    rows.erase(rows.begin());
    return rows;
  }

  fs::path folder_;
  std::vector<std::string> header_;
};

TEST_F(WriterTest, CsvHoldsEveryFieldUnderItsNameAndUnit) {
  const auto rows = written({measurement()});
  ASSERT_EQ(1u, rows.size());
  const std::vector<std::string>& row = rows[0];
  ASSERT_EQ(header_.size(), row.size());
  const auto cell = [&](const std::string& name) {
    for (std::size_t i = 0; i < header_.size(); ++i) {
      if (header_[i] == name)
        return row[i];
    }
    return "no column " + name;
  };
  EXPECT_EQ("1700000000.123456789", cell("time [s]"));
  EXPECT_EQ("0", cell("triggered"));
  EXPECT_EQ("4294967295", cell("id"));
  EXPECT_EQ("led", cell("label"));
  EXPECT_EQ("0.75", cell("label_confidence"));
  EXPECT_EQ("1700000000.000000002", cell("label_since [s]"));
  EXPECT_EQ("tracked", cell("state"));
  EXPECT_EQ(0.1, std::stod(cell("x [m]")));
  EXPECT_EQ(-2.0 / 3.0, std::stod(cell("y [m]")));
  EXPECT_EQ(1e-300, std::stod(cell("z [m]")));
  EXPECT_EQ("nan", cell("vy [m/s]"));
  EXPECT_EQ(3e-7, std::stod(cell("cov_xz [m^2]")));
  EXPECT_EQ(5e-7, std::stod(cell("cov_yz [m^2]")));
  EXPECT_EQ(6e-6, std::stod(cell("cov_zz [m^2]")));
  EXPECT_EQ("nan", cell("vcov_xx [m^2/s^2]"));
  EXPECT_EQ("3", cell("rays_used"));
  EXPECT_EQ("4", cell("rays_possible"));
  EXPECT_EQ(0.3, std::stod(cell("residual [px]")));
  EXPECT_EQ("1700000000.003000001", cell("last_observed [s]"));
  EXPECT_EQ("12.5", cell("age [s]"));
  EXPECT_EQ("1", cell("remapped"));
  EXPECT_EQ("world", cell("frame"));
  EXPECT_EQ("0123456789abcdef", cell("rig_id"));
  EXPECT_EQ("track", cell("method"));
}

TEST_F(WriterTest, CsvGivesNumbersBackBitForBit) {
  std::mt19937_64 random(3);
  std::vector<TrackedPointArray> measurements;
  while (measurements.size() < 500) {
    TrackedPointArray m = measurement();
    Eigen::Vector3d position;
    for (int i = 0; i < 3; ++i) {
      const std::uint64_t bits = random();
      std::memcpy(&position[i], &bits, sizeof bits);
    }
    setVector(position, &m.points[0].position);
    if (position.allFinite())
      measurements.push_back(m);
  }
  setVector({-0.0, std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::max()},
            &measurements[0].points[0].position);
  const auto rows = written(measurements);
  ASSERT_EQ(measurements.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::string& cell = rows[i][7 + axis];
      EXPECT_TRUE(isSame(vectorOf(measurements[i].points[0].position)[axis],
                         std::strtod(cell.c_str(), nullptr)))
          << cell;
    }
  }
}

/// As of a German locale, which need not be installed.
class DecimalCommas : public std::numpunct<char> {
 protected:
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

void expectPoints(const std::vector<std::string>& row) {
  EXPECT_EQ("1700000000.123456789", row.at(0));
  EXPECT_EQ("4294967295", row.at(2));
  EXPECT_EQ("0.10000000000000001", row.at(7));
}

TEST_F(WriterTest, CsvIgnoresTheLocaleOfStreams) {
  const std::locale before =
      std::locale::global(std::locale(std::locale::classic(), new DecimalCommas));
  const auto rows = written({measurement()});
  std::locale::global(before);
  ASSERT_EQ(header_.size(), rows.at(0).size());
  expectPoints(rows[0]);
}

TEST_F(WriterTest, CsvIgnoresTheLocaleOfPrintf) {
  const GermanLocale german;
  if (!german.isSet())
    GTEST_SKIP() << GermanLocale::kMissing;
  expectPoints(written({measurement()}).at(0));
}

TEST_F(WriterTest, CsvQuotesWordsWithCommas) {
  TrackedPointArray m = measurement();
  m.points[0].label = "left, \"upper\"";
  EXPECT_EQ(m.points[0].label, written({m}).at(0).at(3));
}

TEST_F(WriterTest, CsvSaysNanOfALabelThatWasNotIdentified) {
  TrackedPointArray m = measurement();
  m.points[0].label_confidence = std::numeric_limits<float>::quiet_NaN();
  m.points[0].label_since = ros::Time();
  const auto row = written({m}).at(0);
  EXPECT_EQ("nan", row.at(4));
  EXPECT_EQ("nan", row.at(5));
}

TEST_F(WriterTest, NeverSaysMinusNan) {
  TrackedPointArray m = measurement();
  m.points[0].residual = -kNaN;
  EXPECT_EQ("nan", written({m}).at(0).at(27));
}

TEST_F(WriterTest, TheFileGetsItsNameWhenComplete) {
  const fs::path path = folder_ / "new folder" / "out.csv";
  {
    const auto writer = makeCsvWriter(path.string());
    writer->addAll(measurement(), false);
    writer->flush();
    EXPECT_FALSE(fs::exists(path));
    EXPECT_NE(std::string::npos, contentOf(path.string() + ".part").find("4294967295"))
        << "a crash now would lose nothing";
    writer->finish();
  }
  EXPECT_TRUE(fs::exists(path));
  EXPECT_FALSE(fs::exists(path.string() + ".part"));
  const std::string first = contentOf(path);
  makeCsvWriter(path.string())->finish();
  EXPECT_EQ(first, contentOf(path.string() + ".bak"));
  EXPECT_LT(contentOf(path).size(), first.size());
}

TEST_F(WriterTest, KeepsWhatCrashedProgramsLeft) {
  const std::string path = (folder_ / "out.csv").string();
  for (const char* rows : {"first", "second", ""}) {
    std::ofstream(path + ".part") << rows;
    makeCsvWriter(path)->finish();
  }
  EXPECT_EQ("first", contentOf(path + ".part.bak"));
  EXPECT_EQ("second", contentOf(path + ".part.bak2"));
  EXPECT_FALSE(fs::exists(path + ".part.bak3")) << "nothing is lost with an empty one";
}

TEST_F(WriterTest, BodiesHaveACsvOfTheirOwn) {
  const std::string path = (folder_ / "out.csv").string();
  makeCsvWriter(path)->finish();
  EXPECT_FALSE(fs::exists(csvOfBodies(path))) << "there are none";
  const auto writer = makeCsvWriter(path);
  wiimote_tracker_msgs::TrackedBodyArray message;
  writer->addBodies(message);
  message.header.stamp.fromNSec(1700000000123456789);
  message.bodies.resize(1);
  message.bodies[0].name = "wand, left";
  message.bodies[0].state = wiimote_tracker_msgs::TrackedBody::PREDICTED;
  message.bodies[0].pose.pose.orientation.w = 1.0;
  message.bodies[0].pose.covariance[3] = message.bodies[0].pose.covariance[18] = 1e-7;
  message.bodies[0].twist.covariance[35] = 0.1;
  writer->addBodies(message);
  writer->finish();
  EXPECT_EQ(csvOfBodies(path), (folder_ / "out_bodies.csv").string());
  std::istringstream stream(contentOf(csvOfBodies(path)));
  std::string line;
  std::getline(stream, line);
  const std::vector<std::string> columns = cellsOf(line);
  std::getline(stream, line);
  const std::vector<std::string> row = cellsOf(line);
  ASSERT_EQ(columns.size(), row.size());
  const auto cell = [&](const std::string& name) {
    const auto column = std::find(columns.begin(), columns.end(), name);
    return column == columns.end() ? "no column " + name : row[column - columns.begin()];
  };
  EXPECT_EQ("1700000000.123456789", cell("time [s]"));
  EXPECT_EQ("wand, left", cell("body"));
  EXPECT_EQ("predicted", cell("state"));
  EXPECT_EQ("1", cell("qw"));
  EXPECT_EQ(1e-7, std::stod(cell("cov_xrx [m*rad]")));
  EXPECT_EQ(0.1, std::stod(cell("vcov_rzrz [rad^2/s^2]")));
  EXPECT_FALSE(std::getline(stream, line));
}

TEST_F(WriterTest, TwoTablesAreNotTheSameFile) {
  std::ofstream(folder_ / "old.csv") << "old";
  fs::create_symlink(folder_ / "old.csv", folder_ / "link");
  for (const auto& [csv, trc] : {std::pair("out", "out"),
                                 {"out", "./out"},
                                 {"old.csv", "link"},
                                 {"o.csv", "o_bodies.csv"}}) {
    OutputNames files;
    files.csv = (folder_ / csv).string();
    files.trc = (folder_ / trc).string();
    try {
      makeWriters(files);
      ADD_FAILURE() << csv << " " << trc;
    } catch (const Error& e) {
      EXPECT_NE(std::string::npos, std::string(e.what()).find("write to another one")) << e.what();
    }
  }
  EXPECT_EQ("old", contentOf(folder_ / "old.csv"));
  EXPECT_EQ(2, std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
}

TEST_F(WriterTest, AdvisesWhenItCannotWrite) {
  std::ofstream(folder_ / "file").put('x');
  for (const fs::path& path : {folder_ / "file" / "out", folder_}) {
    for (const auto make : {makeCsvWriter, makeMatlabWriter}) {
      try {
        make(path.string());
        ADD_FAILURE() << path;
      } catch (const Error& e) {
        EXPECT_NE(std::string::npos, std::string(e.what()).find(path.string())) << e.what();
      }
    }
  }
  if (fs::exists("/dev/full")) {
    fs::create_symlink("/dev/full", folder_ / "full.csv.part");
    try {
      const auto writer = makeCsvWriter((folder_ / "full.csv").string());
      writer->addAll(measurement(), false);
      writer->finish();
      ADD_FAILURE();
    } catch (const Error& e) {
      EXPECT_NE(std::string::npos, std::string(e.what()).find("make room")) << e.what();
    }
    EXPECT_FALSE(fs::exists(folder_ / "full.csv"));
  }
}

/// Whether the program was built with matio.
bool hasMatlab(const fs::path& folder) {
  try {
    makeMatlabWriter((folder / "some.mat").string());
  } catch (const Error& e) {
    return std::string(e.what()).find("built without matio") == std::string::npos;
  }
  return true;
}

TEST_F(WriterTest, EqualMeasurementsGiveEqualMatlabFiles) {
  if (!hasMatlab(folder_))
    GTEST_SKIP() << "built without matio";
  for (const char* name : {"a.mat", "b.mat"}) {
    const auto writer = makeMatlabWriter((folder_ / name).string());
    for (int i = 0; i < 100; ++i)
      writer->addAll(measurement(), false);
    writer->finish();
  }
  const std::string content = contentOf(folder_ / "a.mat");
  EXPECT_EQ(content, contentOf(folder_ / "b.mat"));
  EXPECT_EQ(0u, content.find("MATLAB 5.0 MAT-file"));
}

TEST_F(WriterTest, AMatlabFileThatDoesNotFitOnTheDiskIsRefused) {
  if (!hasMatlab(folder_))
    GTEST_SKIP() << "built without matio";
  ::signal(SIGXFSZ, SIG_IGN);
  rlimit before;
  ASSERT_EQ(0, ::getrlimit(RLIMIT_FSIZE, &before));
  for (const rlim_t left : {20000, 500, 0}) {
    const auto writer = makeMatlabWriter((folder_ / "cut.mat").string());
    TrackedPointArray measured = measurement();
    for (int i = 0; i < 5000; ++i) {
      measured.points[0].position.x = std::sin(i);
      writer->addAll(measured, false);
    }
    rlimit tight = before;
    tight.rlim_cur = left;
    ASSERT_EQ(0, ::setrlimit(RLIMIT_FSIZE, &tight));
    std::string refusal;
    try {
      writer->finish();
    } catch (const Error& e) {
      refusal = e.what();
    }
    ASSERT_EQ(0, ::setrlimit(RLIMIT_FSIZE, &before));
    EXPECT_NE(std::string::npos, refusal.find("make room there")) << left << ": " << refusal;
    EXPECT_FALSE(fs::exists(folder_ / "cut.mat"));
  }
}

TEST_F(WriterTest, AMatlabFileMayBeEmpty) {
  if (!hasMatlab(folder_))
    GTEST_SKIP() << "built without matio";
  makeMatlabWriter((folder_ / "empty.mat").string())->finish();
  EXPECT_GT(fs::file_size(folder_ / "empty.mat"), 128u);
}

}  // namespace
}  // namespace wiimote_tracker::measurements
