#include "link_diagnostics.h"

#include "battery_publisher.h"
#include "link_log.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace wiimote_tracker::driver {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;
using wiimote::Link;

// Share of the nominal image rate below which there is a warning. Even bad links deliver 0.95.
constexpr double kLowRate = 0.8;
constexpr char kRaiseRate[] =
    ": bring the remote nearer to its Bluetooth adapter, or give the adapter fewer remotes";
// Within StreamStatistics::kMemory; once may be a person's doing.
constexpr int kManyReturns = 2;
constexpr char kKeepLink[] =
    ": bring the remote nearer to its Bluetooth adapter, or change its batteries";
// Largest standard deviation of an exposure clock that counts as in step, in periods.
constexpr double kInStep = 0.3;

const char* linkText(Link::State state) {
  switch (state) {
    case Link::State::kSearching:
      return "searching";
    case Link::State::kStarting:
      return "starting";
    default:
      return "streaming";
  }
}

const char* irModeText(protocol::IrFormat format) {
  switch (format) {
    case protocol::IrFormat::kBasic:
      return "basic";
    case protocol::IrFormat::kFull:
      return "full";
    default:
      return "extended";
  }
}

const char* clockText(const DriverState& state) {
  if (state.link.state != Link::State::kStreaming)
    return "no images";
  if (std::isnan(state.stamp_stddev))
    return "off: stamps are arrivals less the latency";
  return state.stamp_stddev < kInStep * state.clock.period ? "in step" : "learning";
}

void addTiming(const DriverState& state, DiagnosticStatusWrapper& status) {
  status.addf("rate [Hz]", "%.1f", state.stream.rate);
  status.addf("longest gap [ms]", "%.0f", 1e3 * state.stream.longest_gap);
  status.add("gaps over 50 ms", state.stream.gaps);
  status.add("exposure clock", clockText(state));
  status.addf("stamp standard deviation [ms]", "%.3f", 1e3 * state.stamp_stddev);
  status.addf("period [ms]", "%.4f", 1e3 * state.clock.period);
  status.addf("period standard deviation [ms]", "%.4f", 1e3 * state.clock.period_stddev);
  status.addf("jitter [ms]", "%.2f", 1e3 * state.clock.jitter);
  // Duplicate reports can make it negative.
  status.add("dropped images", std::max<std::int64_t>(0, state.totals.dropped));
  status.add("stale images", state.totals.stale);
  status.add("steps of the system clock", state.totals.clock_steps);
}

void addRemote(const Link& link, DiagnosticStatusWrapper& status) {
  status.add("device", link.remote.description);
  status.add("identity", link.remote.identity);
  status.add("kernel driver",
             link.remote.kernel_driver.empty() ? "none" : link.remote.kernel_driver);
  status.add("reconnects", link.clock_epoch);
  status.add("restorations", link.restorations);
  status.add("last restoration", link.last_restoration.empty() ? "none" : link.last_restoration);
  if (link.status) {
    status.add("battery (raw)", static_cast<int>(link.status->battery));
    status.addf("battery [%]", "%.0f", 100.0 * protocol::batteryCharge(link.status->battery));
  }
  if (link.ir_calibration) {
    const auto centre = link.ir_calibration->centre();
    status.addf("factory principal point [px]", "%.1f, %.1f", centre[0],
                protocol::imageY(centre[1]));
  }
}

}  // namespace

LinkDiagnostics::LinkDiagnostics(protocol::IrFormat ir_format,
                                 double image_rate,
                                 double battery_low)
    : ir_format_(ir_format), image_rate_(image_rate), battery_low_(battery_low) {}

void LinkDiagnostics::describe(const DriverState& state, DiagnosticStatusWrapper& status) {
  summarise(state, status);
  status.add("link", linkText(state.link.state));
  addRemote(state.link, status);
  status.add("IR mode", irModeText(ir_format_));
  status.add("IR sensitivity", state.ir_sensitivity);
  addTiming(state, status);
  status.add("reader priority", state.reader_priority);
  status.add("recording", state.recording.empty() ? "none" : state.recording);
}

void LinkDiagnostics::summarise(const DriverState& state, DiagnosticStatusWrapper& status) {
  const Link& link = state.link;
  if (link.state == Link::State::kSearching)
    status.summary(DiagnosticStatus::ERROR,
                   link.error.empty() ? "looking for the remote" : link.error);
  else if (link.state == Link::State::kStarting)
    status.summary(DiagnosticStatus::WARN,
                   link.error.empty() ? "setting up the remote" : link.error);
  else
    summariseStream(state, status);
  if (!state.recording_error.empty())
    status.mergeSummary(DiagnosticStatus::ERROR, state.recording_error);
}

void LinkDiagnostics::summariseStream(const DriverState& state, DiagnosticStatusWrapper& status) {
  const Link& link = state.link;
  status.summary(DiagnosticStatus::OK, "streaming");
  if (link.remote.kernel_driver == "wiimote") {
    // It serves all remotes of a usual kernel, mostly without harm.
    const bool harm = link.restorations != restorations_ || state.stream.gaps != gaps_;
    status.summary(harm ? DiagnosticStatus::WARN : DiagnosticStatus::OK,
                   std::string("streaming; ") + kKernelDriverShares);
  }
  if (state.stream.has_rate && state.stream.rate < kLowRate * image_rate_)
    status.mergeSummaryf(DiagnosticStatus::WARN, "only %.0f images a second%s", state.stream.rate,
                         state.replayed ? "" : kRaiseRate);
  if (state.stream.returns >= kManyReturns)
    status.mergeSummaryf(DiagnosticStatus::WARN, "the images stopped %d times in ten minutes%s",
                         state.stream.returns, state.replayed ? "" : kKeepLink);
  if (!state.shared_with.empty())
    status.mergeSummary(DiagnosticStatus::WARN, state.shared_with);
  // Once is no warning, as in LinkLog.
  if (link.restorations != restorations_ && link.restorations > 1)
    status.mergeSummary(DiagnosticStatus::WARN, "put right: " + link.last_restoration);
  restorations_ = link.restorations;
  gaps_ = state.stream.gaps;
  if (const char* problem = accelerometerProblem(link))
    status.mergeSummary(DiagnosticStatus::WARN, problem);
  if (link.status && batteryLow(*link.status, battery_low_))
    status.mergeSummary(DiagnosticStatus::WARN, "the batteries are nearly empty: change them soon");
}

}  // namespace wiimote_tracker::driver
