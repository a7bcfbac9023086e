#ifndef WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_CALIBRATE_PAGE_H
#define WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_CALIBRATE_PAGE_H

#include "guide.h"

#include <QWidget>

#include <functional>
#include <vector>

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QLineEdit;
class QProgressBar;
class QPushButton;
class QTableWidget;
class QVBoxLayout;

namespace wiimote_tracker::panel {

class BigWords;
class SquareDrawing;

/// Leads through a calibration: the one thing to do next, the square, what is missing, the verdict.
class CalibratePage : public QWidget {
 public:
  /// @param send what the person asks for
  CalibratePage(QWidget* parent, std::function<void(const Request&)> send);

  void show(const Guide& guide, double now);

  /// What the .rviz file keeps.
  double side() const;        ///< [m]; 0: the node's
  double wandLength() const;  ///< [m]; 0: one LED
  QString path() const;       ///< Of the rig file; empty: the node's.
  void restore(double side, double wand_length, const QString& path);

 private:
  QPushButton* addButton(const QString& text, const std::string& service);
  void addAdvice();
  void addTable(QVBoxLayout* layout);
  void addLengths(QVBoxLayout* layout);
  void addButtons(QVBoxLayout* layout);
  void addFile(QVBoxLayout* layout);
  void addPlace(QVBoxLayout* layout);
  void addTape(QVBoxLayout* layout);
  void sendFilled(Request request);
  void showWords(const Guide& guide, const Advice& advice);
  void showVerdict(const wiimote_tracker_msgs::CalibrationVerdict* verdict);

  std::function<void(const Request&)> send_;
  Advice advice_;
  BigWords* title_;
  QLabel *sentence_, *answer_, *remarks_, *verdict_;
  QProgressBar* progress_;
  QPushButton* next_;
  SquareDrawing* square_;
  QDoubleSpinBox *side_, *wand_length_;
  QDoubleSpinBox* known_[3];
  QComboBox* ends_[2];
  QDoubleSpinBox* taped_;
  QCheckBox *without_square_, *hands_free_;
  QLineEdit* path_;
  QTableWidget* table_;
  QPushButton* cancel_;
  std::vector<QPushButton*> buttons_;  // that wait for an answer
  std::string shown_rig_;
};

}  // namespace wiimote_tracker::panel

#endif  // WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_CALIBRATE_PAGE_H
