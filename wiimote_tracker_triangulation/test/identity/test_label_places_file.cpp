// The file that keeps where labelled LEDs are, for a tracker that is started again.
#include "identity/label_places_file.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <string>
#include <system_error>

namespace wiimote_tracker::identity {
namespace {

TEST(LabelPlacesFile, PlacesOfAnotherRigAreIgnored) {
  const std::string file = testing::TempDir() + "places_of_rig_" + std::to_string(::getpid());
  ASSERT_FALSE(writePlaces(file, "a rig", {{"rig", {}}, {"b", {}}}));
  EXPECT_EQ(2u, readPlaces(file, "a rig", std::chrono::seconds(60)).size());
  EXPECT_TRUE(readPlaces(file, "another", std::chrono::seconds(60)).empty());
  std::ofstream(file) << "rig 1 2 3 0 0 1\n";
  EXPECT_EQ(1u, readPlaces(file, "a rig", std::chrono::seconds(60)).size()) << "older version's";
  std::remove(file.c_str());
}

TEST(LabelPlacesFile, SaysWhyItCannotBeWritten) {
  const std::string file = testing::TempDir() + "no_place_" + std::to_string(::getpid());
  ASSERT_EQ(0, ::symlink("/dev/full", (file + ".new").c_str()));
  EXPECT_EQ(std::errc::no_space_on_device, writePlaces(file, "rig", {{"a", {}}}));
  std::remove((file + ".new").c_str());
  EXPECT_EQ(std::errc::not_a_directory, writePlaces("/dev/full/places", "rig", {{"a", {}}}));
}

TEST(LabelPlacesFile, EachNamespaceHasOneInTheFolder) {
  EXPECT_EQ("", placesFile("", "/room"));
  EXPECT_EQ("/lab/places", placesFile("/lab/places", "/room"));
  EXPECT_EQ("/lab/label_places", placesFile("/lab/", "/"));
  EXPECT_EQ("/lab/room/label_places", placesFile("/lab/", "/room"));
  EXPECT_EQ("/lab/house/room/label_places", placesFile("/lab/", "/house/room"));
}

TEST(LabelPlacesFile, HoldsAllOfAPlace) {
  LedLabels::Place place;
  place.position = {1.5, -2.0, 0.25};
  place.speed = 0.5;
  place.age = 4.0;
  place.confidence = 0.75;
  const std::string file = testing::TempDir() + "one_place_" + std::to_string(::getpid());
  ASSERT_FALSE(writePlaces(file, "rig", {{"a", place}}));
  const LedLabels::Places places = readPlaces(file, "rig", std::chrono::seconds(60));
  std::remove(file.c_str());
  ASSERT_EQ(1u, places.size());
  const LedLabels::Place& found = places.at("a");
  EXPECT_EQ(place.position, found.position);
  EXPECT_EQ(place.speed, found.speed);
  EXPECT_EQ(place.confidence, found.confidence);
  EXPECT_GE(found.age, 4.0) << "and the age of the file";
}

}  // namespace
}  // namespace wiimote_tracker::identity
