#include "ros/measurements/part_file.h"
#include "ros/measurements/writer.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <cmath>
#include <locale>
#include <sstream>

namespace wiimote_tracker::measurements {
namespace {

const char* const kHeader =
    "time [s],triggered,id,label,label_confidence,label_since [s],state,"
    "x [m],y [m],z [m],vx [m/s],vy [m/s],vz [m/s],"
    "cov_xx [m^2],cov_xy [m^2],cov_xz [m^2],cov_yy [m^2],cov_yz [m^2],cov_zz [m^2],"
    "vcov_xx [m^2/s^2],vcov_xy [m^2/s^2],vcov_xz [m^2/s^2],vcov_yy [m^2/s^2],vcov_yz [m^2/s^2],"
    "vcov_zz [m^2/s^2],rays_used,rays_possible,residual [px],last_observed [s],age [s],remapped,"
    "frame,rig_id,method\n";

/// Rows as text; decimal points in any locale.
class Rows {
 public:
  Rows() {
    text_.imbue(std::locale::classic());
    text_.precision(17);
  }

  template <typename... Cells>
  std::string of(const Cells&... cells) {
    text_.str("");
    (add(cells), ...);
    std::string row = text_.str();
    row.back() = '\n';  // instead of the last comma
    return row;
  }

 private:
  template <typename Number>
  void add(const Number& value) {
    if (std::isnan(static_cast<double>(value)))
      text_ << "nan,";  // never "-nan"
    else
      text_ << value << ',';
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

  /// Quoted where necessary (RFC 4180).
  void add(const std::string& word) {
    const bool is_quoted = word.find_first_of(",\"\r\n") != std::string::npos;
    text_ << (is_quoted ? "\"" : "");
    for (const char c : word)
      text_ << (c == '"' ? "\"" : "") << c;
    text_ << (is_quoted ? "\"," : ",");
  }

  std::ostringstream text_;
};

class CsvWriter : public Writer {
 public:
  explicit CsvWriter(const std::string& path) : file_(path) { file_.write(kHeader); }

  void add(const Measurement& m) override {
    const wiimote_tracker_msgs::TrackedPoint& led = m.led;
    file_.write(rows_.of(
        secondsOf(m.message.header.stamp), m.triggered, led.id, led.label, led.label_confidence,
        led.label_since.isZero() ? "nan" : secondsOf(led.label_since), wordOf(led.state),
        vectorOf(led.position), vectorOf(led.velocity), matrixOf<3>(led.position_covariance),
        matrixOf<3>(led.velocity_covariance), led.rays_used, led.rays_possible, led.residual,
        secondsOf(led.last_observed), led.age, led.remapped != 0, m.message.header.frame_id,
        m.message.rig_id, m.message.method));
  }

  void flush() override { file_.flush(); }
  void finish() override { file_.finish(); }
  void discard() override { file_.discard(); }

 private:
  OutputFile file_;
  Rows rows_;
};

}  // namespace

std::unique_ptr<Writer> makeCsvWriter(const std::string& path) {
  return std::make_unique<CsvWriter>(path);
}

}  // namespace wiimote_tracker::measurements
