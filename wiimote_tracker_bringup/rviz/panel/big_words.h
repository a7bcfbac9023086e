#pragma once

#include <QLabel>

namespace wiimote_tracker::panel {

/// One or two words, as large as the width allows, to be read by somebody who walks the corners.
class BigWords : public QLabel {
 public:
  explicit BigWords(QWidget* parent);

 protected:
  void paintEvent(QPaintEvent* event) override;
};

}  // namespace wiimote_tracker::panel
