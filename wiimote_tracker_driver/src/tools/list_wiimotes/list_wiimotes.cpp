// Lists the Wii Remotes of this computer, and keeps the list of a rig's cameras.
#include "arguments.h"
#include "camera_list.h"
#include "host.h"
#include "remote_check.h"
#include "replacement.h"
#include "row.h"
#include "transport/transport.h"

#include <time.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

namespace {

using namespace wiimote_tracker::list_wiimotes;
namespace transport = wiimote_tracker::transport;

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
      std::printf("Remote %zu is not written because its address is unknown.\n", i + 1);
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
  // As in camera_info_manager.
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
  Arguments arguments;
  return parserOf(&arguments).run(argc, argv, [&] {
    check(&arguments);
    if (arguments.replace.empty())
      return list(arguments);
    std::fputs(replaceRemote({arguments.replace[0], arguments.replace[1], arguments.cameras,
                              cameraInfoFolder(arguments), today()})
                   .c_str(),
               stdout);
    return 0;
  });
}
