#include "geometry/output_file.h"
#include "ros/measurements/table_fields.h"
#include "ros/measurements/writer.h"

#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <sstream>
#include <system_error>
#include <vector>

namespace wiimote_tracker::measurements {
namespace {

/// A row as text; decimal points in any locale.
class Cells {
 public:
  template <typename Number>
  void add(const Number& value) {
    if (std::isnan(static_cast<double>(value)))
      text_ << "nan,";  // never "-nan"
    else
      text_ << value << ',';
  }

  void add(const ros::Time& time) { text_ << secondsOf(time) << ','; }

  void add(const std::optional<ros::Time>& time) {
    text_ << (time ? secondsOf(*time) : "nan") << ',';
  }

  template <int kSize>
  void add(const Eigen::Matrix<double, kSize, 1>& v) {
    for (int i = 0; i < kSize; ++i)
      add(v[i]);
  }

  template <int kSize>
  void add(const Eigen::Matrix<double, kSize, kSize>& symmetric) {
    for (int r = 0; r < kSize; ++r) {
      for (int c = r; c < kSize; ++c)
        add(symmetric(r, c));
    }
  }

  /// Quoted where necessary (RFC 4180).
  void add(const std::string& word) {
    const bool is_quoted = word.find_first_of(",\"\r\n") != std::string::npos;
    text_ << (is_quoted ? "\"" : "");
    for (const char c : word)
      text_ << (c == '"' ? "\"" : "") << c;
    text_ << (is_quoted ? "\"," : ",");
  }

  std::string take() {
    std::string row = text_.str();
    row.back() = '\n';  // instead of the last comma
    text_.str("");
    return row;
  }

 private:
  std::ostringstream text_ = plainText(17);
};

template <typename Row>
class CsvTable {
 public:
  explicit CsvTable(OutputFile* file) : file_(file) {
    addFields(this);
    header_.back() = '\n';
    file_->write(header_);
  }

  /// See addFields().
  template <typename Value>
  void add(const char* /*name*/, const std::string& columns, Value value) {
    header_ += columns + ",";
    fields_.push_back([=](const Row& row, Cells* cells) { cells->add(value(row)); });
  }

  void add(const Row& row) {
    for (const auto& field : fields_)
      field(row, &cells_);
    file_->write(cells_.take());
  }

 private:
  OutputFile* file_;
  std::string header_;
  std::vector<std::function<void(const Row&, Cells*)>> fields_;
  Cells cells_;
};

class CsvWriter : public Writer {
 public:
  explicit CsvWriter(const std::string& path) : path_(path), leds_(open(path)) {}

  void add(const Measurement& measurement) override { leds_.add(measurement); }

  void addBodies(const wiimote_tracker_msgs::TrackedBodyArray& message) override {
    for (const wiimote_tracker_msgs::TrackedBody& body : message.bodies) {
      if (!bodies_)
        bodies_.emplace(open(csvOfBodies(path_)));
      bodies_->add({message, body});
    }
  }

  std::string finish() override {
    Writer::finish();
    if (!bodies_) {  // those of an earlier recording are not of this one
      std::error_code there_are_none;
      std::filesystem::rename(csvOfBodies(path_), csvOfBodies(path_) + ".bak", there_are_none);
    }
    return "";
  }

 private:
  std::string path_;
  CsvTable<Measurement> leds_;
  std::optional<CsvTable<Pose>> bodies_;
};

}  // namespace

std::string csvOfBodies(const std::string& path) {
  std::filesystem::path name = path;
  name.replace_filename(name.stem().string() + "_bodies" + name.extension().string());
  return name.string();
}

std::unique_ptr<Writer> makeCsvWriter(const std::string& path) {
  return std::make_unique<CsvWriter>(path);
}

}  // namespace wiimote_tracker::measurements
