#include "geometry/output_file.h"
#include "ros/measurements/table_fields.h"
#include "ros/measurements/writer.h"

#include <matio.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
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
    "numbers of lines of labels, states, frames, rig_ids, methods. bodies: the same of bodies by "
    "name; quaternion x, y, z, w: world from body; velocity of the origin, angular_velocity "
    "[rad/s] along the world's axes; covariances 6 x 6 x rows: of position and rotation about the "
    "world's axes [rad], of velocity and angular velocity.";

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

template <typename T>
Variable array(const char* name,
               std::vector<std::size_t> size,
               const std::vector<T>& values,
               int flags = 0) {
  const Type type = typeOf(T());
  return Variable(Mat_VarCreate(name, type.in_memory, type.in_file, static_cast<int>(size.size()),
                                size.data(), const_cast<T*>(values.data()), flags));
}

/// A struct with the variables of a table as fields; null if one is.
template <typename Table>
Variable structOf(const char* name, const Table& table) {
  std::array<std::size_t, 2> size{1, 1};
  Variable fields(Mat_VarCreateStruct(name, 2, size.data(), nullptr, 0));
  table.write([&](Variable field) {
    if (!field || !fields || Mat_VarAddStructField(fields.get(), field->name) != 0) {
      fields = nullptr;
      return;
    }
    const char* const field_name = field->name;
    Mat_VarSetStructFieldByName(fields.get(), field_name, 0, field.release());
  });
  return fields;
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

/// The variables of a table, one for each field.
template <typename Row>
class MatlabTable {
 public:
  using Sink = std::function<void(Variable)>;

  MatlabTable() {
    addNumbers<double>("time", [](const Row& row) {
      return 1e-9 * static_cast<double>(nanosecondsOf(row.message.header.stamp));
    });
    addFields(this);
  }

  /// See addFields().
  template <typename Value>
  void add(const char* name, const std::string& /*columns*/, Value value) {
    using Result = decltype(value(std::declval<const Row&>()));
    if constexpr (std::is_same_v<Result, bool>)
      addNumbers<std::uint8_t>(name, value, MAT_F_LOGICAL);
    else if constexpr (std::is_arithmetic_v<Result>)
      addNumbers<Result>(name, value);
    else if constexpr (std::is_same_v<Result, ros::Time>)
      addNumbers<std::int64_t>(name, [=](const Row& row) { return nanosecondsOf(value(row)); });
    else if constexpr (std::is_same_v<Result, std::optional<ros::Time>>)
      addNumbers<std::int64_t>(
          name, [=](const Row& row) { return nanosecondsOf(value(row).value_or(ros::Time())); });
    else if constexpr (std::is_same_v<Result, std::string>)
      addWords(name, value);
    else
      addMatrices<Result>(name, value);
  }

  void add(const Row& row) {
    for (const Column& column : columns_)
      column.add(row);
  }

  /// Gives all variables to a sink.
  void write(const Sink& sink) const {
    for (const Column& column : columns_)
      column.write(sink);
  }

 private:
  /// One field of all rows.
  struct Column {
    std::function<void(const Row&)> add;
    std::function<void(const Sink&)> write;
  };

  template <typename T, typename Value>
  void addNumbers(const char* name, Value value, int flags = 0) {
    const auto values = std::make_shared<std::vector<T>>();
    columns_.push_back({[=](const Row& row) { values->push_back(value(row)); },
                        [=](const Sink& sink) {
                          sink(array(name, {values->size(), 1}, *values, flags));
                        }});
  }

  template <typename Value>
  void addWords(const std::string& name, Value value) {
    const auto words = std::make_shared<Words>();
    columns_.push_back({[=](const Row& row) { words->add(value(row)); },
                        [=](const Sink& sink) {
                          sink(array(name.c_str(), {words->rows().size(), 1}, words->rows()));
                          sink(words->table(name + "s"));
                        }});
  }

  /// Vectors: rows x size; matrices: size x size x rows.
  template <typename Matrix, typename Value>
  void addMatrices(const char* name, Value value) {
    constexpr std::size_t kSize = Matrix::RowsAtCompileTime;
    const auto values = std::make_shared<std::vector<double>>();
    const auto add = [=](const Row& row) {
      const Matrix matrix = value(row);
      values->insert(values->end(), matrix.data(), matrix.data() + matrix.size());
    };
    const auto write = [=](const Sink& sink) {
      const std::size_t rows = values->size() / Matrix::SizeAtCompileTime;
      if (Matrix::ColsAtCompileTime > 1)
        return sink(array(name, {kSize, kSize, rows}, *values));
      const Eigen::MatrixXd columns =
          Eigen::Map<const Eigen::MatrixXd>(values->data(), kSize, static_cast<Eigen::Index>(rows))
              .transpose();
      values->assign(columns.data(), columns.data() + columns.size());
      sink(array(name, {rows, kSize}, *values));
    };
    columns_.push_back({add, write});
  }

  std::vector<Column> columns_;
};

/// Whether a file of version 5 (a header, then elements of type, size and bytes) ends with the last
/// of so many elements. matio does not tell that a disk was full.
bool isWhole(const std::string& path, int elements) {
  std::ifstream file(path, std::ios::binary);
  file.seekg(0, std::ios::end);
  const std::streamoff size = file.tellg();
  std::streamoff end = 128;  // of the header
  std::array<std::uint32_t, 2> tag{};
  for (; end < size && file.seekg(end).read(reinterpret_cast<char*>(tag.data()), sizeof tag);
       --elements)
    end += static_cast<std::streamoff>(sizeof tag) + tag[1];
  return file && end == size && elements == 0;
}

class MatlabWriter : public Writer {
 public:
  explicit MatlabWriter(const std::string& path) : path_(path) { open(path_); }

  void add(const Measurement& measurement) override { leds_.add(measurement); }

  void addBodies(const wiimote_tracker_msgs::TrackedBodyArray& message) override {
    for (const wiimote_tracker_msgs::TrackedBody& body : message.bodies)
      bodies_.add({message, body});
  }

  std::string finish() override {
    errno = 0;
    file_.reset(Mat_CreateVer(geometry::partOf(path_).c_str(), kFileHeader, MAT_FT_MAT5));
    if (!file_)
      geometry::failToWrite(path_, errno);
    write(text("readme", kReadme));
    leds_.write([this](const Variable& variable) { write(variable); });
    write(structOf("bodies", bodies_));
    if (Mat_Close(file_.release()) != 0 || !isWhole(geometry::partOf(path_), written_))
      geometry::failToWrite(path_, errno != 0 ? errno : EIO);
    return Writer::finish();
  }

 private:
  struct CloseFile {
    void operator()(mat_t* file) const { Mat_Close(file); }
  };

  void write(const Variable& variable) {
    if (!variable || Mat_VarWrite(file_.get(), variable.get(), MAT_COMPRESSION_ZLIB) != 0)
      geometry::failToWrite(path_, errno != 0 ? errno : EIO);
    ++written_;
  }

  std::string path_;
  int written_ = 0;
  std::unique_ptr<mat_t, CloseFile> file_;
  MatlabTable<Measurement> leds_;
  MatlabTable<Pose> bodies_;
};

}  // namespace

std::unique_ptr<Writer> makeMatlabWriter(const std::string& path) {
  return std::make_unique<MatlabWriter>(path);
}

}  // namespace wiimote_tracker::measurements
