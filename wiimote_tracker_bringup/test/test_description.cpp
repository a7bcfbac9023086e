#include "description.h"

#include <wiimote_tracker_msgs/error.h>

#include <gtest/gtest.h>

#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker::simulation {
namespace {

const char kGood[] = R"(
world_frame: room
seed: 3
pixel_noise: 0.25
truth_rate: 120.0
cameras:
  second:
    identity: "00:1f:32:00:00:02"
    intrinsics: {width: 640, height: 480, fx: 600, fy: 610, cx: 320, cy: 240, distortion: [0.1, 0, 0, 0, 0]}
    position: [1, 2, 3]
    look_at: [1, 7, 3]
    clock: {period: 0.02, phase: 0.001, tolerance: 0.0005, wander: 0.001}
    delay: {constant: 0.005, jitter: 0.0024, shape: normal, slot: 0.00125, drops: 0.04, burst: 0.2, stalls: 0.3, longest_stall: 0.16}
  first:
    identity: "00:1f:32:00:00:01"
    intrinsics: {fx: 1300, fy: 1300, cx: 512, cy: 384, distortion: [0, 0, 0, 0, 0]}
    position: [0, 0, 1]
    look_at: [1, 0, 1]
    clock: {period: 0.01, phase: 0.0}
    delay: {constant: 0.0, jitter: 0.0}
leds:
  led: {position: [1, 1, 0], size: 5, lit: false}
)";

class DescriptionFile : public testing::Test {
 protected:
  void SetUp() override {
    char path[] = "/tmp/wiimote_tracker_description_XXXXXX";
    const int file = mkstemp(path);
    ASSERT_NE(file, -1);
    close(file);
    path_ = path;
  }
  void TearDown() override { std::remove(path_.c_str()); }

  Description read(const std::string& text) {
    std::ofstream(path_) << text;
    return readDescription(path_);
  }

  /// The good file with `from` replaced by `to`.
  static std::string with(const std::string& from, const std::string& to) {
    std::string text = kGood;
    const auto place = text.find(from);
    EXPECT_NE(place, std::string::npos) << from;
    return text.replace(place, from.size(), to);
  }

  /// The error for that file.
  std::string complaint(const std::string& from, const std::string& to) {
    try {
      read(with(from, to));
    } catch (const FileError& error) {
      EXPECT_NE(std::string(error.what()).find(path_), std::string::npos) << error.what();
      return error.what();
    }
    return "accepted";
  }

  void expectRefused(const std::string& from, const std::string& to, const std::string& reason) {
    const std::string said = complaint(from, to);
    EXPECT_NE(said.find(reason), std::string::npos) << said;
  }

  std::string path_;
};

TEST_F(DescriptionFile, keeps_all_entries_in_the_order_of_the_file) {
  const Description d = read(kGood);
  EXPECT_EQ(d.world_frame, "room");
  EXPECT_EQ(d.seed, 3u);
  EXPECT_EQ(d.pixel_noise, 0.25);
  EXPECT_EQ(d.truth_rate, 120.0);
  ASSERT_EQ(d.cameras.size(), 2u);
  EXPECT_EQ(d.cameras[0].camera.name, "second");
  EXPECT_EQ(d.cameras[1].camera.name, "first");
  EXPECT_EQ(d.cameras[0].camera.identity, "00:1f:32:00:00:02");
  EXPECT_EQ(d.cameras[0].camera.intrinsics.width, 640);
  EXPECT_EQ(d.cameras[1].camera.intrinsics.width, 1024);
  EXPECT_EQ(d.cameras[0].camera.intrinsics.distortion[0], 0.1);
  EXPECT_EQ(d.cameras[0].camera.center(), Eigen::Vector3d(1, 2, 3));
  // The optical axis points to look_at, image x is level, image y points down.
  const Eigen::Matrix3d rotation = d.cameras[0].camera.world_from_camera.linear();
  EXPECT_LT((rotation.col(2) - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_LT((rotation.col(0) - Eigen::Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_LT((rotation.col(1) + Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  EXPECT_EQ(d.cameras[0].timing.period, 0.02);
  EXPECT_EQ(d.cameras[0].timing.phase, 0.001);
  using Core = virtual_wiimote::FrameTimesModel::Core;
  const virtual_wiimote::FrameTimesModel& timing = d.cameras[0].timing;
  EXPECT_EQ(timing.period_tolerance, 0.0005);
  EXPECT_EQ(timing.wander, 0.001);
  EXPECT_EQ(timing.delay, 0.005);
  EXPECT_EQ(timing.jitter, 0.0024);
  EXPECT_EQ(timing.core, Core::kNormal);
  EXPECT_EQ(timing.slot, 0.00125);
  EXPECT_EQ(timing.drops, 0.04);
  EXPECT_EQ(timing.burst, 0.2);
  EXPECT_EQ(timing.stalls, 0.3);
  EXPECT_EQ(timing.longest_stall, 0.16);
  EXPECT_EQ(d.cameras[1].timing.core, Core::kExponential);
  EXPECT_EQ(d.cameras[1].timing.drops, 0.0);
  ASSERT_EQ(d.leds.size(), 1u);
  EXPECT_EQ(d.leds[0].name, "led");
  EXPECT_EQ(d.leds[0].size, 5.0);
  EXPECT_EQ(d.leds[0].brightness, 1.0);
  EXPECT_FALSE(d.leds[0].lit);
}

TEST_F(DescriptionFile, a_lens_may_be_equidistant) {
  const Description d = read(with("distortion: [0.1, 0, 0, 0, 0]",
                                  "distortion_model: equidistant, distortion: [0.1, 0, 0, 0.2]"));
  const geometry::Intrinsics& lens = d.cameras[0].camera.intrinsics;
  EXPECT_EQ(lens.distortion_model, geometry::DistortionModel::kEquidistant);
  EXPECT_EQ(lens.distortion, (std::array<double, 5>{0.1, 0, 0, 0.2, 0}));
}

TEST_F(DescriptionFile, an_led_without_size_is_dimmed_by_distance) {
  const Description d = read(with("size: 5", "brightness: 0"));
  EXPECT_FALSE(d.leds[0].size);
  EXPECT_EQ(d.leds[0].brightness, 0.0);
}

TEST_F(DescriptionFile, an_led_may_turn_about_one_that_does_not_turn) {
  const std::string end =
      "lit: false}\n  end: {turns: {around: led, distance: 0.5, rate: 1.5}, brightness: 1}";
  const Description d = read(with("lit: false}", end));
  ASSERT_EQ(d.leds.size(), 2u);
  ASSERT_TRUE(d.leds[1].turns);
  EXPECT_EQ(d.leds[1].turns->around, "led");
  EXPECT_EQ(d.leds[1].turns->distance, 0.5);
  EXPECT_EQ(d.leds[1].turns->rate, 1.5);

  const std::string reason = "leds/end/turns/around must be the name of an LED that does not turn";
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = end;
    return text.replace(text.find(from), from.size(), to);
  };
  expectRefused("lit: false}", changed("around: led", "around: lamp"), reason);
  expectRefused("lit: false}", changed("around: led", "around: end"), reason);
  expectRefused("lit: false}", changed("distance: 0.5", "distance: 0"),
                "leds/end/turns/distance is 0");
}

TEST_F(DescriptionFile, drawings_are_read_from_the_same_folder) {
  const std::string csv = path_ + ".csv";
  const std::string name = csv.substr(csv.rfind('/') + 1);
  const std::string key = "leds:\n  led";
  const std::string drawing =
      "drawings: {roof: {file: " + name + ", size: 0.5, rest: 0.3}}\n" + key;
  expectRefused(key, drawing, "drawings/roof/file cannot be used: " + csv);
  expectRefused(key, drawing, "copy this file there, too");

  std::ofstream(csv) << "x y z t_ms\n0 0 0 100\n2 0 1 1100\n4 0 0 4100\n";
  const Description d = read(with(key, drawing));
  ASSERT_EQ(d.drawings.count("roof"), 1u);
  EXPECT_EQ(d.drawings.at("roof").rest(), 0.3);
  EXPECT_EQ(d.drawings.at("roof").duration(), 4.0);
  EXPECT_LT((d.drawings.at("roof").position(0.0) - Eigen::Vector3d(-0.25, 0.0, -0.0625)).norm(),
            1e-12);

  const std::pair<const char*, const char*> faults[] = {{"0 0 0 0\n", "fewer than two points"},
                                                        {"0 0 0 5\n1 0 0 5\n", "do not increase"},
                                                        {"1 1 1 0\n1 1 1 5\n", "does not move"},
                                                        {"0 0 0 0\nnan 1 1 5\n", "not finite"}};
  for (const auto& [rows, reason] : faults) {
    std::ofstream(csv) << rows;
    expectRefused(key, drawing, "drawings/roof/file");
    expectRefused(key, drawing, reason);
    EXPECT_EQ(complaint(key, drawing).find("copy this file"), std::string::npos);
  }
  std::remove(csv.c_str());
}

TEST_F(DescriptionFile, a_board_needs_an_existing_camera) {
  EXPECT_FALSE(read(kGood).board);
  const std::string text = std::string(kGood) + "board: {before: first, row_spacing: 0.1}\n";
  const Description d = read(text);
  ASSERT_TRUE(d.board);
  EXPECT_EQ(d.board->before, "first");
  EXPECT_EQ(d.board->column_spacing, 0.08);
  EXPECT_EQ(d.board->row_spacing, 0.1);
  expectRefused(
      "leds:", "board: {before: third}\nleds:", "board/before must be the name of a camera");
}

TEST_F(DescriptionFile, motions_may_start_with_the_simulation) {
  Description d =
      read(with("size: 5", "wave: {middle: [1, 2, 1], box: [1, 1, 0], speed: 0.5, path: 3}"));
  LedMotion wave(Eigen::Vector3d(1, 1, 0));
  wave.wave(0.0, Eigen::Vector3d(1, 2, 1), Eigen::Vector3d(1, 1, 0), 0.5, 3);
  EXPECT_EQ(d.leds[0].motion.position(7.0), wave.position(7.0));
  d = read(with("size: 5", "circle: {middle: [1, 2, 1], radius: 0.5, speed: 0.25}"));
  LedMotion circle(Eigen::Vector3d(1, 1, 0));
  circle.circle(0.0, Eigen::Vector3d(1, 2, 1), 0.5, 0.25);
  EXPECT_EQ(d.leds[0].motion.position(20.0), circle.position(20.0));

  expectRefused("size: 5", "wave: {middle: [1, 2, 1], box: [0, 0, 0], speed: 1, path: 3}",
                "leds/led/wave/box must have sides of 0 or more");
  expectRefused("size: 5", "circle: {middle: [1, 2, 1], radius: 0, speed: 1}",
                "leds/led/circle/radius is 0");
  expectRefused("size: 5", "circle: {}, wave: {}", "leds/led/circle and wave exclude");
}

TEST_F(DescriptionFile, people_carry_leds_and_cameras_see_reflections) {
  const std::string more = R"(
people:
  anna: {position: [1, 2, 0], turn_rate: -0.5, radius: 0.25, height: 1.6, present: false}
reflections:
  window: {camera: first, pixel: [10, 20], size: 4, brightness: 2, lit: false}
)";
  const Description d = read(with("size: 5", "carried_by: anna") + more);
  ASSERT_EQ(d.people.size(), 1u);
  EXPECT_EQ(d.people[0].name, "anna");
  EXPECT_EQ(d.people[0].motion.position(0.0), Eigen::Vector3d(1, 2, 0));
  EXPECT_EQ(d.people[0].turn_rate, -0.5);
  EXPECT_EQ(d.people[0].radius, 0.25);
  EXPECT_EQ(d.people[0].height, 1.6);
  EXPECT_FALSE(d.people[0].present);
  EXPECT_EQ(d.leds[0].carried_by, "anna");
  ASSERT_EQ(d.reflections.size(), 1u);
  EXPECT_EQ(d.reflections[0].camera, "first");
  EXPECT_EQ(d.reflections[0].pixel, Eigen::Vector2d(10, 20));
  EXPECT_EQ(d.reflections[0].size, 4.0);
  EXPECT_EQ(d.reflections[0].brightness, 2.0);
  EXPECT_FALSE(d.reflections[0].lit);

  expectRefused("size: 5", "carried_by: ben",
                "leds/led/carried_by must be the name of one of the people");
  expectRefused("leds:", "reflections: {window: {camera: third, pixel: [1, 2]}}\nleds:",
                "reflections/window/camera must be the name of a camera");
  expectRefused("leds:", "reflections: {window: {camera: first, pixel: [1]}}\nleds:",
                "reflections/window/pixel must have two numbers");
  expectRefused("leds:", "people: {led: {position: [1, 2, 0]}}\nleds:",
                "people/led is also the name of something else");
}

TEST_F(DescriptionFile, bodies_turn_and_sway_and_carry_leds) {
  const std::string body = R"(
bodies:
  wand: {position: [1, 2, 1], turn: {axis: [0, 3, 0], rate: 0.5}, sway: {angle: 0.4, rate: 2.5}, present: false}
)";
  const Description d = read(with("size: 5", "carried_by: wand") + body);
  ASSERT_EQ(d.bodies.size(), 1u);
  EXPECT_EQ(d.bodies[0].name, "wand");
  EXPECT_EQ(d.bodies[0].motion.position(0.0), Eigen::Vector3d(1, 2, 1));
  EXPECT_EQ(d.bodies[0].turning.axis, Eigen::Vector3d(0, 3, 0));
  EXPECT_EQ(d.bodies[0].turning.rate, 0.5);
  EXPECT_EQ(d.bodies[0].turning.sway, 0.4);
  EXPECT_EQ(d.bodies[0].turning.sway_rate, 2.5);
  EXPECT_FALSE(d.bodies[0].present);
  EXPECT_EQ(d.leds[0].carried_by, "wand");
  expectRefused(
      "leds:", "bodies: {wand: {position: [1, 2, 1], turn: {axis: [0, 0, 0], rate: 1}}}\nleds:",
      "bodies/wand/turn/axis must have a direction");
}

TEST_F(DescriptionFile, leds_blink_by_a_code_or_a_word) {
  const std::string led = "led: {position: [1, 1, 0], size: 5, lit: false}";
  const auto withBlink = [&](const std::string& blink) {
    return with(led, "led: {position: [1, 1, 0], blink: {" + blink + "}}");
  };
  const Blink word = *read(withBlink("word: '0111', chip: 0.02, begin: 0.5")).leds[0].blink;
  EXPECT_DOUBLE_EQ(word.period, 0.08);
  EXPECT_NEAR(word.light(0.51), 0.0, 1e-9);
  EXPECT_NEAR(word.light(0.53), 1.0, 1e-9);
  EXPECT_NEAR(word.light(0.52), 0.5, 1e-9) << "half of the exposure";
  EXPECT_NEAR(word.light(0.51 + 7 * 0.08), 0.0, 1e-9);
  EXPECT_NEAR(word.light(0.59 - 7 * 0.08), 0.0, 1e-9);

  const std::string codes =
      "codes: '" SIMULATION_FOLDER
      "/../../wiimote_tracker_triangulation/config/blink_codes_paper.yaml', label: right_hand";
  const Blink paper = *read(withBlink(codes + ", period: 0.15")).leds[0].blink;
  EXPECT_DOUBLE_EQ(paper.period, 0.15);
  EXPECT_NEAR(paper.light(0.028), 0.0, 1e-9) << "60 % in the middle";
  EXPECT_NEAR(paper.light(0.032), 1.0, 1e-9);
  EXPECT_NEAR(paper.light(0.118), 1.0, 1e-9);
  EXPECT_NEAR(paper.light(0.122), 0.0, 1e-9);

  for (const auto& [blink, key] : std::vector<std::pair<std::string, std::string>>{
           {codes + ", period: 1.0", "period"},
           {codes + "s", "label"},
           {"word: '1111', chip: 0.02", "word"},
           {"word: '0111'", "chip"},
           {"codes: nowhere.yaml, label: a", "codes"},
           {"word: '0111', chip: 0.02, at: 1", "at"}}) {
    try {
      read(withBlink(blink));
      ADD_FAILURE() << blink;
    } catch (const FileError& error) {
      EXPECT_NE(std::string(error.what()).find("leds/led/blink/" + key), std::string::npos)
          << error.what();
    }
  }
}

TEST_F(DescriptionFile, errors_name_file_key_and_reason) {
  expectRefused("period: 0.02", "period: 0",
                "cameras/second/clock/period is 0, but must be within");
  expectRefused("phase: 0.001", "phase: soon", "cameras/second/clock/phase has the wrong type");
  expectRefused("phase: 0.001", "phase: .nan", "cameras/second/clock/phase is nan");
  expectRefused("shape: normal", "shape: formal",
                "cameras/second/delay/shape is formal, but must be exponential or normal");
  expectRefused("drops: 0.04", "drops: 4", "cameras/second/delay/drops is 4, but must be within");
  expectRefused("stalls:", "stall:", "cameras/second/delay/stall is an unknown key");
  expectRefused("wander: 0.001", "wonder: 0.001", "cameras/second/clock/wonder is an unknown key");
  expectRefused("pixel_noise: 0.25", "", "pixel_noise is missing");
  expectRefused("pixel_noise", "pixel_nosie: 1\npixel_noise", "pixel_nosie is an unknown key");
  expectRefused("lit: false", "lti: false", "leds/led/lti is an unknown key");
  expectRefused("position: [1, 1, 0]", "position: [1, 1]",
                "leds/led/position must have three numbers");
  expectRefused("fx: 600", "fx: -600", "cameras/second/intrinsics cannot be used");
  expectRefused("[0.1, 0, 0, 0, 0]", "[0.1, 0]",
                "cameras/second/intrinsics/distortion must have the numbers k1, k2, p1, p2, k3");
  expectRefused("distortion: [0.1, 0, 0, 0, 0]",
                "distortion_model: equidistant, distortion: [0.1, 0, 0, 0, 0]",
                "cameras/second/intrinsics/distortion must have the numbers k1, k2, k3, k4");
  expectRefused("distortion: [0.1", "distortion_model: fisheye, distortion: [0.1",
                "cameras/second/intrinsics/distortion_model must be plumb_bob");
  expectRefused("look_at: [1, 7, 3]", "look_at: [1, 2, 9]",
                "cameras/second/look_at cannot be used");  // straight up
  expectRefused("leds:", "leds: {}\nlets:", "leds is empty");
  const std::string said = complaint("  first:", "  second:");
  EXPECT_TRUE(said.find("second is there twice") != std::string::npos ||
              said.find("not valid YAML") != std::string::npos)
      << said;
}

TEST_F(DescriptionFile, a_missing_foreign_or_damaged_file_is_refused) {
  EXPECT_THROW(readDescription("/nonexistent/rig.yaml"), FileError);
  EXPECT_THROW(read("just text"), FileError);
  EXPECT_THROW(read(""), FileError);
  EXPECT_THROW(read("cameras: {a: [1, 2"), FileError);
}

}  // namespace
}  // namespace wiimote_tracker::simulation
