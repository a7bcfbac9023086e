// The check of parameter files takes a file that is right, and finds each kind of mistake.
#include <documented_parameters.h>
#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

namespace wiimote_tracker {
namespace {

const char* const kRight = R"(# Of all.

# Place of the LED
# [m, -1..2.5].
place: 0.5

# How it moves [still, fast].
motion: still

# Their names.
names: [a, b]

# Limits of time and angle
limits:
  # Number of images [1, 0..100000].
  images: 7
  # Shortest time [s, 1e-3..longest]. 0.001 is much.
  shortest: 1.0e-1

  # Longest time [s, 0.001..1e4].
  longest: 4
  # Largest angle [rad, -2 pi..2 pi].
  angle: 0.0
)";

ParameterReader readAll() {
  XmlRpc::XmlRpcValue nothing;
  nothing.begin();  // a struct without members
  ParameterReader reader(ParameterTree("parameters", nothing));
  reader.bounded("place", 0.5, -1.0, 2.5);
  reader.choice("motion", "still", {"still", "fast"});
  reader.optional<std::vector<std::string>>("names", {"a", "b"});
  reader.bounded("limits/images", 7, 0, 100000);
  reader.bounded("limits/shortest", 0.1, 0.001, 4.0);
  reader.bounded("limits/longest", 4.0, 0.001, 1e4);
  reader.bounded("limits/angle", 0.0, -2.0 * M_PI, 2.0 * M_PI);
  return reader;
}

void check(const std::string& text, const ParameterReader& reader = readAll()) {
  const std::string path = testing::TempDir() + "documented_" + std::to_string(::getpid());
  std::ofstream(path) << text;
  expectDocumented(reader, path);
  std::remove(path.c_str());
}

/// The file that is right, but for one place.
void checkWith(const std::string& wrong, const std::string& right) {
  std::string text = kRight;
  text.replace(text.find(right), right.size(), wrong);
  check(text);
}

TEST(DocumentedParameters, AreTaken) {
  check(kRight);
}

TEST(DocumentedParameters, AreAllInTheFileAndNoOthers) {
  EXPECT_NONFATAL_FAILURE(checkWith("", "  angle: 0.0\n"), "limits/angle is not in");
  EXPECT_NONFATAL_FAILURE(checkWith("motion: still\n\n# More.\nmore: 1", "motion: still"),
                          "more in");
  EXPECT_NONFATAL_FAILURE(
      checkWith("angle: 0.0\n  # Again [rad, -2 pi..2 pi].\n  angle: 0.0", "angle: 0.0"),
      "limits/angle is there twice");
}

TEST(DocumentedParameters, HaveTheirDefaults) {
  EXPECT_NONFATAL_FAILURE(checkWith("place: 0.51", "place: 0.5"), "place is 0.5");
  EXPECT_NONFATAL_FAILURE(checkWith("motion: fast", "motion: still"), "motion is still");
  EXPECT_NONFATAL_FAILURE(checkWith("[a, c]", "[a, b]"), "names is [a, b]");
  EXPECT_NONFATAL_FAILURE(checkWith("[a]", "[a, b]"), "names is [a, b]");
}

TEST(DocumentedParameters, HaveASentenceOfTheirOwn) {
  EXPECT_NONFATAL_FAILURE(checkWith("", "# Their names.\n"), "names has no sentence");
  EXPECT_NONFATAL_FAILURE(checkWith("# Their names.\n\n", "# Their names.\n"),
                          "names has no sentence");
  EXPECT_NONFATAL_FAILURE(checkWith("names", "names."), "names has no sentence");
}

TEST(DocumentedParameters, HaveTheirRangesWithUnits) {
  EXPECT_NONFATAL_FAILURE(checkWith("-1..2]", "-1..2.5]"), "place goes from -1 to 2.5");
  EXPECT_NONFATAL_FAILURE(checkWith("1..2.5]", "-1..2.5]"), "place goes from -1 to 2.5");
  EXPECT_NONFATAL_FAILURE(checkWith("-1..far]", "-1..2.5]"), "place goes from -1 to 2.5");
  EXPECT_NONFATAL_FAILURE(checkWith("[m], -1 to 2.5", "[m, -1..2.5]"), "place has no [unit, A..B]");
  EXPECT_NONFATAL_FAILURE(checkWith("[0..100000]", "[1, 0..100000]"),
                          "limits/images has no [unit, A..B]");
  EXPECT_NONFATAL_FAILURE(checkWith("images]", "longest]"), "limits/shortest goes from");
  EXPECT_NONFATAL_FAILURE(checkWith("-2..2 pi]", "-2 pi..2 pi]"), "limits/angle goes from");
}

TEST(DocumentedParameters, HaveRangesIfTheyAreNumbers) {
  ParameterReader reader = readAll();
  reader.optional("more", 1.0);
  reader.optional<std::string>("text", "1f 03");
  const std::string more = "\n# Any number [1, 0..5].\nmore: 1.0\n\n# A text.\ntext: 1f 03\n";
  EXPECT_NONFATAL_FAILURE(check(kRight + more, reader), "more is a number without a range");
}

TEST(DocumentedParameters, HaveTheirWords) {
  EXPECT_NONFATAL_FAILURE(checkWith("[still]", "[still, fast]"), "motion has no [still, fast]");
}

}  // namespace
}  // namespace wiimote_tracker
