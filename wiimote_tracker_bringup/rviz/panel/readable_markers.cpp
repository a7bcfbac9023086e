#include <QFontMetrics>
#include <QGuiApplication>

#include <OgreCamera.h>
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

namespace wiimote_tracker::panel {
namespace {

constexpr float kDark = 0.35f;  // share of a text's brightness on a light ground

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

/// Height of a pixel at a place in the world [m]; 0 behind the camera.
float pixelAt(const Ogre::Vector3& place, const Ogre::Camera& camera, const Ogre::Viewport& view) {
  const Ogre::Matrix4& projection = camera.getProjectionMatrix();
  const Ogre::Vector4 seen = camera.getViewMatrix() * Ogre::Vector4(place);
  const float depth = (projection * seen).w;  // 1 where there is no perspective
  return std::max(2.0f * depth / (projection[1][1] * view.getActualHeight()), 0.0f);
}

}  // namespace

/// Markers whose texts are as high as those of the window at any distance, dark on a light ground
/// and light on a dark one.
class ReadableMarkers : public rviz::MarkerArrayDisplay {
 public:
  void update(float wall_dt, float ros_dt) override {
    rviz::MarkerArrayDisplay::update(wall_dt, ros_dt);
    const rviz::ViewController* view = context_->getViewManager()->getCurrent();
    if (view && view->getCamera()->getViewport())
      fitTexts(scene_node_, *view->getCamera(), *view->getCamera()->getViewport());
  }

 private:
  void fitTexts(Ogre::SceneNode* node, const Ogre::Camera& camera, const Ogre::Viewport& view) {
    for (unsigned short i = 0; i < node->numAttachedObjects(); ++i) {
      auto* text = dynamic_cast<rviz::MovableText*>(node->getAttachedObject(i));
      if (!text)
        continue;
      const float height = textHeight() * pixelAt(node->_getDerivedPosition(), camera, view);
      const float scale = height / text->getCharacterHeight();
      if (scale > 0.0f)
        node->setScale(scale, scale, scale);
      // Not across what it names.
      text->setTextAlignment(rviz::MovableText::H_CENTER, rviz::MovableText::V_ABOVE);
      const Ogre::ColourValue color = readable(text->getColor(), view.getBackgroundColour());
      if (color != text->getColor())
        text->setColor(color);
    }
    for (unsigned short i = 0; i < node->numChildren(); ++i)
      fitTexts(static_cast<Ogre::SceneNode*>(node->getChild(i)), camera, view);
  }

  /// Of a line in the window [px of the view].
  static float textHeight() {
    return static_cast<float>(QFontMetrics(QGuiApplication::font()).height() *
                              qGuiApp->devicePixelRatio());
  }
};

}  // namespace wiimote_tracker::panel

PLUGINLIB_EXPORT_CLASS(wiimote_tracker::panel::ReadableMarkers, rviz::Display)
