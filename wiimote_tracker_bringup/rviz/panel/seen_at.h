#pragma once

#include <QPointF>

#include <OgreCamera.h>
#include <OgreViewport.h>

#include <optional>

namespace wiimote_tracker::panel {

/// Where a place in the world is seen in the view.
struct Seen {
  QPointF point;            ///< From the middle of the view, y upwards [px].
  float pixel_size = 0.0f;  ///< Height of a pixel there [m].
};

/// Nothing behind the camera.
inline std::optional<Seen> seenAt(const Ogre::Vector3& place,
                                  const Ogre::Camera& camera,
                                  const Ogre::Viewport& view) {
  const Ogre::Matrix4& projection = camera.getProjectionMatrix();
  const Ogre::Vector4 clip = projection * (camera.getViewMatrix() * Ogre::Vector4(place));
  if (clip.w <= 0.0f)  // 1 where there is no perspective
    return std::nullopt;
  const float half_width = 0.5f * view.getActualWidth();
  const float half_height = 0.5f * view.getActualHeight();
  return Seen{{half_width * clip.x / clip.w, half_height * clip.y / clip.w},
              clip.w / (projection[1][1] * half_height)};
}

}  // namespace wiimote_tracker::panel
