#pragma once

#include <QColor>
#include <QImage>

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::panel {

/// Of the lightest to the darkest pixel, as defined by WCAG 2 (there at least 4.5 for texts).
inline double contrastOf(const QImage& image) {
  double lightest = 0.0, darkest = 1.0;
  for (int x = 0; x < image.width(); ++x) {
    for (int y = 0; y < image.height(); ++y) {
      const QColor color = image.pixelColor(x, y);
      const auto linear = [](double v) {
        return v <= 0.03928 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
      };
      const double luminance = 0.2126 * linear(color.redF()) + 0.7152 * linear(color.greenF()) +
                               0.0722 * linear(color.blueF());
      lightest = std::max(lightest, luminance);
      darkest = std::min(darkest, luminance);
    }
  }
  return (lightest + 0.05) / (darkest + 0.05);
}

}  // namespace wiimote_tracker::panel
