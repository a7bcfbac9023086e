#include "calibrate_page.h"

#include "big_words.h"
#include "boxes.h"
#include "square_drawing.h"
#include "verdict_table.h"

#include <QCheckBox>
#include <QFontMetrics>
#include <QGridLayout>
#include <QLabel>
#include <QLineEdit>
#include <QProgressBar>
#include <QPushButton>
#include <QScrollArea>
#include <QStringList>
#include <QVBoxLayout>

#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>
#include <wiimote_tracker_msgs/CheckConnection.h>
#include <wiimote_tracker_msgs/CheckPlace.h>
#include <wiimote_tracker_msgs/LearnMasks.h>
#include <wiimote_tracker_msgs/LoadRig.h>
#include <wiimote_tracker_msgs/MeasureLength.h>
#include <wiimote_tracker_msgs/RecalibrateCamera.h>
#include <wiimote_tracker_msgs/RemoveCamera.h>
#include <wiimote_tracker_msgs/SaveRig.h>
#include <wiimote_tracker_msgs/SolveCalibration.h>
#include <wiimote_tracker_msgs/StartCalibration.h>
#include <wiimote_tracker_msgs/StartWave.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace wiimote_tracker::panel {

using namespace wiimote_tracker_msgs;

namespace {

constexpr int kMostRemarks = 6;
constexpr int kSentenceLines = 3;
// Whoever presses the button sooner means what was next before.
constexpr double kReadWithin = 0.5;  // [s]
constexpr int kAdviceMargin = 9;     // around the advice [px of the screen]
// In metres. So wide that a number in cm can be typed whole: the node then doubts it.
constexpr double kFarthest = 9999.0;

QString text(const std::string& words) {
  return QString::fromStdString(words);
}

QLabel* wrappedLabel(const QString& name, QWidget* parent) {
  auto* label = new QLabel(parent);
  label->setObjectName(name);
  label->setWordWrap(true);
  label->setTextInteractionFlags(Qt::TextSelectableByMouse);
  return label;
}

/// @param none what 0 stands for
QDoubleSpinBox* lengthBox(const QString& name, const QString& none, QWidget* parent) {
  auto* box = new NumberBox(parent);
  box->setObjectName(name);
  box->setRange(0.0, kFarthest);
  box->setDecimals(3);
  box->setMinimumWidth(60);
  box->setSingleStep(0.1);
  box->setSuffix(" m");
  box->setSpecialValueText(none);
  return box;
}

}  // namespace

CalibratePage::CalibratePage(QWidget* parent, std::function<void(const Request&)> send)
    : QWidget(parent), send_(std::move(send)) {
  addAdvice();
  auto* content = new QWidget;
  auto* layout = new QVBoxLayout(content);
  layout->addWidget(square_ = new SquareDrawing(content));
  square_->setObjectName("square");
  layout->addWidget(remarks_ = wrappedLabel("remarks", content));
  layout->addWidget(verdict_ = new VerdictTable(content));
  addLengths(layout);
  addButtons(layout);
  addFile(layout);
  addPlace(layout);
  addTape(layout);
  addCamera(layout);
  layout->addStretch();

  auto* scroll = new QScrollArea(this);
  scroll->setFrameShape(QFrame::NoFrame);
  scroll->setWidgetResizable(true);
  scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  scroll->setWidget(content);
  scroll->viewport()->setAutoFillBackground(false);  // the ground is the page's
  content->setAutoFillBackground(false);
  this->layout()->addWidget(scroll);
}

/// What to do next, which does not scroll.
void CalibratePage::addAdvice() {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  auto* advice = new QVBoxLayout;
  advice->setContentsMargins(kAdviceMargin, kAdviceMargin, kAdviceMargin, 0);
  layout->addLayout(advice);
  advice->addWidget(title_ = new BigWords(this));
  title_->setObjectName("title");
  advice->addWidget(sentence_ = wrappedLabel("sentence", this));
  QFont larger = font();
  larger.setPointSizeF(1.25 * larger.pointSizeF());
  sentence_->setFont(larger);
  sentence_->setAlignment(Qt::AlignTop);
  // The button stays in its place.
  sentence_->setMinimumHeight(kSentenceLines * QFontMetrics(larger).lineSpacing());
  advice->addWidget(next_ = new QPushButton(this));
  next_->setObjectName("next");
  next_->setFont(larger);
  next_->setMinimumHeight(44);
  connect(next_, &QPushButton::clicked, this, [this] { sendRequest(advice_.request); });
  requests_["capture_corner"] = [this] {
    return Request{"capture_corner", [corner = advice_.corner](Requests* requests) {
                     return requests->captureCorner(corner);
                   }};
  };
  advice->addWidget(progress_ = new QProgressBar(this));
  progress_->setRange(0, 100);
  advice->addWidget(answer_ = wrappedLabel("answer", this));
}

template <class Service>
void CalibratePage::addRequest(const std::string& name,
                               const std::function<void(typename Service::Request*)>& fill) {
  requests_[name] = [name, fill] {
    typename Service::Request arguments;
    fill(&arguments);
    return requestOf<Service>(name, arguments);
  };
}

void CalibratePage::sendRequest(const std::string& name) {
  const auto request = requests_.find(name);
  send_(request != requests_.end() ? request->second() : requestOf<std_srvs::Trigger>(name));
}

QPushButton* CalibratePage::addButton(const QString& words, const std::string& request) {
  auto* button = new QPushButton(words, this);
  button->setObjectName(words);
  connect(button, &QPushButton::clicked, this, [this, request] { sendRequest(request); });
  if (request != "cancel")
    buttons_.push_back(button);
  return button;
}

void CalibratePage::addLengths(QVBoxLayout* layout) {
  auto* row = new QGridLayout;
  row->addWidget(new QLabel("Side of the square", this), 0, 0);
  row->addWidget(side_ = lengthBox("side", "parameter side_length", this), 0, 1);
  row->addWidget(new QLabel("Wand", this), 1, 0);
  row->addWidget(wand_length_ = lengthBox("wand", "none, one LED", this), 1, 1);
  without_square_ = new QCheckBox("No square: the wand lies on the floor first", this);
  without_square_->setObjectName("without_square");
  row->addWidget(without_square_, 2, 0, 1, 2);
  row->setColumnStretch(1, 1);
  layout->addLayout(row);
  addRequest<StartCalibration>("start", [this](auto* start) {
    start->side_x = side_->value();
    start->without_square = static_cast<std::uint8_t>(without_square_->isChecked());
    start->wand_length = start->without_square ? wand_length_->value() : 0.0;
  });
  addRequest<StartWave>("start_wave",
                        [this](auto* wave) { wave->wand_length = wand_length_->value(); });
}

void CalibratePage::addButtons(QVBoxLayout* layout) {
  auto* rows = new QGridLayout;
  addRequest<LearnMasks>("learn_masks");
  addRequest<CheckConnection>("check_connection");
  addRequest<SolveCalibration>("solve");
  rows->addWidget(addButton("Learn the lights", "learn_masks"), 0, 0);
  rows->addWidget(addButton("Check the cameras", "check_connection"), 0, 1);
  rows->addWidget(addButton("Start again", "start"), 1, 0);
  QPushButton* undo = addButton("Undo", "undo");
  undo->setToolTip(
      "drops a length taken last, else the last place to solve with, else the wave, else the last "
      "corner");
  rows->addWidget(undo, 1, 1);
  rows->addWidget(addButton("Solve now", "solve"), 2, 0);
  rows->addWidget(cancel_ = addButton("Stop", "cancel"), 2, 1);
  hands_free_ = new QCheckBox("Capture a corner when the LED is held still", this);
  hands_free_->setObjectName("hands_free");
  connect(hands_free_, &QCheckBox::clicked, this, [this](bool on) {
    std_srvs::SetBoolRequest switched;
    switched.data = static_cast<std::uint8_t>(on);
    send_(requestOf<std_srvs::SetBool>("hands_free", switched));
  });
  rows->addWidget(hands_free_, 3, 0, 1, 2);
  layout->addLayout(rows);
}

void CalibratePage::addFile(QVBoxLayout* layout) {
  auto* file = new QHBoxLayout;
  file->addWidget(path_ = new QLineEdit(this), 1);
  path_->setPlaceholderText("parameter rig_file");
  const auto fillPath = [this](auto* file) { file->path = path_->text().toStdString(); };
  addRequest<SaveRig>("save", fillPath);
  addRequest<LoadRig>("load", fillPath);
  file->addWidget(addButton("Save", "save"));
  file->addWidget(addButton("Load", "load"));
  QPushButton* revert = addButton("Revert", "continuous/revert");
  revert->setToolTip("goes back to the rig before the last change of continuous calibration");
  file->addWidget(revert);
  layout->addLayout(file);
}

/// To check the rig at a place that is known, or to solve with it.
void CalibratePage::addPlace(QVBoxLayout* layout) {
  auto* row = new QGridLayout;
  row->addWidget(new QLabel("LED at", this), 0, 0);
  std::array<NumberBox*, 3> known{};
  for (int i = 0; i < 3; ++i) {
    auto* box = known[static_cast<std::size_t>(i)] = new NumberBox(this);
    box->setObjectName(QStringList({"x", "y", "z"})[i]);
    box->setRange(-kFarthest, kFarthest);
    box->setDecimals(3);
    box->setPrefix(box->objectName() + " ");
    box->setToolTip("a place that you know, in the world [m]");
    box->setMinimumWidth(60);
    row->addWidget(box, 0, i + 1);
    row->setColumnStretch(i + 1, 1);
  }
  for (const char* name : {"check", "measure_place"})
    addRequest<CheckPlace>(name, [known](auto* place) {
      place->known.x = known[0]->value();
      place->known.y = known[1]->value();
      place->known.z = known[2]->value();
    });
  auto* buttons = new QHBoxLayout;
  buttons->addWidget(addButton("Check the LED there", "check"));
  buttons->addWidget(addButton("Take this place", "measure_place"));
  row->addLayout(buttons, 1, 0, 1, 4);
  layout->addLayout(row);
}

/// To solve with a length between two corners.
void CalibratePage::addTape(QVBoxLayout* layout) {
  auto* row = new QHBoxLayout;
  row->addWidget(new QLabel("Corner", this));
  std::array<ChoiceBox*, 2> ends{};
  for (int i = 0; i < 2; ++i) {
    auto* box = ends[static_cast<std::size_t>(i)] = new ChoiceBox(this);
    box->setObjectName(QStringList({"from", "to"})[i]);
    box->addItems({"1", "2", "3", "4"});
    row->addWidget(box);
    row->addWidget(new QLabel(QStringList({"to", "is"})[i], this));
  }
  ends[1]->setCurrentIndex(2);  // a diagonal
  auto* length = lengthBox("taped", "drop it", this);
  length->setMaximum(M_SQRT2 * kFarthest);
  length->setDecimals(4);
  row->addWidget(length, 1);
  addRequest<MeasureLength>("measure_length", [ends, length](auto* taped) {
    taped->from_corner = static_cast<std::uint32_t>(ends[0]->currentIndex());
    taped->to_corner = static_cast<std::uint32_t>(ends[1]->currentIndex());
    taped->length = length->value();
  });
  row->addWidget(addButton("Take length", "measure_length"));
  layout->addLayout(row);
}

/// To solve one camera of the rig again, to add one, or to remove one.
void CalibratePage::addCamera(QVBoxLayout* layout) {
  auto* row = new QHBoxLayout;
  row->addWidget(camera_ = new ChoiceBox(this), 1);
  camera_->setObjectName("camera");
  const auto fillCamera = [this](auto* one) { one->camera = camera_->currentText().toStdString(); };
  addRequest<RecalibrateCamera>("recalibrate_camera", fillCamera);
  addRequest<RemoveCamera>("remove_camera", fillCamera);
  QPushButton* solve = addButton("Solve or add it", "recalibrate_camera");
  solve->setToolTip("solves this camera again, or adds it to the rig, while you wave the LED");
  row->addWidget(solve);
  row->addWidget(addButton("Remove it", "remove_camera"));
  layout->addLayout(row);
}

/// Cameras of the rig, and those that are there, can be chosen. What was chosen stays so.
void CalibratePage::offerCameras(const Guide& guide) {
  QStringList names;
  const auto offer = [&names](const auto& cameras) {
    for (const auto& camera : cameras)
      names << text(camera.name);
  };
  if (guide.verdict())
    offer(guide.verdict()->cameras);
  if (guide.status())
    offer(guide.status()->cameras);
  for (int i = camera_->count() - 1; i >= 0; --i) {
    if (i != camera_->currentIndex() && names.indexOf(camera_->itemText(i)) < 0)
      camera_->removeItem(i);
  }
  for (const QString& name : names) {
    if (camera_->findText(name) < 0)
      camera_->addItem(name);
  }
}

void CalibratePage::load(const rviz::Config& config) {
  side_->setValue(config.mapGetChild("Side of Square").getValue().toDouble());
  wand_length_->setValue(config.mapGetChild("Length of Wand").getValue().toDouble());
  path_->setText(config.mapGetChild("Rig File").getValue().toString());
}

void CalibratePage::save(rviz::Config* config) const {
  config->mapSetValue("Side of Square", side_->value());
  config->mapSetValue("Length of Wand", wand_length_->value());
  config->mapSetValue("Rig File", path_->text());
}

void CalibratePage::show(const Guide& guide, double now) {
  const Advice before = std::exchange(advice_, guide.advice(now));
  showWords(guide, advice_);
  const bool is_there = !guide.isSilent(now);
  if (!is_there)
    remarks_->hide();  // They are old.
  const bool is_free = is_there && !guide.isWaiting();
  next_->setVisible(!advice_.button.empty());
  next_->setText(text(advice_.button));
  // A correction may be proposed, or withdrawn, at any time.
  const std::string proposed = "continuous/apply";
  const bool was_proposed = before.request == proposed;
  if (!before.button.empty() && was_proposed != (advice_.request == proposed))
    proposed_at_ = now;
  next_->setEnabled(is_free && now >= proposed_at_ + kReadWithin);
  for (QPushButton* button : buttons_)
    button->setEnabled(is_free && !guide.isBusy());
  cancel_->setEnabled(is_there && (guide.isBusy() || !guide.running().empty()));
  hands_free_->setEnabled(is_free);
  if (guide.status()) {
    const std::uint8_t step = guide.status()->step;
    square_->setVisible(step != guide.status()->SAVED &&
                        (step != guide.status()->SOLVED || advice_.corner >= 0));
    square_->show(*guide.status(), advice_.corner);
    if (!guide.isWaiting())
      hands_free_->setChecked(guide.status()->hands_free != 0);
  }
  verdict_->show(guide.verdict());
  offerCameras(guide);
}

void CalibratePage::showWords(const Guide& guide, const Advice& advice) {
  title_->setText(text(advice.title));
  sentence_->setText(text(advice.sentence));
  const std::string answer = guide.answer();
  // The verdict stands below, too.
  answer_->setText(guide.verdict() && answer == guide.verdict()->text ? "" : text(answer));
  progress_->setValue(static_cast<int>(100.0 * guide.progress()));
  QString list;
  const std::vector<std::string> remarks = guide.remarks();
  for (int i = 0; i < std::min<int>(kMostRemarks, static_cast<int>(remarks.size())); ++i)
    list += "• " + text(remarks[static_cast<std::size_t>(i)]) + "\n";
  if (remarks.size() > kMostRemarks)
    list += QString("• and %1 more").arg(remarks.size() - kMostRemarks);
  remarks_->setText(list.trimmed());
  remarks_->setVisible(!list.isEmpty());
}

}  // namespace wiimote_tracker::panel
