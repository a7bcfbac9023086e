#pragma once

#include "health_view.h"

#include <QWidget>

class QTreeWidget;

namespace wiimote_tracker::panel {

/// The diagnostics, the worst first; a part unfolds to its numbers.
class HealthPage : public QWidget {
 public:
  explicit HealthPage(QWidget* parent);

  void show(const HealthView& health, double now);

 private:
  QTreeWidget* tree_;
  double shown_at_ = 0.0;
};

}  // namespace wiimote_tracker::panel
