#include "summary.h"

#include "wiimote_tracker_driver/protocol/input_reports.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <optional>

namespace wiimote_tracker::recording_info {
namespace {

using recording::Record;

constexpr double kGap = 0.05;  // [s] About five lost reports.

const char* nameOf(std::uint8_t id) {
  static const std::map<std::uint8_t, const char*> kNames{
      {0x10, "rumble"},          {0x11, "LEDs"},
      {0x12, "report mode"},     {0x13, "camera clock"},
      {0x15, "status request"},  {0x16, "write memory"},
      {0x17, "read memory"},     {0x1a, "camera logic"},
      {0x20, "status"},          {0x21, "memory"},
      {0x22, "acknowledgement"}, {0x33, "extended infrared"},
      {0x36, "basic infrared"},  {0x37, "basic infrared"},
      {0x3e, "full infrared"},   {0x3f, "full infrared"},
  };
  const auto known = kNames.find(id);
  if (known != kNames.end())
    return known->second;
  return protocol::isDataReport(id) ? "other data" : "unknown";
}

std::string orNone(const std::string& text) {
  return text.empty() ? "none" : text;
}

std::string describeConnection(std::size_t number, const Connection& connection) {
  std::string end = "with the recording";
  if (connection.ended)
    end = connection.end_reason.empty() ? "the driver released it" : connection.end_reason;
  return format("connection %zu   %.3f to %.3f s\n", number, connection.begin, connection.end) +
         "  remote       " + orNone(connection.remote.identity) + " at " +
         connection.remote.description + "\n  kernel       " +
         orNone(connection.remote.kernel_driver) + "\n  end          " + end + "\n";
}

std::string describeReports(const char* title, const std::array<std::uint64_t, 256>& counts) {
  std::string lines;
  for (std::size_t id = 0; id < counts.size(); ++id) {
    if (counts[id] > 0)
      lines += format("%-14s 0x%02zx %9llu  %s\n", lines.empty() ? title : "", id,
                      static_cast<unsigned long long>(counts[id]),
                      nameOf(static_cast<std::uint8_t>(id)));
  }
  return lines;
}

std::string describeIntervals(const std::vector<double>& intervals) {
  if (intervals.empty())
    return "";
  const auto count = static_cast<double>(intervals.size());
  const double sum = std::accumulate(intervals.begin(), intervals.end(), 0.0);
  const auto quantile = [&](double share) {
    return intervals[static_cast<std::size_t>(std::ceil(share * count)) - 1];
  };
  const auto gaps = intervals.end() - std::upper_bound(intervals.begin(), intervals.end(), kGap);
  return format("data           %.1f reports a second\n", count / sum) +
         format("interval       p50 %.1f, p99 %.1f, longest %.1f ms\n", 1e3 * quantile(0.5),
                1e3 * quantile(0.99), 1e3 * intervals.back()) +
         format("gaps           %td over %.0f ms\n", gaps, 1e3 * kGap);
}

}  // namespace

Summary summarize(recording::Reader& reader) {
  Summary summary;
  summary.header = reader.header();
  std::optional<double> last_data;
  for (Record record; reader.next(record);) {
    summary.duration = record.time;
    switch (record.kind) {
      case Record::Kind::kConnected:
        summary.connections.push_back({record.remote, record.time, record.time, false, ""});
        last_data.reset();
        break;
      case Record::Kind::kReceived:
        ++summary.received[record.report.id()];
        if (protocol::isDataReport(record.report.id())) {
          if (last_data)
            summary.intervals.push_back(record.time - *last_data);
          last_data = record.time;
        }
        break;
      case Record::Kind::kSent:
        ++summary.sent[record.report.id()];
        break;
      case Record::Kind::kDisconnected:
        break;
    }
    if (summary.connections.empty() || summary.connections.back().ended)
      continue;
    Connection& connection = summary.connections.back();
    connection.end = record.time;
    connection.ended = record.kind == Record::Kind::kDisconnected;
    if (connection.ended)
      connection.end_reason = record.reason;
  }
  std::sort(summary.intervals.begin(), summary.intervals.end());
  summary.damage = reader.damage();
  return summary;
}

std::string describe(const Summary& summary) {
  std::string text = "made by        " + summary.header.software + "\nbegin          " +
                     utcDate(summary.header.wall_time) + "\n" +
                     format("duration       %.3f s\n", summary.duration) +
                     format("connections    %zu\n", summary.connections.size());
  std::size_t number = 0;
  for (const Connection& connection : summary.connections)
    text += describeConnection(++number, connection);
  text += describeIntervals(summary.intervals) + describeReports("received", summary.received) +
          describeReports("sent", summary.sent);
  return text + "complete       " + (summary.damage.empty() ? "yes" : "no: " + summary.damage) +
         "\n";
}

}  // namespace wiimote_tracker::recording_info
