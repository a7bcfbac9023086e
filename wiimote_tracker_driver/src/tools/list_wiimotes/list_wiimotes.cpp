// Lists the Wii Remotes of this computer, and keeps the list of a rig's cameras.
#include "camera_list.h"
#include "host.h"
#include "remote_check.h"
#include "replacement.h"
#include "wiimote_tracker_driver/protocol/input_reports.h"
#include "wiimote_tracker_driver/transport/transport.h"
#include "wiimote_tracker_driver/transport/users.h"

#include <time.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace {

using namespace wiimote_tracker::list_wiimotes;
namespace transport = wiimote_tracker::transport;
namespace protocol = wiimote_tracker::protocol;

constexpr double kAnswerTimeout = 1.0;  // [s]

constexpr char kUsage[] =
    R"(Lists the Wii Remotes of this computer, and says for each problem what to do.

  list_wiimotes [--identify] [--write FILE] [--cameras FILE] [--device ADDRESS]
                [--virtual SOCKET_PATH...]
  list_wiimotes --replace CAMERA ADDRESS --cameras FILE [--camera-info FOLDER]

  --identify       let each free remote flash its number in turn
  --write FILE     add the remotes that are not there to the cameras.yaml FILE, as wiimote_1, ...;
                   names that are there stay; the file before is kept as FILE.bak
  --cameras FILE   show the cameras' names from this cameras.yaml
  --device ADDRESS list this remote alone
  --virtual PATH.. list the virtual remotes at these sockets, and nothing of this computer
  --replace        CAMERA gets the remote with ADDRESS in the cameras.yaml FILE; the calibration of
                   its lens in FOLDER (default: ~/.ros/camera_info) is set aside

Exit status: 0 when there are remotes and all are free or in use by a driver, 1 when not, 2 for
arguments that make no sense.
)";

struct BadArguments : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Arguments {
  bool help = false;
  bool identify = false;
  std::string write;
  std::string cameras;
  std::string device;
  std::vector<std::string> sockets;
  std::string replaced_camera;
  std::string new_address;
  std::string camera_info;
};

Arguments parseArguments(int argc, char** argv) {
  Arguments arguments;
  const auto value = [&](int* i) -> std::string {
    if (*i + 1 >= argc || std::string(argv[*i + 1]).rfind("--", 0) == 0)
      throw BadArguments(std::string(argv[*i]) + " lacks a value");
    return argv[++*i];
  };
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--help" || argument == "-h") {
      arguments.help = true;
    } else if (argument == "--identify") {
      arguments.identify = true;
    } else if (argument == "--write") {
      arguments.write = value(&i);
    } else if (argument == "--cameras") {
      arguments.cameras = value(&i);
    } else if (argument == "--device") {
      arguments.device = value(&i);
    } else if (argument == "--camera-info") {
      arguments.camera_info = value(&i);
    } else if (argument == "--replace") {
      arguments.replaced_camera = value(&i);
      arguments.new_address = value(&i);
    } else if (argument == "--virtual") {
      do {
        arguments.sockets.push_back(value(&i));
      } while (i + 1 < argc && argv[i + 1][0] != '-');
    } else {
      throw BadArguments("unknown argument " + argument);
    }
  }
  if (!arguments.replaced_camera.empty() && arguments.cameras.empty())
    throw BadArguments("--replace needs --cameras FILE");
  try {
    if (!arguments.device.empty())
      arguments.device = transport::parseDeviceName(arguments.device).value;
  } catch (const transport::BadDeviceName& e) {
    throw BadArguments(e.what());
  }
  return arguments;
}

/// A remote in the list.
struct Row {
  transport::DeviceName device;  ///< How to open it.
  std::string text;              ///< How a cameras.yaml names it; empty when it cannot.
  std::string address;
  std::string description;
  bool can_be_opened = true;
  std::vector<std::string> hints;
  RemoteCheck check;
  std::string camera;
};

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
    // A driver that has it is named already.
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

std::string permissionOf(const Row& row) {
  if (row.device.kind != transport::DeviceName::Kind::kPath || row.device.value.empty())
    return "";
  const bool allowed = ::access(row.device.value.c_str(), R_OK | W_OK) == 0;
  return allowed ? ", you may open it" : ", you may NOT open it";
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
                status.battery_low ? ": put new batteries in" : "");
  } else if (!row.check.sentence.empty()) {
    std::printf("   %s %s\n", isFine(row) ? "-" : "!", row.check.sentence.c_str());
  }
  for (const std::string& hint : row.hints)
    std::printf("   ! %s\n", hint.c_str());
  std::fflush(stdout);
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

void write(const std::string& path, CameraList list, const std::vector<Row>& rows) {
  std::puts("");
  bool changed = false;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    if (row.text.empty() || row.address.empty()) {
      std::printf("Remote %zu is not written, because its address is unknown.\n", i + 1);
    } else if (row.camera.empty()) {
      std::printf("Remote %zu (%s) is camera %s.\n", i + 1, row.address.c_str(),
                  list.add(row.text).c_str());
      changed = true;
    }
  }
  if (changed)
    writeCameraList(list, path);
  std::printf(changed ? "Written to %s.\n" : "%s needed no change.\n", path.c_str());
}

CameraList listOf(const Arguments& arguments) {
  if (!arguments.write.empty() && !std::filesystem::exists(arguments.write))
    return CameraList();
  const std::string& path = arguments.write.empty() ? arguments.cameras : arguments.write;
  return path.empty() ? CameraList() : readCameraList(path);
}

int list(const Arguments& arguments) {
  CameraList cameras = listOf(arguments);
  const bool is_virtual = !arguments.sockets.empty();
  const Host host = is_virtual ? Host() : readHost();
  std::vector<Row> rows = is_virtual ? rowsOf(arguments.sockets) : rowsOf(host, arguments.device);
  bool fine = !rows.empty();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    check(cameras, &rows[i]);
    print(static_cast<int>(i) + 1, rows[i]);
    fine = fine && isFine(rows[i]);
  }
  if (rows.empty())
    std::puts(arguments.device.empty()
                  ? "No Wii Remote is connected: press a button of a paired one, or pair one with  "
                    "rosrun wiimote_tracker_driver pair"
                  : "This Wii Remote is not connected: press one of its buttons.");
  for (const CameraList::Entry& entry : cameras.entries()) {
    bool connected = false;
    for (const Row& row : rows)
      connected = connected || row.camera == entry.name;
    if (!connected && arguments.device.empty())
      std::printf("-  %s  camera %s is not connected\n", entry.device.c_str(), entry.name.c_str());
  }
  if (!is_virtual && arguments.device.empty()) {
    for (const std::string& sentence : problems(host))
      std::printf("! %s\n", sentence.c_str());
  }
  if (!arguments.write.empty() && !rows.empty())
    write(arguments.write, cameras, rows);
  if (arguments.identify)
    identify(rows);
  return fine ? 0 : 1;
}

std::string cameraInfoFolder(const Arguments& arguments) {
  if (!arguments.camera_info.empty())
    return arguments.camera_info;
  // Where camera_info_manager keeps them.
  const char* const ros_home = std::getenv("ROS_HOME");
  const char* const home = std::getenv("HOME");
  return (ros_home != nullptr ? std::string(ros_home)
                              : std::string(home != nullptr ? home : "") + "/.ros") +
         "/camera_info";
}

std::string today() {
  const time_t now = ::time(nullptr);
  tm local{};
  ::localtime_r(&now, &local);
  char text[32];
  std::strftime(text, sizeof(text), "%Y-%m-%d", &local);
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Arguments arguments = parseArguments(argc, argv);
    if (arguments.help) {
      std::fputs(kUsage, stdout);
      return 0;
    }
    if (arguments.replaced_camera.empty())
      return list(arguments);
    std::fputs(replaceRemote({arguments.replaced_camera, arguments.new_address, arguments.cameras,
                              cameraInfoFolder(arguments), today()})
                   .c_str(),
               stdout);
    return 0;
  } catch (const BadArguments& e) {
    std::fprintf(stderr, "list_wiimotes: %s; see --help\n", e.what());
    return 2;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "list_wiimotes: %s\n", e.what());
    return 1;
  }
}
