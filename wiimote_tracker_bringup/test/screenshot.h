#pragma once

#include <QApplication>
#include <QPixmap>
#include <QString>
#include <QWidget>

#include <cstdlib>

namespace wiimote_tracker::panel {

/// Draws a widget into NAME.png in the folder WIIMOTE_TRACKER_SCREENSHOTS, if that is set.
inline void screenshot(const QString& name, QWidget* widget) {
  const char* folder = std::getenv("WIIMOTE_TRACKER_SCREENSHOTS");
  for (int i = 0; folder && i < 5; ++i)
    QApplication::processEvents();  // lays out the new words
  if (folder)
    widget->grab().save(QString(folder) + "/" + name + ".png");
}

}  // namespace wiimote_tracker::panel
