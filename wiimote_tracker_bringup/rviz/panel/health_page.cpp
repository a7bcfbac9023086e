#include "health_page.h"

#include <QHeaderView>
#include <QPainter>
#include <QPixmap>
#include <QStyledItemDelegate>
#include <QTreeWidget>
#include <QVBoxLayout>

#include <set>

namespace wiimote_tracker::panel {
namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr double kShowPeriod = 1.0;  // as often as parts report [s]

/// A disc, legible on light and dark ground.
QIcon iconOf(std::uint8_t level) {
  const QColor color = level == DiagnosticStatus::OK      ? QColor(46, 158, 79)
                       : level == DiagnosticStatus::WARN  ? QColor(230, 140, 0)
                       : level == DiagnosticStatus::ERROR ? QColor(211, 60, 60)
                                                          : QColor(140, 145, 155);
  QPixmap pixmap(16, 16);
  pixmap.fill(Qt::transparent);
  QPainter painter(&pixmap);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(Qt::NoPen);
  painter.setBrush(color);
  painter.drawEllipse(3, 3, 10, 10);
  return QIcon(pixmap);
}

/// A wrapped item is as high as its words need in its column; Qt gives it a single line.
class WrappedItem : public QStyledItemDelegate {
 public:
  explicit WrappedItem(QTreeWidget* tree) : QStyledItemDelegate(tree), tree_(*tree) {}

  QSize sizeHint(const QStyleOptionViewItem& option, const QModelIndex& index) const override {
    const int depth = index.column() > 0 ? 0 : index.parent().isValid() ? 2 : 1;
    QStyleOptionViewItem in_column = option;
    in_column.rect = QRect(0, 0, tree_.columnWidth(index.column()) - depth * tree_.indentation(),
                           tree_.height());
    return QStyledItemDelegate::sizeHint(in_column, index);
  }

 private:
  const QTreeWidget& tree_;
};

}  // namespace

HealthPage::HealthPage(QWidget* parent) : QWidget(parent), tree_(new QTreeWidget(this)) {
  tree_->setObjectName("health");
  tree_->setHeaderLabels({"part", "state"});
  tree_->header()->resizeSection(0, 200);
  tree_->setWordWrap(true);
  tree_->setItemDelegate(new WrappedItem(tree_));
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(tree_);
}

void HealthPage::show(const HealthView& health, double now) {
  if (now - shown_at_ < kShowPeriod)
    return;
  shown_at_ = now;
  std::set<QString> unfolded;
  for (int i = 0; i < tree_->topLevelItemCount(); ++i) {
    if (tree_->topLevelItem(i)->isExpanded())
      unfolded.insert(tree_->topLevelItem(i)->toolTip(0));
  }
  tree_->clear();
  for (const DiagnosticStatus& part : health.parts(now)) {
    const QString name = QString::fromStdString(part.name);
    auto* item = new QTreeWidgetItem(
        tree_, {name.mid(name.indexOf(": ") + 1).trimmed(), QString::fromStdString(part.message)});
    item->setIcon(0, iconOf(part.level));
    item->setToolTip(0, name);  // with the node
    item->setToolTip(1, item->text(1));
    for (const auto& value : part.values) {
      auto* row = new QTreeWidgetItem(
          item, {QString::fromStdString(value.key), QString::fromStdString(value.value)});
      row->setToolTip(0, row->text(0));
      row->setToolTip(1, row->text(1));
    }
    item->setExpanded(unfolded.count(name) > 0);
  }
}

}  // namespace wiimote_tracker::panel
