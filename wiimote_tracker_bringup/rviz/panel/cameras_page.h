#pragma once

#include "tracker_view.h"

#include <QWidget>

#include <vector>

class QLabel;
class QScrollArea;

namespace wiimote_tracker::panel {

class CameraTile;

/// A tile per camera, as many side by side as fit; the rest scrolls.
class CamerasPage : public QWidget {
 public:
  explicit CamerasPage(QWidget* parent);

  void show(const TrackerView& view, double now);

 protected:
  void resizeEvent(QResizeEvent* event) override;

 private:
  void arrange();

  QLabel* summary_;
  QScrollArea* scroll_;
  std::vector<CameraTile*> tiles_;
};

}  // namespace wiimote_tracker::panel
