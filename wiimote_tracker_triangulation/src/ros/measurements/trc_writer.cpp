#include "ros/measurements/sample_table.h"
#include "ros/measurements/writer.h"

#include <cstddef>
#include <filesystem>
#include <sstream>

namespace wiimote_tracker::measurements {
namespace {

std::string headerOf(const std::string& path, const Samples& samples) {
  std::ostringstream text = plainText(9);
  text << "PathFileType\t4\t(X/Y/Z)\t" << std::filesystem::path(path).filename().string() << "\n"
       << "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\t"
          "OrigNumFrames\n"
       << samples.rate << "\t" << samples.rate << "\t" << samples.frames << "\t"
       << samples.labels.size() << "\tm\t" << samples.rate << "\t1\t" << samples.frames << "\n"
       << "Frame#\tTime";
  for (const std::string& label : samples.labels)
    text << "\t" << label << "\t\t";
  text << "\n\t";
  for (std::size_t i = 1; i <= samples.labels.size(); ++i)
    text << "\tX" << i << "\tY" << i << "\tZ" << i;
  text << "\n\n";
  return text.str();
}

void writeTrc(const std::string& path, const Samples& samples, OutputFile* file) {
  file->write(headerOf(path, samples));
  std::ostringstream row = plainText(9);
  for (std::size_t frame = 0; frame < samples.frames; ++frame) {
    row.str("");
    row << frame + 1 << "\t" << frame / samples.rate;
    for (const auto& positions : samples.positions) {
      const Eigen::Vector3d& p = positions[frame];
      if (p.allFinite())
        row << "\t" << p.x() << "\t" << p.y() << "\t" << p.z();
      else
        row << "\t\t\t";
    }
    row << "\n";
    file->write(row.str());
  }
}

}  // namespace

std::unique_ptr<Writer> makeTrcWriter(const std::string& path, double rate) {
  return std::make_unique<SampledWriter>(
      path, rate,
      [path](const Samples& samples, OutputFile* file) { writeTrc(path, samples, file); });
}

}  // namespace wiimote_tracker::measurements
