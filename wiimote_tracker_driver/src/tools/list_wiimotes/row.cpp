#include "row.h"

#include "transport/users.h"
#include "wiimote_tracker_driver/protocol/input_reports.h"

#include <unistd.h>

#include <cstdio>

namespace wiimote_tracker::list_wiimotes {

namespace {

constexpr double kAnswerTimeout = 1.0;  // [s]

std::string permissionOf(const Row& row) {
  if (row.device.kind != transport::DeviceName::Kind::kPath || row.device.value.empty())
    return "";
  const bool allowed = ::access(row.device.value.c_str(), R_OK | W_OK) == 0;
  return allowed ? ", you may open it" : ", you may NOT open it";
}

}  // namespace

std::vector<Row> rowsOf(const Host& host, const std::string& wanted) {
  std::vector<Row> rows;
  for (const KernelRemote& remote : host.remotes) {
    if (!wanted.empty() && wanted != remote.address && wanted != remote.path)
      continue;
    Row row;
    row.device = {transport::DeviceName::Kind::kPath, remote.path};
    row.text = remote.address;
    row.address = remote.address;
    row.description = modelOf(remote) + ", kernel driver " +
                      (remote.kernel_driver.empty() ? "none" : remote.kernel_driver);
    if (!remote.adapter.empty())
      row.description += ", adapter " + remote.adapter;
    row.can_be_opened = !remote.path.empty();
    row.hints = problems(remote);
    rows.push_back(row);
  }
  return rows;
}

std::vector<Row> rowsOf(const std::vector<std::string>& sockets) {
  std::vector<Row> rows;
  for (const std::string& path : sockets) {
    Row row;
    row.text = "virtual:" + path;
    row.device = transport::parseDeviceName(row.text);
    row.description = "virtual Wii Remote";
    rows.push_back(row);
  }
  return rows;
}

void check(const CameraList& list, Row* row) {
  if (row->can_be_opened) {
    row->check = checkRemote(row->device, kAnswerTimeout);
    if (row->address.empty())
      row->address = row->check.identity;
    // If a driver uses it, the check has named it.
    if (row->device.kind == transport::DeviceName::Kind::kPath &&
        row->check.state == RemoteCheck::State::kFree) {
      const std::string others = transport::sharedWith(row->device.value);
      if (!others.empty())
        row->hints.push_back(others);
    }
  }
  if (!row->text.empty())
    row->camera = list.nameOf(row->text);
}

bool isFine(const Row& row) {
  return row.can_be_opened && row.check.state != RemoteCheck::State::kFailed;
}

void print(int number, const Row& row) {
  const std::string where =
      row.device.kind == transport::DeviceName::Kind::kVirtual ? row.text : row.device.value;
  std::printf("%d  %s  %s%s%s\n", number,
              row.address.empty() ? "(address unknown)" : row.address.c_str(),
              where.empty() ? "(no hidraw node)" : where.c_str(), row.camera.empty() ? "" : "  ",
              row.camera.c_str());
  std::printf("   %s%s\n", row.description.c_str(), permissionOf(row).c_str());
  if (row.check.state == RemoteCheck::State::kFree) {
    const protocol::Status& status = *row.check.status;
    std::printf("   free, battery %.0f %% (raw %d)%s\n",
                100.0 * protocol::batteryCharge(status.battery), status.battery,
                status.battery_low ? ", low by its own sign: put new batteries in" : "");
  } else if (!row.check.sentence.empty()) {
    std::printf("   %s %s\n", isFine(row) ? "-" : "!", row.check.sentence.c_str());
  }
  for (const std::string& hint : row.hints)
    std::printf("   ! %s\n", hint.c_str());
  std::fflush(stdout);
}

}  // namespace wiimote_tracker::list_wiimotes
