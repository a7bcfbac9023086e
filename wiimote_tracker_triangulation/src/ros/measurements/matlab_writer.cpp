#include "ros/measurements/part_file.h"
#include "ros/measurements/writer.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <matio.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker::measurements {
namespace {

const char* const kReadme =
    "One row per LED and time. time [s since 1970]; stamp, the same exactly [ns since 1970]; "
    "triggered: interpolated for an external trigger; id of the track; label_confidence: "
    "probability that the label is right (NaN: not estimated), label_since: since when it stands "
    "[ns since 1970] (0: not estimated); position [m], velocity [m/s] (NaN: unknown) in the "
    "world frame; their covariances 3 x 3 x rows [m^2], [m^2/s^2]; rays_used of rays_possible "
    "cameras; residual: reprojection error [px]; last_observed [ns since 1970]; age of the track "
    "[s]; remapped: corrected within the measured volume. label, state, frame, rig_id, method: "
    "numbers of lines of labels, states, frames, rig_ids, methods.";

// The default header contains the date, but equal measurements must give equal files.
const char* const kFileHeader = "MATLAB 5.0 MAT-file, written by wiimote_tracker_triangulation";

struct FreeVariable {
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using Variable = std::unique_ptr<matvar_t, FreeVariable>;

struct Type {
  matio_classes in_memory;
  matio_types in_file;
};
Type typeOf(double) {
  return {MAT_C_DOUBLE, MAT_T_DOUBLE};
}
Type typeOf(std::int64_t) {
  return {MAT_C_INT64, MAT_T_INT64};
}
Type typeOf(std::uint32_t) {
  return {MAT_C_UINT32, MAT_T_UINT32};
}
Type typeOf(std::uint8_t) {
  return {MAT_C_UINT8, MAT_T_UINT8};
}

Variable text(const char* name, const std::string& words) {
  std::array<std::size_t, 2> size{words.empty() ? 0u : 1u, words.size()};
  return Variable(Mat_VarCreate(name, MAT_C_CHAR, MAT_T_UTF8, 2, size.data(),
                                const_cast<char*>(words.c_str()), 0));
}

/// Strings that repeat from row to row, each stored once.
class Words {
 public:
  void add(const std::string& word) {
    const auto [place, is_new] =
        numbers_.emplace(word, static_cast<std::uint32_t>(table_.size() + 1));
    if (is_new)
      table_.push_back(word);
    rows_.push_back(place->second);
  }

  const std::vector<std::uint32_t>& rows() const { return rows_; }

  Variable table(const std::string& name) const {
    std::array<std::size_t, 2> size{table_.size(), 1};
    Variable cells(Mat_VarCreate(name.c_str(), MAT_C_CELL, MAT_T_CELL, 2, size.data(), nullptr, 0));
    for (std::size_t i = 0; i < table_.size(); ++i)
      Mat_VarSetCell(cells.get(), static_cast<int>(i), text(nullptr, table_[i]).release());
    return cells;
  }

 private:
  std::map<std::string, std::uint32_t> numbers_;
  std::vector<std::string> table_;
  std::vector<std::uint32_t> rows_;
};

class MatlabWriter : public Writer {
 public:
  explicit MatlabWriter(const std::string& path) : path_(path) {
    createPart(path_);
    const auto stamp = [](const Measurement& m) { return nanosecondsOf(m.message.header.stamp); };
    addColumn<double>("time", [=](auto& m) { return 1e-9 * static_cast<double>(stamp(m)); });
    addColumn<std::int64_t>("stamp", stamp);
    addColumn<std::uint8_t>(
        "triggered", [](auto& m) { return m.triggered; }, MAT_F_LOGICAL);
    addColumn<std::uint32_t>("id", [](auto& m) { return m.led.id; });
    addWords("label", [](auto& m) { return m.led.label; });
    addColumn<double>("label_confidence", [](auto& m) { return m.led.label_confidence; });
    addColumn<std::int64_t>("label_since",
                            [](auto& m) { return nanosecondsOf(m.led.label_since); });
    addWords("state", [](auto& m) { return wordOf(m.led.state); });
    addMatrices("position", [](auto& m) { return vectorOf(m.led.position); });
    addMatrices("velocity", [](auto& m) { return vectorOf(m.led.velocity); });
    addMatrices("position_covariance",
                [](auto& m) { return matrixOf<3>(m.led.position_covariance); });
    addMatrices("velocity_covariance",
                [](auto& m) { return matrixOf<3>(m.led.velocity_covariance); });
    addColumn<std::uint32_t>("rays_used", [](auto& m) { return m.led.rays_used; });
    addColumn<std::uint32_t>("rays_possible", [](auto& m) { return m.led.rays_possible; });
    addColumn<double>("residual", [](auto& m) { return m.led.residual; });
    addColumn<std::int64_t>("last_observed",
                            [](auto& m) { return nanosecondsOf(m.led.last_observed); });
    addColumn<double>("age", [](auto& m) { return m.led.age; });
    addColumn<std::uint8_t>(
        "remapped", [](auto& m) { return m.led.remapped != 0; }, MAT_F_LOGICAL);
    addWords("frame", [](auto& m) { return m.message.header.frame_id; });
    addWords("rig_id", [](auto& m) { return m.message.rig_id; });
    addWords("method", [](auto& m) { return m.message.method; });
  }

  void add(const Measurement& measurement) override {
    for (const Column& column : columns_)
      column.add(measurement);
  }

  void finish() override {
    file_.reset(Mat_CreateVer(partOf(path_).c_str(), kFileHeader, MAT_FT_MAT5));
    if (!file_)
      failToWrite(path_, errno);
    write(text("readme", kReadme));
    for (const Column& column : columns_)
      column.write();
    if (Mat_Close(file_.release()) != 0)
      failToWrite(path_, errno);
    finishPart(path_);
  }

  void discard() override { ::unlink(partOf(path_).c_str()); }

 private:
  struct CloseFile {
    void operator()(mat_t* file) const { Mat_Close(file); }
  };

  /// One field of all measurements.
  struct Column {
    std::function<void(const Measurement&)> add;
    std::function<void()> write;
  };

  template <typename T, typename Field>
  void addColumn(const char* name, Field field, int flags = 0) {
    const auto values = std::make_shared<std::vector<T>>();
    columns_.push_back({[=](const Measurement& m) { values->push_back(static_cast<T>(field(m))); },
                        [=] {
                          writeArray(name, {values->size(), 1}, *values, flags);
                        }});
  }

  template <typename Field>
  void addWords(const std::string& name, Field field) {
    const auto words = std::make_shared<Words>();
    columns_.push_back({[=](const Measurement& m) { words->add(field(m)); },
                        [=] {
                          const auto& rows = words->rows();
                          writeArray(name.c_str(), {rows.size(), 1}, rows, 0);
                          write(words->table(name + "s"));
                        }});
  }

  /// Vectors: rows x 3; matrices: 3 x 3 x rows.
  template <typename Field>
  void addMatrices(const char* name, Field field) {
    using Matrix = decltype(field(std::declval<const Measurement&>()));
    const auto values = std::make_shared<std::vector<double>>();
    const auto add = [=](const Measurement& m) {
      const Matrix matrix = field(m);
      values->insert(values->end(), matrix.data(), matrix.data() + matrix.size());
    };
    const auto write = [=] {
      const std::size_t rows = values->size() / Matrix::SizeAtCompileTime;
      if (Matrix::ColsAtCompileTime == 1) {
        const Eigen::MatrixX3d columns =
            Eigen::Map<const Eigen::Matrix3Xd>(values->data(), 3, static_cast<Eigen::Index>(rows))
                .transpose();
        values->assign(columns.data(), columns.data() + columns.size());
        writeArray(name, {rows, 3}, *values, 0);
      } else {
        writeArray(name, {3, 3, rows}, *values, 0);
      }
    };
    columns_.push_back({add, write});
  }

  void write(const Variable& variable) {
    errno = 0;
    if (!variable || Mat_VarWrite(file_.get(), variable.get(), MAT_COMPRESSION_ZLIB) != 0)
      failToWrite(path_, errno != 0 ? errno : EIO);
  }

  template <typename T>
  void writeArray(const char* name,
                  std::vector<std::size_t> size,
                  const std::vector<T>& values,
                  int flags) {
    const Type type = typeOf(T());
    write(Variable(Mat_VarCreate(name, type.in_memory, type.in_file, static_cast<int>(size.size()),
                                 size.data(), const_cast<T*>(values.data()), flags)));
  }

  std::string path_;
  std::unique_ptr<mat_t, CloseFile> file_;
  std::vector<Column> columns_;
};

}  // namespace

std::unique_ptr<Writer> makeMatlabWriter(const std::string& path) {
  return std::make_unique<MatlabWriter>(path);
}

}  // namespace wiimote_tracker::measurements
