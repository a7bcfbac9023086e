#include "coverage_layer.h"
#include "seen_at.h"

#include <QApplication>
#include <QCursor>
#include <QToolTip>

#include <rviz/default_plugin/point_cloud2_display.h>
#include <rviz/display_context.h>
#include <rviz/frame_manager.h>
#include <rviz/properties/bool_property.h>
#include <rviz/properties/float_property.h>
#include <rviz/render_panel.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <boost/make_shared.hpp>
#include <pluginlib/class_list_macros.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace wiimote_tracker::panel {
namespace {

constexpr float kBoxShare = 0.16f;      // of a cell's size
constexpr double kLeastDistance = 6.0;  // from a box at which the cursor is on it [px]

}  // namespace

/// Cells of the volume, all or one horizontal layer. That under the cursor shows its numbers.
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
    shown_.reset();
    rviz::PointCloud2Display::reset();
  }

  void update(float wall_dt, float ros_dt) override {
    rviz::PointCloud2Display::update(wall_dt, ros_dt);
    rviz::RenderPanel* const view = context_->getViewManager()->getRenderPanel();
    const QPoint cursor = QCursor::pos();
    std::optional<std::size_t> cell;
    if (shown_ && QApplication::widgetAt(cursor) == view)
      cell = cellAt(view->mapFromGlobal(cursor), view);
    if (cell)
      QToolTip::showText(cursor, QString::fromStdString(numbersOf(*shown_, *cell)), view);
    else if (has_numbers_)
      QToolTip::hideText();
    has_numbers_ = cell.has_value();
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
    shown_ = slice_.getBool() ? boost::make_shared<const sensor_msgs::PointCloud2>(
                                    layerAt(*cells_, height_.getFloat()))
                              : cells_;
    rviz::PointCloud2Display::processMessage(shown_);
  }

  /// The foremost cell at a place of the view [px of the screen].
  std::optional<std::size_t> cellAt(const QPoint& place, rviz::RenderPanel* view) const {
    Ogre::Vector3 origin;
    Ogre::Quaternion turn;
    const Ogre::Camera* camera = view->getViewController()->getCamera();
    if (!context_->getFrameManager()->getTransform(shown_->header, origin, turn))
      return std::nullopt;
    const double scale = view->devicePixelRatioF();
    const QPointF cursor(scale * (place.x() - 0.5 * view->width()),
                         scale * (0.5 * view->height() - place.y()));
    std::optional<std::size_t> foremost;
    float pixel_size = std::numeric_limits<float>::infinity();
    const std::vector<std::array<float, 3>> cells = placesOf(*shown_);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto seen =
          seenAt(origin + turn * Ogre::Vector3(cells[i].data()), *camera, *camera->getViewport());
      if (!seen || seen->pixel_size >= pixel_size)
        continue;
      const QPointF distance = seen->point - cursor;
      const double half = 0.5 * kBoxShare * cell_size_ / seen->pixel_size + scale * kLeastDistance;
      if (std::max(std::abs(distance.x()), std::abs(distance.y())) > half)
        continue;
      foremost = i;
      pixel_size = seen->pixel_size;
    }
    return foremost;
  }

  /// A size that somebody sets is kept until there are cells of another size.
  void fitBoxes(float cell_size) {
    if (cell_size == cell_size_ || !std::isfinite(cell_size))
      return;
    cell_size_ = cell_size;
    subProp("Size (m)")->setValue(kBoxShare * cell_size);
  }

  sensor_msgs::PointCloud2ConstPtr cells_;
  sensor_msgs::PointCloud2ConstPtr shown_;  // of these
  float cell_size_ = 0.0f;                  // [m]
  bool has_numbers_ = false;                // whether those of a cell are shown
  rviz::BoolProperty slice_;
  rviz::FloatProperty height_;
};

}  // namespace wiimote_tracker::panel

PLUGINLIB_EXPORT_CLASS(wiimote_tracker::panel::CoverageCells, rviz::Display)
