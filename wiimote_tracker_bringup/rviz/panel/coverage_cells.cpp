#include "coverage_layer.h"

#include <rviz/default_plugin/point_cloud2_display.h>
#include <rviz/properties/bool_property.h>
#include <rviz/properties/float_property.h>
#include <boost/make_shared.hpp>
#include <pluginlib/class_list_macros.hpp>

#include <cmath>

namespace wiimote_tracker::panel {
namespace {

constexpr float kBoxShare = 0.16f;  // of a cell's size

}  // namespace

/// Cells of the volume, all or one horizontal layer. What is selected has its numbers in rviz's
/// panel Selection.
class CoverageCells : public rviz::PointCloud2Display {
 public:
  CoverageCells()
      : slice_("Slice", false, "Show only one horizontal layer of cells.", this),
        height_("Height", 1.0f, "Of the layer above the origin of the world [m].", &slice_) {
    slice_.setDisableChildrenIfFalse(true);
    for (const rviz::Property* property :
         {static_cast<rviz::Property*>(&slice_), static_cast<rviz::Property*>(&height_)})
      connect(property, &rviz::Property::changed, this, [this] { showCells(); });
  }

  /// For another topic or frame, and when it is switched off.
  void reset() override {
    cells_.reset();
    rviz::PointCloud2Display::reset();
  }

 protected:
  void processMessage(const sensor_msgs::PointCloud2ConstPtr& cells) override {
    cells_ = cells;
    fitBoxes(cellSizeOf(*cells));
    showCells();
  }

 private:
  void showCells() {
    if (!cells_)
      return;
    rviz::PointCloud2Display::processMessage(
        slice_.getBool() ? boost::make_shared<const sensor_msgs::PointCloud2>(
                               layerAt(*cells_, height_.getFloat()))
                         : cells_);
  }

  /// A size that somebody sets is kept until there are cells of another size.
  void fitBoxes(float cell_size) {
    if (cell_size == cell_size_ || !std::isfinite(cell_size))
      return;
    cell_size_ = cell_size;
    subProp("Size (m)")->setValue(kBoxShare * cell_size);
  }

  sensor_msgs::PointCloud2ConstPtr cells_;
  float cell_size_ = 0.0f;  // [m]
  rviz::BoolProperty slice_;
  rviz::FloatProperty height_;
};

}  // namespace wiimote_tracker::panel

PLUGINLIB_EXPORT_CLASS(wiimote_tracker::panel::CoverageCells, rviz::Display)
