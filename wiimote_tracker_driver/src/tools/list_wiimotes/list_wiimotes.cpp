// Lists the Wii Remotes of this computer, and keeps the list of a rig's cameras.
#include "camera_list.h"
#include "host.h"
#include "listing.h"
#include "remote_check.h"
#include "replacement.h"
#include "transport/transport.h"
#include "transport/users.h"

#include <wiimote_tracker_msgs/argument_parser.h>
#include <wiimote_tracker_msgs/ros_home.h>
#include <boost/date_time/gregorian/gregorian.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

namespace wiimote_tracker::list_wiimotes {
namespace {

/// Arguments of the program.
struct Arguments {
  bool identify = false;
  bool json = false;
  std::string write;                 ///< A cameras.yaml, may be new; or empty.
  std::string cameras;               ///< A cameras.yaml, or empty.
  std::string device;                ///< Address or path of the only remote to list, or empty.
  std::vector<std::string> sockets;  ///< Of virtual remotes.
  std::vector<std::string> replace;  ///< A camera's name and its new address; empty: list.
  std::string camera_info;           ///< A folder; empty: the default of camera_info_manager.
};

/// As the driver calls it. @throws BadArguments.
std::string addressOrPath(const std::string& text) {
  using Kind = transport::DeviceName::Kind;
  try {
    const transport::DeviceName name = transport::parseDeviceName(text);
    if (name.kind == Kind::kAddress || name.kind == Kind::kPath)
      return name.value;
  } catch (const transport::BadDeviceName&) {
  }
  throw BadArguments("--device is '" + text +
                     "', but must be a Bluetooth address such as 00:1f:32:12:34:56, or a path such "
                     "as /dev/hidraw0");
}

/// What the parser cannot know; `device` becomes what the driver calls it. @throws BadArguments.
void check(Arguments* arguments) {
  const bool replaces = !arguments->replace.empty();
  if (replaces && (arguments->replace.size() != 2 || arguments->cameras.empty()))
    throw BadArguments("--replace needs CAMERA ADDRESS, and --cameras FILE");
  if (replaces && (arguments->identify || !arguments->write.empty() || !arguments->device.empty() ||
                   !arguments->sockets.empty()))
    throw BadArguments("--replace lists no remotes: use only --cameras and --camera-info with it");
  if (!replaces && !arguments->camera_info.empty())
    throw BadArguments("--camera-info has an effect only with --replace: leave it out");
  if (arguments->json && (replaces || arguments->identify))
    throw BadArguments("--json is for a list: leave out --identify and --replace");
  if (!arguments->write.empty() && !arguments->cameras.empty())
    throw BadArguments(
        "--cameras has no effect with --write FILE, which shows the names of FILE: leave it out");
  if (!arguments->device.empty() && !arguments->sockets.empty())
    throw BadArguments("--device has no effect on --virtual remotes: leave one of them out");
  if (!arguments->device.empty())
    arguments->device = addressOrPath(arguments->device);
}

constexpr double kAnswerTimeout = 1.0;  // [s]

/// The remotes known to the kernel, or only that with the address or path `wanted`.
std::vector<Row> rowsOf(const Host& host, const std::string& wanted) {
  std::vector<Row> rows;
  for (const transport::KernelRemote& remote : host.remotes) {
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
    row.notes = notes(remote);
    row.problems = problems(remote);
    rows.push_back(row);
  }
  return rows;
}

/// Virtual remotes at these sockets.
std::vector<Row> rowsOf(const std::vector<std::string>& sockets) {
  std::vector<Row> rows;
  for (const std::string& path : sockets) {
    Row row;
    // Drivers may run in another folder than this program.
    row.text = "virtual:" + std::filesystem::absolute(path).string();
    row.device = transport::parseDeviceName(row.text);
    row.description = "virtual Wii Remote";
    rows.push_back(row);
  }
  return rows;
}

/// Tries to talk to the remote, and looks up its name in the list.
void check(const CameraList& list, Row* row) {
  if (row->can_be_opened) {
    row->check = checkRemote(row->device, kAnswerTimeout);
    if (row->address.empty())
      row->address = row->check.identity;
    if (row->check.state == RemoteCheck::State::kTaken)
      row->notes.insert(row->notes.begin(), row->check.sentence);
    if (row->check.state == RemoteCheck::State::kFailed)
      row->problems.insert(row->problems.begin(), row->check.sentence);
    // If a driver uses it, the check has named it.
    if (row->device.kind == transport::DeviceName::Kind::kPath &&
        row->check.state == RemoteCheck::State::kFree) {
      const std::string others = transport::sharedWith(row->device.value);
      if (!others.empty())
        row->problems.push_back(others);
    }
  }
  row->camera = cameraOf(*row, list);
}

void identify(const std::vector<Row>& rows) {
  const auto wait = [](double seconds) {
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  };
  std::puts("");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const int number = static_cast<int>(i) + 1;
    if (rows[i].check.state != RemoteCheck::State::kFree) {
      std::printf("Remote %d cannot flash now%s%s\n", number,
                  rows[i].check.sentence.empty() ? "" : ": ", rows[i].check.sentence.c_str());
      continue;
    }
    std::printf("Remote %d flashes %d time%s.\n", number, number, number == 1 ? "" : "s");
    std::fflush(stdout);
    try {
      flash(*transport::open(rows[i].device), number, rows[i].check.status->leds, wait);
    } catch (const transport::TransportError& e) {
      std::printf("   ! %s\n", e.what());
    }
  }
}

/// Adds the new remotes to the file. @returns what was done, for people.
std::string write(const std::string& path, CameraList list, std::vector<Row>* rows) {
  bool changed = false;
  std::string done = "\n";
  for (std::size_t i = 0; i < rows->size(); ++i) {
    Row& row = (*rows)[i];
    if (!row.camera.empty())
      continue;
    const std::string remote = "Remote " + std::to_string(i + 1);
    if (row.text.empty() || row.address.empty()) {
      done += remote + " is not written because its address is unknown.\n";
    } else {
      row.camera = list.add(row.text);
      done += remote + " (" + row.address + ") is camera " + row.camera + ".\n";
      changed = true;
    }
  }
  if (changed)
    writeCameraList(list, path);
  return done + (changed                  ? "Written to " + path + ".\n"
                 : list.cameras().empty() ? "Nothing was written to " + path + ".\n"
                                          : path + " needed no change.\n");
}

CameraList listOf(const Arguments& arguments) {
  if (!arguments.write.empty()) {
    requireFile(arguments.write);
    std::error_code unknown;  // such as a folder of others: reading says why
    if (!std::filesystem::exists(arguments.write, unknown) && !unknown)
      return CameraList();
  }
  const std::string& path = arguments.write.empty() ? arguments.cameras : arguments.write;
  return path.empty() ? CameraList() : readCameraList(path);
}

int list(const Arguments& arguments) {
  const CameraList cameras = listOf(arguments);
  const bool is_virtual = !arguments.sockets.empty();
  const Host host = is_virtual ? Host() : readHost();
  Listing listing;
  listing.remotes = is_virtual ? rowsOf(arguments.sockets) : rowsOf(host, arguments.device);
  std::vector<Row>& rows = listing.remotes;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    check(cameras, &rows[i]);
    if (!arguments.json)
      print(static_cast<int>(i) + 1, rows[i]);
  }
  if (rows.empty())
    listing.advice =
        arguments.device.empty()
            ? "No Wii Remote is connected: press a button of a paired one, or pair one with  "
              "rosrun wiimote_tracker_driver pair"
            : "This Wii Remote is not connected: press one of its buttons.";
  if (arguments.device.empty())
    listing.absent = absentOf(cameras, rows);
  listing.camera_problems = problems(cameras);
  if (!is_virtual && arguments.device.empty())
    listing.computer_problems = problems(host);
  if (!arguments.json)
    printRest(listing);
  std::string said;
  if (!arguments.write.empty() && !rows.empty())
    said = write(arguments.write, cameras, &rows);
  std::fputs((arguments.json ? json(listing) : said).c_str(), stdout);
  if (arguments.identify)
    identify(rows);
  return !rows.empty() && std::all_of(rows.begin(), rows.end(), isUsable) ? 0 : 1;
}

std::string cameraInfoFolder(const Arguments& arguments) {
  // As in camera_info_manager.
  return arguments.camera_info.empty() ? rosHome() + "/camera_info" : arguments.camera_info;
}

}  // namespace
}  // namespace wiimote_tracker::list_wiimotes

int main(int argc, char** argv) {
  using namespace wiimote_tracker::list_wiimotes;
  Arguments arguments;
  wiimote_tracker::ArgumentParser parser(
      "list_wiimotes",
      "Lists the Wii Remotes of this computer, and says for each problem what to do.\n"
      "Exit status: 0 when there are remotes and all are free or in use by a driver, 1 when not,\n"
      "2 for wrong arguments.");
  parser.flag("--identify", &arguments.identify, "each free remote flashes its number in turn");
  parser.flag("--json", &arguments.json, "for programs: the list as JSON");
  parser.option("--write FILE", &arguments.write,
                "add new remotes to the cameras.yaml FILE as wiimote_1, ...; the names in it stay, "
                "and the old file is kept as FILE.bak");
  parser.option("--cameras FILE", &arguments.cameras, "show the names from this cameras.yaml");
  parser.option("--device ADDRESS", &arguments.device, "list only this remote");
  parser.option("--virtual PATH...", &arguments.sockets,
                "list the virtual remotes at these sockets only");
  parser.option("--replace CAMERA ADDRESS", &arguments.replace,
                "CAMERA gets the remote with ADDRESS in the cameras.yaml; the calibration of its "
                "lens is renamed");
  parser.option("--camera-info FOLDER", &arguments.camera_info,
                "where <camera>.yaml is (default: $ROS_HOME/camera_info, or ~/.ros/camera_info if "
                "ROS_HOME is not set)");
  return parser.run(argc, argv, [&] {
    check(&arguments);
    if (arguments.replace.empty())
      return list(arguments);
    const std::string today =
        boost::gregorian::to_iso_extended_string(boost::gregorian::day_clock::local_day());
    std::fputs(replaceRemote({arguments.replace[0], arguments.replace[1], arguments.cameras,
                              cameraInfoFolder(arguments), today})
                   .c_str(),
               stdout);
    return 0;
  });
}
