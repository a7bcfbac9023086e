// Two rooms that share no view, joined by a simulated LED that is carried through the door.

#include "rooms/join_rooms.h"

#include "expect_says.h"
#include "refusal_of.h"
#include "room_trial.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace wiimote_tracker::rooms {
namespace {

constexpr double kDegree = M_PI / 180.0;

std::string refusal(const TwoRooms& trial, const JoinOptions& options = {}) {
  return refusalOf([&] { trial.join(options); });
}

JoinOptions withSlope(double slope) {
  JoinOptions options;
  options.slope = slope;
  return options;
}

JoinOptions ofSteadyWalkers() {
  JoinOptions options;
  options.slowing = 0.0;
  return options;
}

constexpr double kNotLevel = std::numeric_limits<double>::infinity();

/// Gives the second room another world.
void turnSecondWorld(const Eigen::Matrix3d& turn, TwoRooms* trial) {
  for (geometry::RigCamera& camera : trial->second.cameras)
    camera.camera.world_from_camera = Eigen::Isometry3d(turn) * camera.camera.world_from_camera;
  for (Path& track : trial->second_tracks) {
    for (PathPoint& point : track)
      point.position = turn * point.position;
  }
}

TEST(ExtensiveJoinRooms, TiesTheRoomsAsWellAsStatedAndBetterWithEachPassage) {
  const std::map<int, double> largest = {{1, 0.16}, {4, 0.087}, {10, 0.056}, {16, 0.047}};  // [m]
  for (const auto& [passages, position] : largest) {
    const int times = passages;
    const RoomErrors errors = errorsOfRooms(
        30, [times](TwoRooms* trial) { trial->carryOften(times); }, ofSteadyWalkers());
    EXPECT_LT(errors.position, position) << passages;
    EXPECT_NEAR(errors.stated_position / errors.position, 1.0, 0.3) << passages;
    EXPECT_NEAR(errors.stated_rotation / errors.rotation, 1.0, 0.3) << passages;
    EXPECT_NEAR(errors.nees, 1.0, 0.3) << passages;
    if (passages >= 16) {
      EXPECT_LT(errors.rotation, 0.55 * kDegree);
    }
  }
}

TEST(ExtensiveJoinRooms, StatesTheErrorsOfSomebodyWhoseHeadingWandersMore) {
  const RoomErrors errors = errorsOfRooms(30, [](TwoRooms* trial) {
    CarriedLed led;
    led.heading = 3.0 * kDegree;
    trial->carryOften(10, led);
  });
  EXPECT_NEAR(errors.stated_rotation / errors.rotation, 1.0, 0.2);
  EXPECT_NEAR(errors.stated_position / errors.position, 1.0, 0.2);
}

TEST(ExtensiveJoinRooms, StatesTheErrorsOfSomebodyWhoSlowsDownAtTheDoor) {
  for (const double slowing : {0.0, 0.05}) {
    const RoomErrors errors = errorsOfRooms(20, [slowing](TwoRooms* trial) {
      CarriedLed led;
      led.slowing = slowing;
      trial->carryOften(16, led);
    });
    EXPECT_LT(errors.position, 0.056) << slowing;
    EXPECT_NEAR(errors.stated_position / errors.position, 1.0, 0.2) << slowing;
    EXPECT_NEAR(errors.nees, 1.0, 0.3) << slowing;
  }
}

TEST(JoinRooms, SaysHowManyMorePassagesAreNeeded) {
  TwoRooms trial(1, 0.0);
  trial.carryOften(1);
  EXPECT_SAYS(trial.join().message, "by 1 passage through the door; ");
  trial.carryOften(3);
  const std::string message = trial.join().message;
  EXPECT_SAYS(message, "4 cameras joined to the 4 of the first rig by 4 passages through the door");
  const std::string before = "walk through the door about ";
  ASSERT_NE(message.find(before), std::string::npos) << message;
  EXPECT_SAYS(message, "more times for 5 cm and 0.5 degrees");
  const int more = std::stoi(message.substr(message.find(before) + before.size()));
  trial.carryOften(more + more / 3);
  EXPECT_SAYS(trial.join().message, "that is as good as wanted");
  trial.second.covariance *= 400.0;
  EXPECT_SAYS(trial.join().message, "calibrate the rooms better");
}

TEST(ExtensiveJoinRooms, WorldsWithoutALevelAreTiltedByThePassages) {
  // No accelerometer tells otherwise.
  const auto carry = [](TwoRooms* trial) {
    for (geometry::RigCamera& camera : trial->second.cameras)
      camera.gravity.reset();
    trial->carryOften(10);
  };
  const RoomErrors errors = errorsOfRooms(20, carry, withSlope(kNotLevel), 20.0 * kDegree);
  EXPECT_LT(errors.rotation, 2.0 * kDegree);
  // Hands sway less upwards than sideways, so the tilt is better than stated.
  EXPECT_GT(errors.stated_rotation / errors.rotation, 0.8);
  EXPECT_LT(errors.stated_rotation / errors.rotation, 2.0);
  EXPECT_LT(errors.nees, 1.3);
}

TEST(JoinRooms, OneLineLeavesTheTiltOpen) {
  TwoRooms trial(3, JoinOptions().slope);
  for (int i = 0; i < 6; ++i)
    trial.carry(i % 2 == 0, {});
  const JoinedRooms level = trial.join();
  EXPECT_LT(trial.errorOf(level).tail<3>().norm(), 3.0 * level.position_stddev);
  trial.first_tracks.resize(1);
  EXPECT_SAYS(refusal(trial, withSlope(kNotLevel)), "all passages are on one line");
}

TEST(JoinRooms, AWorldMayBeUpsideDownButNotSteep) {
  TwoRooms trial(4, 0.0);
  trial.carryOften(6);
  const Eigen::Isometry3d upright = trial.join().first_from_second;
  const Eigen::Matrix3d over = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()).matrix();
  turnSecondWorld(over, &trial);
  EXPECT_LT((trial.join().first_from_second.linear() * over - upright.linear()).norm(), 1e-6);
  turnSecondWorld(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()).matrix(), &trial);
  EXPECT_SAYS(refusal(trial), "the world of the second rig slopes by 17 degrees");
  trial.join(withSlope(kNotLevel));
}

TEST(JoinRooms, AnotherLedIsLeftOut) {
  for (const int seed : {1, 2, 3, 4, 5}) {
    TwoRooms trial(static_cast<std::uint64_t>(seed), 0.0);
    trial.carryOften(7);
    // Two LEDs that disappear in one room while others appear in the other one.
    for (const std::size_t i : {2, 5}) {
      for (PathPoint& point : trial.second_tracks[i])
        point.position += Eigen::Vector3d(0.5, 0.4, 0.1);
    }
    const JoinedRooms joined = trial.join();
    EXPECT_EQ(joined.passages, 5U);
    EXPECT_SAYS(joined.message, "2 left out: contradicts the others");
    EXPECT_LT(trial.errorOf(joined).tail<3>().norm(), 0.2);
  }
  TwoRooms trial(6, 0.0);
  trial.carryOften(2);
  for (PathPoint& point : trial.second_tracks[0])
    point.position += Eigen::Vector3d(1.5, 0.0, 0.0);
  EXPECT_SAYS(refusal(trial), "contradict one another");
}

TEST(JoinRooms, OnlyOneLedThatIsCarriedStraightCounts) {
  TwoRooms trial(7, 0.0);
  trial.carryOften(3);
  // With the third passage another LED appears in the second room.
  trial.second_tracks.push_back(trial.second_tracks[0]);
  const double later =
      trial.second_tracks[2].front().time - trial.second_tracks[0].front().time + 0.2;
  for (PathPoint& point : trial.second_tracks.back())
    point.time += later;
  EXPECT_SAYS(trial.join().message, "by 2 passages through the door; 1 left out: several LEDs");
  // After the first passage somebody turns to the side.
  const double door = trial.second_tracks[0].front().time;
  for (PathPoint& point : trial.second_tracks[0])
    point.position.y() += 1.5 * std::pow(point.time - door, 2);
  EXPECT_SAYS(trial.join().message, "1 left out: not straight");
  // An LED that lies in the room is none that is carried.
  for (PathPoint& point : trial.second_tracks[1])
    point.position = trial.second_tracks[1].front().position;
  EXPECT_SAYS(refusal(trial), "no passage from one room to the other was found");
}

TEST(JoinRooms, AnLedSeenFromBothRoomsAtTheSameTimeIsSaid) {
  TwoRooms trial(7, 0.0);
  trial.carryOften(3);
  Path& second = trial.second_tracks[1];
  const double shift = second.front().time > trial.first_tracks[1].front().time ? -1.5 : 1.5;
  for (PathPoint& point : second)
    point.time += shift;
  EXPECT_SAYS(trial.join().message,
              "by 2 passages through the door; 1 left out: both rooms saw an LED at that time");
}

TEST(JoinRooms, AnLedWithSeveralTracksIsOne) {
  TwoRooms trial(12, 0.0);
  trial.carryOften(6);
  const JoinedRooms plain = trial.join();
  for (std::vector<Path>* tracks : {&trial.first_tracks, &trial.second_tracks}) {
    for (std::size_t i = 0; i < 6; ++i) {
      Path& track = (*tracks)[i];
      const auto begin = track.begin();
      // It goes on with another number after it was lost for 0.2 s; next to the door, where two
      // cameras see it with an error, it has a second one.
      const auto middle = begin + static_cast<std::ptrdiff_t>(track.size() / 2);
      Path twin(begin, middle - 10);
      for (PathPoint& point : twin)
        point.position += Eigen::Vector3d(0.05, -0.1, 0.02);
      const Path later(middle + 5, track.end());
      track.erase(middle - 5, track.end());
      tracks->push_back(later);
      tracks->push_back(twin);
    }
  }
  const JoinedRooms joined = trial.join();
  EXPECT_EQ(joined.passages, 6U) << joined.message;
  EXPECT_LT((joined.first_from_second.translation() - plain.first_from_second.translation()).norm(),
            plain.position_stddev);
}

TEST(JoinRooms, ASmallOffsetOfTheClocksCancelsInBothDirections) {
  TwoRooms trial(8, 0.0);
  trial.carryOften(20);
  const JoinedRooms exact = trial.join();
  for (Path& track : trial.second_tracks) {
    for (PathPoint& point : track)
      point.time += 0.02;
  }
  const JoinedRooms late = trial.join();
  EXPECT_LT((late.first_from_second.translation() - exact.first_from_second.translation()).norm(),
            0.25 * 0.02 * 1.25);
}

TEST(JoinRooms, RigsThatShareACameraAreRefused) {
  TwoRooms trial(9, 0.0);
  trial.carryOften(2);
  trial.second.cameras[0].camera.name = trial.first.cameras[0].camera.name;
  EXPECT_SAYS(refusal(trial), "hall_1 is in both rigs");
}

}  // namespace
}  // namespace wiimote_tracker::rooms
