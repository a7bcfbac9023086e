#include "seen_at.h"

#include <QFontMetrics>
#include <QGuiApplication>
#include <QRectF>

#include <OgreCamera.h>
#include <OgreEntity.h>
#include <OgreMesh.h>
#include <OgreSceneNode.h>
#include <OgreViewport.h>
#include <rviz/default_plugin/marker_array_display.h>
#include <rviz/display_context.h>
#include <rviz/ogre_helpers/movable_text.h>
#include <rviz/render_panel.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <pluginlib/class_list_macros.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace wiimote_tracker::panel {
namespace {

constexpr float kDark = 0.35f;         // share of a text's brightness on a light ground
constexpr float kSmallestBall = 0.7f;  // share of a text's height
constexpr float kWidth = 1.25f;        // of rviz's letters, which are drawn wider than the window's

bool isLight(const Ogre::ColourValue& color) {
  return color.r + color.g + color.b > 1.5f;
}

/// The colour, darker on a light ground and brighter on a dark one where it would not be seen.
Ogre::ColourValue readable(const Ogre::ColourValue& color, const Ogre::ColourValue& ground) {
  if (isLight(color) != isLight(ground))
    return color;
  const float factor = isLight(ground) ? kDark : 1.0f / kDark;
  const auto changed = [&](float part) { return std::min(factor * part, 1.0f); };
  return Ogre::ColourValue(changed(color.r), changed(color.g), changed(color.b), color.a);
}

/// The box, moved up to where it covers none of the others [px, y upwards].
QRectF clearOf(const std::vector<QRectF>& others, QRectF box) {
  for (bool moved = true; moved;) {
    moved = false;
    for (const QRectF& other : others) {
      if (!other.intersects(box))
        continue;
      box.moveTop(other.bottom());
      moved = true;
    }
  }
  return box;
}

bool isBall(const Ogre::Entity& shape, const Ogre::Vector3& size) {
  const auto [least, most] = std::minmax({std::abs(size.x), std::abs(size.y), std::abs(size.z)});
  return shape.getMesh()->getName() == "rviz_sphere.mesh" && most < 1.001f * least;
}

/// What is drawn at a node and below it.
template <typename Function>
void forEachObject(Ogre::SceneNode* node, const Function& function) {
  for (unsigned short i = 0; i < node->numAttachedObjects(); ++i)
    function(node->getAttachedObject(i));
  for (unsigned short i = 0; i < node->numChildren(); ++i)
    forEachObject(static_cast<Ogre::SceneNode*>(node->getChild(i)), function);
}

}  // namespace

/// Markers whose texts are as high as those of the window at any distance, dark on a light ground
/// and light on a dark one. Where one would cover another, it stands above it. Balls, such as LEDs,
/// are not much smaller; ellipsoids keep their size.
class ReadableMarkers : public rviz::MarkerArrayDisplay {
 public:
  void update(float wall_dt, float ros_dt) override {
    rviz::MarkerArrayDisplay::update(wall_dt, ros_dt);
    const rviz::ViewController* view = context_->getViewManager()->getCurrent();
    if (view && view->getCamera()->getViewport())
      fit(*view->getCamera(), *view->getCamera()->getViewport());
  }

 private:
  void fit(const Ogre::Camera& camera, const Ogre::Viewport& view) {
    std::vector<QRectF> drawn;
    forEachObject(scene_node_, [&](Ogre::MovableObject* object) {
      const Ogre::Vector3 place = object->getParentSceneNode()->_getDerivedPosition();
      const std::optional<Seen> seen = seenAt(place, camera, view);
      if (!seen)
        return;
      if (auto* text = dynamic_cast<rviz::MovableText*>(object))
        fitText(*seen, view.getBackgroundColour(), text, &drawn);
      else if (auto* shape = dynamic_cast<Ogre::Entity*>(object))
        fitShape(*seen, *shape);
    });
  }

  /// @param drawn where the texts before are [px], to which this one is added
  static void fitText(const Seen& seen,
                      const Ogre::ColourValue& ground,
                      rviz::MovableText* text,
                      std::vector<QRectF>* drawn) {
    const float scale = lineHeight() * seen.pixel_size / text->getCharacterHeight();
    text->getParentSceneNode()->setScale(scale, scale, scale);
    // Not across what it names.
    text->setTextAlignment(rviz::MovableText::H_CENTER, rviz::MovableText::V_ABOVE);
    QSizeF size = qGuiApp->devicePixelRatio() *
                  QSizeF(QFontMetrics(QGuiApplication::font())
                             .size(0, QString::fromStdString(text->getCaption())));
    size.rwidth() *= kWidth;
    const QPointF left(seen.point - QPointF(0.5 * size.width(), 0.0));
    drawn->push_back(clearOf(*drawn, QRectF(left, size)));
    const auto rise = static_cast<float>(drawn->back().top() - left.y());
    text->setLocalTranslation(Ogre::Vector3(0.0f, rise * seen.pixel_size, 0.0f));
    const Ogre::ColourValue color = readable(text->getColor(), ground);
    if (color != text->getColor())
      text->setColor(color);
  }

  /// The next message gives the shape its own size again.
  static void fitShape(const Seen& seen, const Ogre::Entity& shape) {
    Ogre::SceneNode* const node = shape.getParentSceneNode()->getParentSceneNode();
    const Ogre::Vector3 size = node->getScale();  // rviz turns it, so that one is negative
    const float share = std::abs(size.x) / (kSmallestBall * lineHeight() * seen.pixel_size);
    if (isBall(shape, size) && share < 1.0f)
      node->setScale(size / share);
  }

  /// Of the window's text [px of the view].
  static float lineHeight() {
    return static_cast<float>(QFontMetrics(QGuiApplication::font()).height() *
                              qGuiApp->devicePixelRatio());
  }
};

}  // namespace wiimote_tracker::panel

PLUGINLIB_EXPORT_CLASS(wiimote_tracker::panel::ReadableMarkers, rviz::Display)
