#include "calibrate_page.h"

#include "big_words.h"
#include "figure.h"
#include "number_box.h"
#include "square_drawing.h"

#include <QCheckBox>
#include <QComboBox>
#include <QFontMetrics>
#include <QGridLayout>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QProgressBar>
#include <QPushButton>
#include <QScrollArea>
#include <QTableWidget>
#include <QVBoxLayout>
#include <QWheelEvent>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace wiimote_tracker::panel {
namespace {

constexpr int kMostRemarks = 6;
constexpr int kSentenceLines = 3;
constexpr int kAdviceMargin = 9;  // around the advice [px of the screen]
// In metres. So wide that a number in cm can be typed whole: the node then doubts it.
constexpr double kLongestSide = 9999.0;
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

/// How right points are, and what to measure next to improve that; empty: not known.
QString measurementWords(const wiimote_tracker_msgs::CalibrationVerdict& verdict) {
  QString words;
  if (verdict.expected_error > 0.0)
    words += "\nExpected error at the corners and above them: " +
             figure(1e3 * verdict.expected_error, 1) + " mm (RMS).";
  if (!verdict.next_measurement.empty())
    words += "\nBest to measure next: " + text(verdict.next_measurement);
  return words;
}

/// Of a corner. The wheel scrolls the page.
class CornerBox : public QComboBox {
 public:
  using QComboBox::QComboBox;

 protected:
  void wheelEvent(QWheelEvent* event) override { event->ignore(); }
};

/// @param none what 0 stands for
QDoubleSpinBox* lengthBox(const QString& name, const QString& none, QWidget* parent) {
  auto* box = new NumberBox(parent);
  box->setObjectName(name);
  box->setRange(0.0, kLongestSide);
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
  layout->addWidget(verdict_ = wrappedLabel("verdict", content));
  addTable(layout);
  addLengths(layout);
  addButtons(layout);
  addFile(layout);
  addPlace(layout);
  addTape(layout);
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
  connect(next_, &QPushButton::clicked, this, [this] { sendFilled(advice_.request); });
  advice->addWidget(progress_ = new QProgressBar(this));
  progress_->setRange(0, 100);
  advice->addWidget(answer_ = wrappedLabel("answer", this));
}

QPushButton* CalibratePage::addButton(const QString& words, const std::string& service) {
  auto* button = new QPushButton(words, this);
  button->setObjectName(words);
  connect(button, &QPushButton::clicked, this, [this, service] { sendFilled({service}); });
  if (service != "cancel")
    buttons_.push_back(button);
  return button;
}

/// Quality of each camera.
void CalibratePage::addTable(QVBoxLayout* layout) {
  layout->addWidget(table_ = new QTableWidget(0, 6, this));
  table_->setObjectName("table");
  table_->setHorizontalHeaderLabels({"camera", "px", "mm", "fits %", "± mm", "± °"});
  const QStringList meanings = {"",
                                "residual in the image [px]",
                                "residual at the distance of the LED [mm]",
                                "share of the spots that fit",
                                "standard deviation of the camera's place",
                                "standard deviation of the camera's orientation"};
  for (int column = 0; column < meanings.size(); ++column)
    table_->horizontalHeaderItem(column)->setToolTip(meanings[column]);
  table_->verticalHeader()->hide();
  table_->horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
  table_->horizontalHeader()->setSectionResizeMode(0, QHeaderView::ResizeToContents);
  table_->setEditTriggers(QAbstractItemView::NoEditTriggers);
  table_->setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
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
}

void CalibratePage::addButtons(QVBoxLayout* layout) {
  auto* rows = new QGridLayout;
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
    Request request;
    request.service = "hands_free";
    request.on = on;
    send_(request);
  });
  rows->addWidget(hands_free_, 3, 0, 1, 2);
  layout->addLayout(rows);
}

void CalibratePage::addFile(QVBoxLayout* layout) {
  auto* file = new QHBoxLayout;
  file->addWidget(path_ = new QLineEdit(this), 1);
  path_->setPlaceholderText("parameter rig_file");
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
  for (int i = 0; i < 3; ++i) {
    known_[i] = new NumberBox(this);
    known_[i]->setObjectName(QStringList({"x", "y", "z"})[i]);
    known_[i]->setRange(-kFarthest, kFarthest);
    known_[i]->setDecimals(3);
    known_[i]->setPrefix(QStringList({"x ", "y ", "z "})[i]);
    known_[i]->setToolTip("a place that you know, in the world [m]");
    known_[i]->setMinimumWidth(60);
    row->addWidget(known_[i], 0, i + 1);
    row->setColumnStretch(i + 1, 1);
  }
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
  for (int i = 0; i < 2; ++i) {
    ends_[i] = new CornerBox(this);
    ends_[i]->setObjectName(QStringList({"from", "to"})[i]);
    ends_[i]->addItems({"1", "2", "3", "4"});
    row->addWidget(ends_[i]);
    row->addWidget(new QLabel(QStringList({"to", "is"})[i], this));
  }
  ends_[1]->setCurrentIndex(2);  // a diagonal
  row->addWidget(taped_ = lengthBox("taped", "drop it", this), 1);
  taped_->setMaximum(M_SQRT2 * kLongestSide);
  taped_->setDecimals(4);
  row->addWidget(addButton("Take length", "measure_length"));
  layout->addLayout(row);
}

/// Adds what was typed.
void CalibratePage::sendFilled(Request request) {
  request.side = side();
  request.without_square = request.service == "start" && without_square_->isChecked();
  if (request.service == "start_wave" || request.without_square)
    request.wand_length = wandLength();
  request.path = path().toStdString();
  for (std::size_t i = 0; i < 3; ++i)
    request.known[i] = known_[i]->value();
  for (std::size_t i = 0; i < 2; ++i)
    request.ends[i] = ends_[i]->currentIndex();
  request.length = taped_->value();
  send_(request);
}

double CalibratePage::side() const {
  return side_->value();
}
double CalibratePage::wandLength() const {
  return wand_length_->value();
}
QString CalibratePage::path() const {
  return path_->text();
}

void CalibratePage::restore(double side, double wand_length, const QString& path) {
  side_->setValue(side);
  wand_length_->setValue(wand_length);
  path_->setText(path);
}

void CalibratePage::show(const Guide& guide, double now) {
  advice_ = guide.advice(now);
  showWords(guide, advice_);
  const bool is_there = !guide.isSilent(now);
  if (!is_there)
    remarks_->hide();  // They are old.
  const bool is_free = is_there && !guide.isWaiting();
  next_->setVisible(!advice_.button.empty());
  next_->setText(text(advice_.button));
  next_->setEnabled(is_free);
  for (QPushButton* button : buttons_)
    button->setEnabled(is_free && !guide.isBusy());
  cancel_->setEnabled(is_there && (guide.isBusy() || !guide.running().empty()));
  hands_free_->setEnabled(is_free);
  if (guide.status()) {
    const std::uint8_t step = guide.status()->step;
    square_->setVisible(step != guide.status()->SAVED &&
                        (step != guide.status()->SOLVED || advice_.request.corner >= 0));
    square_->show(*guide.status(), advice_.request.corner);
    if (!guide.isWaiting())
      hands_free_->setChecked(guide.status()->hands_free != 0);
  }
  showVerdict(guide.verdict());
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

void CalibratePage::showVerdict(const wiimote_tracker_msgs::CalibrationVerdict* verdict) {
  const std::string rig = verdict ? verdict->rig_id : "";
  verdict_->setVisible(verdict != nullptr);
  table_->setVisible(verdict != nullptr);
  if (rig == shown_rig_)
    return;
  shown_rig_ = rig;
  if (!verdict)
    return;
  verdict_->setText(text(verdict->text) + measurementWords(*verdict));
  table_->setRowCount(static_cast<int>(verdict->cameras.size()));
  for (int row = 0; row < table_->rowCount(); ++row) {
    const auto& camera = verdict->cameras[static_cast<std::size_t>(row)];
    const std::array<QString, 6> cells = {text(camera.name),
                                          figure(camera.residual_px, 2),
                                          figure(1e3 * camera.residual_m, 1),
                                          figure(1e2 * camera.inlier_share, 0),
                                          figure(1e3 * camera.position_stddev, 1),
                                          figure(camera.rotation_stddev * 180.0 / M_PI, 3)};
    for (int column = 0; column < 6; ++column)
      table_->setItem(row, column, new QTableWidgetItem(cells[static_cast<std::size_t>(column)]));
  }
  table_->resizeRowsToContents();
  int height = table_->horizontalHeader()->sizeHint().height() + 2 * table_->frameWidth();
  for (int row = 0; row < table_->rowCount(); ++row)
    height += table_->rowHeight(row);
  table_->setFixedHeight(height);
}

}  // namespace wiimote_tracker::panel
