// What a benchmark writes into its JSON file and its document.

#include "wiimote_tracker_msgs/benchmark_tables.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace wiimote_tracker {
namespace {

std::string contentOf(const std::string& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

class BenchmarkTablesTest : public testing::Test {
 protected:
  void TearDown() override {
    std::remove(json_.c_str());
    std::remove(document_.c_str());
  }

  /// A benchmark with one section of two tables. @returns its exit status.
  int run(const std::string& document) {
    BenchmarkTables tables;
    ArgumentParser parser("benchmark", "measures");
    tables.addOptions(&parser);
    std::vector<std::string> words = {"benchmark", "--json", json_, "--document", document};
    std::vector<char*> arguments;
    for (std::string& word : words)
      arguments.push_back(word.data());
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int status = parser.run(static_cast<int>(arguments.size()), arguments.data(), [&] {
      tables.begin("speed", "Of two cars.", "rosrun cars benchmark");
      tables.add({"red", {{"km/h", 12345.6}, {"sd", std::nan("")}}});
      tables.add({"blue", {{"km/h", 0.25}, {"sd", 2.0}}, "broken"});
      tables.add({"both", {{"sum", 3.0}}});
      tables.write();
      return 0;
    });
    printed_ = testing::internal::GetCapturedStdout();
    refusal_ = testing::internal::GetCapturedStderr();
    return status;
  }

  std::string written(const std::string& content) {
    std::ofstream(document_) << content;
    EXPECT_EQ(0, run(document_)) << refusal_;
    return contentOf(document_);
  }

  const std::string path_ = testing::TempDir() + "benchmark_tables_" + std::to_string(::getpid());
  const std::string json_ = path_ + ".json";
  const std::string document_ = path_ + ".md";
  const std::string table_ =
      "<!-- speed: begin -->\n"
      "## speed\n\n"
      "Of two cars.\n\n"
      "||km/h|sd||\n|---|---|---|---|\n"
      "|red|12346|||\n"
      "|blue|0.25|2|broken|\n\n"
      "||sum||\n|---|---|---|\n"
      "|both|3||\n\n"
      "By `rosrun cars benchmark`.\n"
      "<!-- speed: end -->\n";
  std::string printed_, refusal_;
};

TEST_F(BenchmarkTablesTest, ReplaceTheOldTableInTheDocument) {
  EXPECT_EQ(
      "# Cars\n\n" + table_ + "\nOn a road.\n",
      written("# Cars\n\n<!-- speed: begin -->\n| old |\n<!-- speed: end -->\n\nOn a road.\n"));
  EXPECT_EQ("# Cars\n\n" + table_ + "\nOn a road.\n", written(contentOf(document_)));
}

TEST_F(BenchmarkTablesTest, StandAtTheEndOfADocumentWithoutMarks) {
  EXPECT_EQ("# Cars\n\n" + table_, written("# Cars\n"));
}

TEST_F(BenchmarkTablesTest, AreJsonWithAllDigits) {
  written("");
  EXPECT_EQ(
      "{\n \"speed\": [\n"
      "  {\"name\": \"red\", \"km/h\": 12345.6, \"sd\": null},\n"
      "  {\"name\": \"blue\", \"km/h\": 0.25, \"sd\": 2},\n"
      "  {\"name\": \"both\", \"sum\": 3}\n"
      " ]\n}\n",
      contentOf(json_));
}

TEST_F(BenchmarkTablesTest, ArePrintedWithAHeadForEachSetOfColumns) {
  written("");
  const std::size_t first = printed_.find("km/h");
  EXPECT_NE(std::string::npos, first);
  EXPECT_EQ(std::string::npos, printed_.find("km/h", first + 1));
  EXPECT_NE(std::string::npos, printed_.find("sum"));
}

TEST_F(BenchmarkTablesTest, RefuseADocumentThatCannotBeReadOrHasHalfOfTheMarks) {
  EXPECT_EQ(1, run(testing::TempDir() + "no/such/file.md"));
  EXPECT_NE(std::string::npos, refusal_.find("no/such/file.md cannot be written"));
  for (const char* half :
       {"<!-- speed: begin -->\n", "<!-- speed: end -->\n<!-- speed: begin -->\n"}) {
    std::ofstream(document_) << half;
    EXPECT_EQ(1, run(document_));
    EXPECT_NE(std::string::npos, refusal_.find("write the line '<!-- speed: begin -->' before"));
    EXPECT_EQ(half, contentOf(document_));
  }
}

}  // namespace
}  // namespace wiimote_tracker
