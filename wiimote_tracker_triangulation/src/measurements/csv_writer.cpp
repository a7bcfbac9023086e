#include "measurements/part_file.h"
#include "measurements/writer.h"

#include <wiimote_tracker_msgs/text.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <locale>
#include <sstream>

namespace wiimote_tracker::measurements {
namespace {

const char* const kHeader =
    "time [s],triggered,id,label,label_confidence,label_since [s],state,x [m],y [m],z [m],vx "
    "[m/s],vy [m/s],vz [m/s],"
    "cov_xx [m^2],cov_xy [m^2],cov_xz [m^2],cov_yy [m^2],cov_yz [m^2],cov_zz [m^2],"
    "vcov_xx [m^2/s^2],vcov_xy [m^2/s^2],vcov_xz [m^2/s^2],vcov_yy [m^2/s^2],vcov_yz [m^2/s^2],"
    "vcov_zz [m^2/s^2],rays_used,rays_possible,residual [px],last_observed [s],age [s],remapped,"
    "frame,rig_id,method\n";

/// A row as text; decimal points in any locale.
class Row {
 public:
  Row() {
    text_.imbue(std::locale::classic());
    text_.precision(17);
  }

  void clear() {
    text_.str("");
    is_first_ = true;
  }

  void add(double value) {
    separate();
    if (std::isnan(value))
      text_ << "nan";  // never "-nan"
    else
      text_ << value;
  }

  void add(const Eigen::Vector3d& v) {
    for (int i = 0; i < 3; ++i)
      add(v[i]);
  }

  void add(const Eigen::Matrix3d& symmetric) {
    for (int r = 0; r < 3; ++r) {
      for (int c = r; c < 3; ++c)
        add(symmetric(r, c));
    }
  }

  void addCount(std::uint64_t count) {
    separate();
    text_ << count;
  }

  void addTime(std::int64_t nanoseconds) {
    separate();
    const std::lldiv_t t = std::lldiv(nanoseconds, 1000000000);
    const std::string digits = format("%lld.%09lld", t.quot, t.rem);
    text_ << digits;
  }

  /// 0: unknown.
  void addTimeIfKnown(std::int64_t nanoseconds) {
    if (nanoseconds == 0)
      add(std::numeric_limits<double>::quiet_NaN());
    else
      addTime(nanoseconds);
  }

  /// Quoted where necessary (RFC 4180).
  void add(const std::string& word) {
    separate();
    if (word.find_first_of(",\"\r\n") == std::string::npos) {
      text_ << word;
      return;
    }
    text_ << '"';
    for (const char c : word) {
      if (c == '"')
        text_ << '"';
      text_ << c;
    }
    text_ << '"';
  }

  std::string line() const { return text_.str() + "\n"; }

 private:
  void separate() {
    if (!is_first_)
      text_ << ',';
    is_first_ = false;
  }

  std::ostringstream text_;
  bool is_first_ = true;
};

class CsvWriter : public Writer {
 public:
  explicit CsvWriter(const std::string& path) : file_(path) { file_.write(kHeader); }

  void add(const Measurement& m) override {
    row_.clear();
    row_.addTime(m.stamp);
    row_.addCount(m.triggered);
    row_.addCount(m.id);
    row_.add(m.label);
    row_.add(m.label_confidence);
    row_.addTimeIfKnown(m.label_since);
    row_.add(m.state);
    row_.add(m.position);
    row_.add(m.velocity);
    row_.add(m.position_covariance);
    row_.add(m.velocity_covariance);
    row_.addCount(m.rays_used);
    row_.addCount(m.rays_possible);
    row_.add(m.residual);
    row_.addTime(m.last_observed);
    row_.add(m.age);
    row_.addCount(m.remapped);
    row_.add(m.frame);
    row_.add(m.rig_id);
    row_.add(m.method);
    file_.write(row_.line());
  }

  void flush() override { file_.flush(); }
  void finish() override { file_.finish(); }

 private:
  OutputFile file_;
  Row row_;
};

}  // namespace

std::unique_ptr<Writer> makeCsvWriter(const std::string& path) {
  return std::make_unique<CsvWriter>(path);
}

}  // namespace wiimote_tracker::measurements
