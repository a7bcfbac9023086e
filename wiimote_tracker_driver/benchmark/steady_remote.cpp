#include "steady_remote.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::wiimote {
namespace {

using protocol::Report;

// The factory's blocks for the camera and for the accelerometer, each twice, of a real remote.
constexpr std::array<std::uint8_t, 42> kEeprom{
    {0x88, 0x85, 0x8b, 0x8b, 0x8a, 0x97, 0x3f, 0x30, 0x8c, 0x39, 0xcd, 0x88, 0x85, 0x8b,
     0x8b, 0x8a, 0x97, 0x3f, 0x30, 0x8c, 0x39, 0xcd, 0x84, 0x82, 0x86, 0x30, 0x9f, 0x9d,
     0x9f, 0x02, 0x40, 0x2e, 0x84, 0x82, 0x86, 0x30, 0x9f, 0x9d, 0x9f, 0x02, 0x40, 0x2e}};

}  // namespace

class SteadyRemote::Transport : public transport::Transport {
 public:
  explicit Transport(SteadyRemote* remote) : remote_(remote) {}
  bool read(Report& report, double timeout) override { return remote_->read(report, timeout); }
  void write(const Report& report) override { remote_->write(report); }
  transport::Remote remote() const override { return {"00:1f:32:00:00:01", "in memory"}; }

 private:
  SteadyRemote* remote_;
};

std::unique_ptr<transport::Transport> SteadyRemote::open() {
  if (now < away_until_)
    throw transport::TransportError("the remote is away");
  connected_ = true;
  return std::make_unique<Transport>(this);
}

void SteadyRemote::powerCycle() {
  mode_ = 0;
  registers_.fill(0);
}

bool SteadyRemote::read(Report& report, double timeout) {
  if (!connected_)
    throw transport::Disconnected("the remote has gone away");
  if (answers_waiting_ > 0) {
    report = answers_[first_answer_];
    first_answer_ = (first_answer_ + 1) % answers_.size();
    --answers_waiting_;
    return true;
  }
  const double until = now + timeout;
  if (mode_ == 0 || next_data_ > until) {
    now = until;
    return false;
  }
  now = std::max(now, next_data_);
  next_data_ = afterNow();
  report = data();
  ++sent;
  return true;
}

void SteadyRemote::write(const Report& output) {
  const auto& bytes = output.bytes;
  switch (output.id()) {
    case 0x12:
      if (mode_ == 0)
        next_data_ = afterNow();
      mode_ = bytes[2];
      break;
    case 0x15:
      say({0x20, 0, 0, static_cast<std::uint8_t>(battery < 0x20 ? 0x19 : 0x18), 0, 0, battery});
      return;
    case 0x16:
      for (std::size_t i = 0; i < bytes[5]; ++i)
        registers_[(bytes[4] + i) % registers_.size()] = bytes[6 + i];
      say({0x22, 0, 0, 0x16, 0});
      return;
    case 0x17:
      say(memory(output));
      return;
    default:
      break;
  }
  if (bytes[1] & 0x02)
    say({0x22, 0, 0, output.id(), 0});
}

double SteadyRemote::afterNow() const {
  return kPeriod * (std::floor(now / kPeriod + 1e-3) + 1.0);
}

void SteadyRemote::say(const Report& answer) {
  if (answers_waiting_ < answers_.size())
    answers_[(first_answer_ + answers_waiting_++) % answers_.size()] = answer;
}

Report SteadyRemote::memory(const Report& request) const {
  const std::size_t size = std::min<std::size_t>(request.bytes[6], 16);
  Report report{
      0x21, 0, 0, static_cast<std::uint8_t>(16 * size - 16), request.bytes[3], request.bytes[4]};
  report.size = Report::kCapacity;
  const bool registers = (request.bytes[1] & 0x04) != 0;
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t at = request.bytes[4] + i;
    report.bytes[6 + i] = registers ? registers_[at % registers_.size()] : kEeprom[at % 42];
  }
  return report;
}

Report SteadyRemote::data() {
  Report report{mode_, 0x20, 0x40, 0x84, 0x82, 0x9f};
  report.size = mode_ == 0x33 ? 18 : Report::kCapacity;
  // One light; ff in the slots without.
  const std::size_t infrared = mode_ < 0x38 ? 6 : 4;
  std::fill(report.bytes.begin() + infrared, report.bytes.end(), 0xff);
  report.bytes[infrared] = static_cast<std::uint8_t>(sent);
  report.bytes[infrared + 1] = static_cast<std::uint8_t>(sent >> 8);
  report.bytes[infrared + 2] = mode_ == 0x37 ? 0x1f : 0x13;
  if (mode_ == 0x3e || mode_ == 0x3f) {
    const std::uint8_t box[] = {10, 20, 12, 22, 0, 0x80};
    std::copy(std::begin(box), std::end(box), report.bytes.begin() + infrared + 3);
    mode_ ^= 1;  // the other half is next
  }
  return report;
}

}  // namespace wiimote_tracker::wiimote
