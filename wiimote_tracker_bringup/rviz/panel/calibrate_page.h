#pragma once

#include "guide.h"
#include "requests.h"

#include <QWidget>

#include <rviz/config.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QLineEdit;
class QProgressBar;
class QPushButton;
class QVBoxLayout;

namespace wiimote_tracker::panel {

class SquareDrawing;
class VerdictTable;

/// Leads through a calibration: the one thing to do next, the square, what is missing, the verdict.
class CalibratePage : public QWidget {
 public:
  /// @param send what the person asks for
  CalibratePage(QWidget* parent, std::function<void(const Request&)> send);

  void show(const Guide& guide, double now);

  /// What was typed, in the .rviz file.
  void load(const rviz::Config& config);
  void save(rviz::Config* config) const;

 private:
  /// A button, or the next step, may ask for this service; `fill` then writes what is typed into
  /// the request. Services without fields need not be added.
  template <class Service>
  void addRequest(
      const std::string& name,
      const std::function<void(typename Service::Request*)>& fill = [](auto*) {});
  void sendRequest(const std::string& name);
  QPushButton* addButton(const QString& text, const std::string& request);
  void addAdvice();
  void addLengths(QVBoxLayout* layout);
  void addButtons(QVBoxLayout* layout);
  void addFile(QVBoxLayout* layout);
  void addPlace(QVBoxLayout* layout);
  void addTape(QVBoxLayout* layout);
  void addCamera(QVBoxLayout* layout);
  void showWords(const Guide& guide, const Advice& advice);
  void offerCameras(const Guide& guide);

  std::function<void(const Request&)> send_;
  std::map<std::string, std::function<Request()>> requests_;  // by name, with what is typed
  Advice advice_;
  double proposed_at_ = -1.0;  // When a correction was proposed, or withdrawn [s].
  QLabel *title_, *sentence_, *answer_, *remarks_;
  QProgressBar* progress_;
  QPushButton* next_;
  SquareDrawing* square_;
  QDoubleSpinBox *side_, *wand_length_;  // [m]; 0: the node's side, no wand
  QCheckBox *without_square_, *hands_free_;
  QLineEdit* path_;  // of the rig file; empty: the node's
  VerdictTable* verdict_;
  QComboBox* camera_;
  QPushButton* cancel_;
  std::vector<QPushButton*> buttons_;  // that wait for an answer
};

}  // namespace wiimote_tracker::panel
