#include "measurements/part_file.h"
#include "measurements/writer.h"

#include <matio.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <map>
#include <vector>

namespace wiimote_tracker::measurements {
namespace {

const char* const kReadme =
    "One row per LED and time. time [s since 1970]; stamp, the same exactly [ns since 1970]; "
    "triggered: interpolated for an external trigger; id of the track; label_confidence: "
    "probability that the label is right (NaN: not estimated), label_since: since when it stands "
    "[ns since 1970] (0: not estimated); position [m], velocity "
    "[m/s] (NaN: unknown) in the world frame; their covariances 3 x 3 x rows [m^2], [m^2/s^2]; "
    "rays_used of rays_possible cameras; residual: reprojection error [px]; last_observed [ns "
    "since "
    "1970]; age of the track [s]; remapped: corrected within the measured volume. label, state, "
    "frame, rig_id, method: numbers of lines of labels, states, frames, rig_ids, methods.";

// The default header contains the date, but equal measurements must give equal files.
const char* const kFileHeader = "MATLAB 5.0 MAT-file, written by wiimote_tracker_triangulation";

struct FreeVariable {
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using Variable = std::unique_ptr<matvar_t, FreeVariable>;

template <typename T>
struct MatlabType;
template <>
struct MatlabType<double> {
  static constexpr matio_classes kClass = MAT_C_DOUBLE;
  static constexpr matio_types kType = MAT_T_DOUBLE;
};
template <>
struct MatlabType<std::int64_t> {
  static constexpr matio_classes kClass = MAT_C_INT64;
  static constexpr matio_types kType = MAT_T_INT64;
};
template <>
struct MatlabType<std::uint32_t> {
  static constexpr matio_classes kClass = MAT_C_UINT32;
  static constexpr matio_types kType = MAT_T_UINT32;
};
template <>
struct MatlabType<std::uint8_t> {
  static constexpr matio_classes kClass = MAT_C_UINT8;
  static constexpr matio_types kType = MAT_T_UINT8;
};

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
  explicit MatlabWriter(const std::string& path) : path_(path) { createPart(path_); }

  void add(const Measurement& m) override {
    time_.push_back(1e-9 * static_cast<double>(m.stamp));
    stamp_.push_back(m.stamp);
    triggered_.push_back(m.triggered);
    id_.push_back(m.id);
    label_.add(m.label);
    label_confidence_.push_back(m.label_confidence);
    label_since_.push_back(m.label_since);
    state_.add(m.state);
    append(m.position, &position_);
    append(m.velocity, &velocity_);
    append(m.position_covariance, &position_covariance_);
    append(m.velocity_covariance, &velocity_covariance_);
    rays_used_.push_back(m.rays_used);
    rays_possible_.push_back(m.rays_possible);
    residual_.push_back(m.residual);
    last_observed_.push_back(m.last_observed);
    age_.push_back(m.age);
    remapped_.push_back(m.remapped);
    frame_.add(m.frame);
    rig_id_.add(m.rig_id);
    method_.add(m.method);
  }

  void finish() override {
    file_.reset(Mat_CreateVer(partOf(path_).c_str(), kFileHeader, MAT_FT_MAT5));
    if (!file_)
      failToWrite(path_, errno);
    write(text("readme", kReadme));
    writeColumn("time", time_);
    writeColumn("stamp", stamp_);
    writeColumn("triggered", triggered_, MAT_F_LOGICAL);
    writeColumn("id", id_);
    writeWords("label", label_);
    writeColumn("label_confidence", label_confidence_);
    writeColumn("label_since", label_since_);
    writeWords("state", state_);
    writeVectors("position", position_);
    writeVectors("velocity", velocity_);
    writeMatrices("position_covariance", position_covariance_);
    writeMatrices("velocity_covariance", velocity_covariance_);
    writeColumn("rays_used", rays_used_);
    writeColumn("rays_possible", rays_possible_);
    writeColumn("residual", residual_);
    writeColumn("last_observed", last_observed_);
    writeColumn("age", age_);
    writeColumn("remapped", remapped_, MAT_F_LOGICAL);
    writeWords("frame", frame_);
    writeWords("rig_id", rig_id_);
    writeWords("method", method_);
    if (Mat_Close(file_.release()) != 0)
      failToWrite(path_, errno);
    finishPart(path_);
  }

 private:
  struct CloseFile {
    void operator()(mat_t* file) const { Mat_Close(file); }
  };

  template <typename Matrix>
  static void append(const Matrix& m, std::vector<double>* values) {
    values->insert(values->end(), m.data(), m.data() + m.size());
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
                  int flags = 0) {
    write(Variable(Mat_VarCreate(name, MatlabType<T>::kClass, MatlabType<T>::kType,
                                 static_cast<int>(size.size()), size.data(),
                                 const_cast<T*>(values.data()), flags)));
  }

  template <typename T>
  void writeColumn(const char* name, const std::vector<T>& values, int flags = 0) {
    writeArray(name, {values.size(), 1}, values, flags);
  }

  void writeWords(const std::string& name, const Words& words) {
    writeColumn(name.c_str(), words.rows());
    write(words.table(name + "s"));
  }

  void writeVectors(const char* name, const std::vector<double>& values) {
    const std::size_t rows = values.size() / 3;
    std::vector<double> columns(values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
      columns[i % 3 * rows + i / 3] = values[i];
    writeArray(name, {rows, 3}, columns);
  }

  void writeMatrices(const char* name, const std::vector<double>& values) {
    writeArray(name, {3, 3, values.size() / 9}, values);
  }

  std::string path_;
  std::unique_ptr<mat_t, CloseFile> file_;

  // One entry per row.
  std::vector<double> time_;
  std::vector<std::int64_t> stamp_;
  std::vector<std::uint8_t> triggered_;
  std::vector<std::uint32_t> id_;
  Words label_;
  std::vector<double> label_confidence_;
  std::vector<std::int64_t> label_since_;
  Words state_;
  std::vector<double> position_;  // three per row
  std::vector<double> velocity_;
  std::vector<double> position_covariance_;  // nine per row
  std::vector<double> velocity_covariance_;
  std::vector<std::uint32_t> rays_used_;
  std::vector<std::uint32_t> rays_possible_;
  std::vector<double> residual_;
  std::vector<std::int64_t> last_observed_;
  std::vector<double> age_;
  std::vector<std::uint8_t> remapped_;
  Words frame_;
  Words rig_id_;
  Words method_;
};

}  // namespace

bool hasMatlab() {
  return true;
}

std::unique_ptr<Writer> makeMatlabWriter(const std::string& path) {
  return std::make_unique<MatlabWriter>(path);
}

}  // namespace wiimote_tracker::measurements
