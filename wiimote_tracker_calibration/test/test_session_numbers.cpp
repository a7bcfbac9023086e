// The numbers of a session's file are the same in every locale.
#include "expect_says.h"

#include "session/session_file.h"

#include <wiimote_tracker_triangulation/geometry/atomic_file.h>

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <locale>
#include <string>

namespace wiimote_tracker::session {
namespace {

/// Whatever locales are installed.
class DecimalComma : public std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
};

std::string written(const Session& session) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() /
                                       ("test_session_numbers_" + std::to_string(::getpid()));
  const std::string path = (folder / "samples.yaml").string();
  writeSessionFile(session, path);
  const std::string text = geometry::readFile(path);
  std::filesystem::remove_all(folder);
  return text;
}

TEST(SessionNumbers, HaveADecimalPointWhereAProgramSetsAComma) {
  Session session;
  session.recording.square = square::SquareLayout();
  session.recording.square->side_x = 2.5;
  session.recording.square->side_y = 1.5;
  session.recording.cameras.resize(1);
  session.recording.cameras[0].sightings.name = "camera_1";
  session.recording.cameras[0].frames = {{1700000000.125, {{512.5, 384.25}}}};
  session.masks.resize(1);
  std::locale::global(std::locale(std::locale::classic(), new DecimalComma));
  const std::string text = written(session);
  std::locale::global(std::locale::classic());
  EXPECT_SAYS(text, "side_x: 2.5\n");
  EXPECT_SAYS(text, "  1700000000.125 512.5 384.25\n");
  EXPECT_EQ(text, written(session));
}

}  // namespace
}  // namespace wiimote_tracker::session
