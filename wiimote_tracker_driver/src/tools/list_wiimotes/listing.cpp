#include "listing.h"

#include "wiimote_tracker_driver/protocol/input_reports.h"

#include <wiimote_tracker_msgs/text.h>

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace wiimote_tracker::list_wiimotes {
namespace {

/// Whether this device of a cameras.yaml is the remote: its address, path or socket.
bool isRemote(const Row& row, const std::string& device) {
  return lowerCase(row.text) == lowerCase(device) || row.device.value == device;
}

/// Empty without a hidraw node.
std::string whereOf(const Row& row) {
  return row.device.kind == transport::DeviceName::Kind::kVirtual ? row.text : row.device.value;
}

std::string permissionOf(const Row& row) {
  if (row.device.kind != transport::DeviceName::Kind::kPath || row.device.value.empty())
    return "";
  const bool allowed = ::access(row.device.value.c_str(), R_OK | W_OK) == 0;
  return allowed ? ", you may open it" : ", you may NOT open it";
}

/// Of a free remote, else empty.
std::string stateOf(const Row& row) {
  if (row.check.state != RemoteCheck::State::kFree)
    return "";
  const protocol::Status& status = *row.check.status;
  return format("free, battery %.0f %% (raw %d)%s", 100.0 * protocol::batteryCharge(status.battery),
                int{status.battery},
                status.battery_low ? ", low by its own sign: put new batteries in" : "");
}

std::string jsonText(const std::string& text) {
  std::string result = "\"";
  for (const char c : validUtf8(text)) {
    if (c == '"' || c == '\\')
      result += '\\';
    if (static_cast<unsigned char>(c) < 0x20)
      result += format("\\u%04x", static_cast<unsigned>(c));
    else
      result += c;
  }
  return result + '"';
}

template <typename Items, typename Convert>
std::string jsonList(const Items& items, const Convert& convert) {
  std::vector<std::string> texts;
  for (const auto& item : items)
    texts.push_back(convert(item));
  return "[" + joined(texts) + "]";
}

std::string jsonRow(const Row& row) {
  return "{\"address\": " + jsonText(row.address) + ", \"device\": " + jsonText(whereOf(row)) +
         ", \"camera\": " + jsonText(row.camera) +
         ", \"description\": " + jsonText(row.description) +
         ", \"usable\": " + (isUsable(row) ? "true" : "false") +
         ", \"state\": " + jsonText(stateOf(row)) +
         ", \"notes\": " + jsonList(row.notes, jsonText) +
         ", \"problems\": " + jsonList(row.problems, jsonText) + "}";
}

std::string jsonCamera(const CameraList::Camera& camera) {
  return "{\"camera\": " + jsonText(camera.name) + ", \"device\": " + jsonText(camera.device) + "}";
}

}  // namespace

bool isUsable(const Row& row) {
  return row.can_be_opened && row.check.state != RemoteCheck::State::kFailed;
}

std::string cameraOf(const Row& row, const CameraList& list) {
  const auto& all = list.cameras();
  const auto camera = std::find_if(
      all.begin(), all.end(), [&](const auto& camera) { return isRemote(row, camera.device); });
  return camera == all.end() ? "" : camera->name;
}

std::vector<CameraList::Camera> absentOf(const CameraList& list, const std::vector<Row>& rows) {
  std::vector<CameraList::Camera> absent;
  for (const CameraList::Camera& camera : list.cameras()) {
    if (std::none_of(rows.begin(), rows.end(),
                     [&](const Row& row) { return isRemote(row, camera.device); }))
      absent.push_back(camera);
  }
  return absent;
}

void print(int number, const Row& row) {
  const std::string where = whereOf(row);
  std::printf("%d  %s  %s%s%s\n", number,
              row.address.empty() ? "(address unknown)" : row.address.c_str(),
              where.empty() ? "(no hidraw node)" : where.c_str(), row.camera.empty() ? "" : "  ",
              row.camera.c_str());
  std::printf("   %s%s\n", row.description.c_str(), permissionOf(row).c_str());
  const std::string state = stateOf(row);
  if (!state.empty())
    std::printf("   %s\n", state.c_str());
  for (const std::string& note : row.notes)
    std::printf("   - %s\n", note.c_str());
  for (const std::string& problem : row.problems)
    std::printf("   ! %s\n", problem.c_str());
  std::fflush(stdout);
}

void printRest(const Listing& listing) {
  if (!listing.advice.empty())
    std::puts(listing.advice.c_str());
  for (const CameraList::Camera& camera : listing.absent)
    std::printf("-  %s  camera %s is not connected\n", camera.device.c_str(), camera.name.c_str());
  for (const auto* problems : {&listing.camera_problems, &listing.computer_problems}) {
    for (const std::string& problem : *problems)
      std::printf("! %s\n", problem.c_str());
  }
}

std::string json(const Listing& listing) {
  return "{\"remotes\": " + jsonList(listing.remotes, jsonRow) +
         ", \"advice\": " + jsonText(listing.advice) +
         ", \"absent\": " + jsonList(listing.absent, jsonCamera) +
         ", \"camera_problems\": " + jsonList(listing.camera_problems, jsonText) +
         ", \"computer_problems\": " + jsonList(listing.computer_problems, jsonText) + "}\n";
}

}  // namespace wiimote_tracker::list_wiimotes
