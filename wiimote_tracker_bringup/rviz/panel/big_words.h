#ifndef WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_BIG_WORDS_H
#define WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_BIG_WORDS_H

#include <QString>
#include <QWidget>

namespace wiimote_tracker::panel {

/// One or two words, as large as the width allows, to be read by somebody who walks the corners.
class BigWords : public QWidget {
 public:
  explicit BigWords(QWidget* parent);

  void setText(const QString& text);
  QString text() const { return text_; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  QString text_;
};

}  // namespace wiimote_tracker::panel

#endif  // WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_BIG_WORDS_H
