#include "coverage_layer.h"

#include <gtest/gtest.h>
#include <sensor_msgs/point_cloud2_iterator.h>

#include <array>
#include <cmath>
#include <vector>

namespace wiimote_tracker::panel {
namespace {

/// Two cells in each layer; those of the layer in the middle were not determined.
sensor_msgs::PointCloud2 cells() {
  using sensor_msgs::PointField;
  sensor_msgs::PointCloud2 cloud;
  sensor_msgs::PointCloud2Modifier modifier(cloud);
  modifier.setPointCloud2Fields(5, "x", 1, PointField::FLOAT32, "y", 1, PointField::FLOAT32, "z", 1,
                                PointField::FLOAT32, "stddev", 1, PointField::FLOAT32, "cameras", 1,
                                PointField::FLOAT32);
  modifier.resize(6);
  sensor_msgs::PointCloud2Iterator<float> x(cloud, "x");
  for (int i = 0; i < 6; ++i, ++x) {
    const int layer = i % 3;
    x[0] = static_cast<float>(i);
    x[1] = 0.0f;
    x[2] = 0.25f + 0.5f * static_cast<float>(layer);
    x[3] = layer == 1 ? NAN : 0.5f * x[0];
    x[4] = layer == 1 ? 1.0f : 3.0f;
  }
  return cloud;
}

/// Of the points of a layer.
std::vector<float> valuesOf(const sensor_msgs::PointCloud2& cloud, const char* field) {
  std::vector<float> values;
  for (sensor_msgs::PointCloud2ConstIterator<float> v(cloud, field); v != v.end(); ++v)
    values.push_back(*v);
  EXPECT_EQ(values.size(), cloud.width);
  return values;
}

TEST(CoverageLayer, IsTheNearestToTheHeight) {
  EXPECT_EQ(valuesOf(layerAt(cells(), 0.4f), "x"), (std::vector<float>{0.0f, 3.0f}));
  EXPECT_EQ(valuesOf(layerAt(cells(), 0.9f), "x"), (std::vector<float>{1.0f, 4.0f}));
}

TEST(CoverageLayer, KeepsTheNumbersOfItsCells) {
  EXPECT_EQ(valuesOf(layerAt(cells(), 1.25f), "stddev"), (std::vector<float>{1.0f, 2.5f}));
}

TEST(CoverageLayer, CellsHaveTheirPlaces) {
  const auto places = placesOf(cells());
  ASSERT_EQ(places.size(), 6U);
  EXPECT_EQ(places[4], (std::array<float, 3>{4.0f, 0.0f, 0.75f}));
  EXPECT_TRUE(placesOf(sensor_msgs::PointCloud2()).empty());
}

TEST(CoverageLayer, SaysHowManyCamerasSeeACellAndHowWell) {
  EXPECT_EQ(numbersOf(cells(), 2), "3 cameras, 1000 mm");
  EXPECT_EQ(numbersOf(cells(), 1), "1 camera");
  EXPECT_EQ(numbersOf(sensor_msgs::PointCloud2(), 0), "");
}

TEST(CoverageLayer, OutsideOfTheVolumeIsTheLastOne) {
  EXPECT_EQ(valuesOf(layerAt(cells(), -7.0f), "x"), (std::vector<float>{0.0f, 3.0f}));
  EXPECT_EQ(valuesOf(layerAt(cells(), 7.0f), "x"), (std::vector<float>{2.0f, 5.0f}));
}

TEST(CoverageLayer, CellsAreAsLargeAsTheLeastDistanceOfNeighbours) {
  EXPECT_FLOAT_EQ(cellSizeOf(cells()), 0.5f);  // in height; 1 m along x, one y
  auto alone = cells();
  sensor_msgs::PointCloud2Modifier(alone).resize(1);
  EXPECT_TRUE(std::isinf(cellSizeOf(alone)));
  EXPECT_TRUE(std::isinf(cellSizeOf(sensor_msgs::PointCloud2())));
}

TEST(CoverageLayer, OfNothingIsEmpty) {
  auto nothing = cells();
  sensor_msgs::PointCloud2Modifier(nothing).resize(0);
  EXPECT_EQ(layerAt(nothing, 1.0f).width, 0U);
}

}  // namespace
}  // namespace wiimote_tracker::panel
