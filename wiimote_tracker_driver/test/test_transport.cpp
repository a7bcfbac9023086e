// Device names, error sentences, and the socket transport against the virtual remote.
#include "contains.h"
#include "temporary_folder.h"
#include "transport/hidraw_transport.h"
#include "transport/transport.h"
#include "waiting.h"
#include "wiimote_tracker_driver/virtual_wiimote/server.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <future>
#include <system_error>
#include <thread>

namespace wiimote_tracker::transport {
namespace {

using protocol::Report;
using virtual_wiimote::Server;

template <typename Error, typename F>
std::string sentenceOf(F f) {
  try {
    f();
  } catch (const Error& e) {
    return e.what();
  } catch (const std::exception& e) {
    ADD_FAILURE() << "another error: " << e.what();
    return "";
  }
  ADD_FAILURE() << "no error";
  return "";
}

TEST(DeviceNames, AllKinds) {
  EXPECT_EQ(DeviceName::Kind::kAny, parseDeviceName("").kind);
  const DeviceName address = parseDeviceName("00:1F:32:AB:cd:09");
  EXPECT_EQ(DeviceName::Kind::kAddress, address.kind);
  EXPECT_EQ("00:1f:32:ab:cd:09", address.value);
  const DeviceName path = parseDeviceName("/dev/hidraw12");
  EXPECT_EQ(DeviceName::Kind::kPath, path.kind);
  EXPECT_EQ("/dev/hidraw12", path.value);
  const DeviceName socket = parseDeviceName("virtual:/tmp/a:b.sock");
  EXPECT_EQ(DeviceName::Kind::kVirtual, socket.kind);
  EXPECT_EQ("/tmp/a:b.sock", socket.value);
  const DeviceName recording = parseDeviceName("replay:/tmp/a b.wiirec");
  EXPECT_EQ(DeviceName::Kind::kReplay, recording.kind);
  EXPECT_EQ("/tmp/a b.wiirec", recording.value);
  EXPECT_THROW(open(recording), BadDeviceName);
}

TEST(DeviceNames, RemotesAreTriedInTurn) {
  std::vector<KernelRemote> remotes(3);
  for (std::size_t i = 0; i < remotes.size(); ++i)
    remotes[i].path = "/dev/hidraw" + std::to_string(i);
  const auto first = [&](const std::string& last, bool delivered = false) {
    orderAfter(last, delivered, &remotes);
    return remotes.front().path;
  };
  EXPECT_EQ("/dev/hidraw0", first(""));
  EXPECT_EQ("/dev/hidraw0", first("/dev/hidraw9"));
  EXPECT_EQ("/dev/hidraw1", first("/dev/hidraw0"));
  EXPECT_EQ("/dev/hidraw2", first("/dev/hidraw1"));
  EXPECT_EQ("/dev/hidraw0", first("/dev/hidraw2"));
  EXPECT_EQ("/dev/hidraw1", first("/dev/hidraw1", true));
}

TEST(SocketTransport, OnlyTheOwnerMayConnect) {
  const TemporaryFolder folder;
  const std::string path = folder / "remote.sock";
  const Server server(path, "00:1f:32:00:00:01", {});
  struct stat info {};
  ASSERT_EQ(0, stat(path.c_str(), &info));
  EXPECT_EQ(0600U, info.st_mode & 0777U);
}

TEST(SocketTransport, RemoteThatReadsNoMoreDoesNotBlock) {
  const TemporaryFolder folder;
  const std::string path = folder / "remote.sock";
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof(address.sun_path) - 1);
  const int listener = ::socket(AF_UNIX, SOCK_SEQPACKET, 0);
  ASSERT_EQ(0, ::bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof(address)));
  ASSERT_EQ(0, ::listen(listener, 1));
  int remote = -1;
  std::thread accepts([&] {
    remote = ::accept(listener, nullptr, nullptr);
    ::send(remote, "00:1f:32:00:00:01", 17, 0);
  });
  const auto transport = open(parseDeviceName("virtual:" + path));
  accepts.join();
  const auto fill = [&] {
    for (int i = 0; i < 1000000; ++i)
      transport->write({0x15, 0x00});
  };
  EXPECT_TRUE(contains(sentenceOf<Disconnected>(fill), "reads no reports any more"));
  ::close(remote);
  ::close(listener);
}

TEST(DeviceNames, MalformedOnesAreRefusedByName) {
  for (const char* text :
       {"00:1f:32:ab:cd", "00:1f:32:ab:cd:0g", "00-1f-32-ab-cd-09", "hidraw0", "/dev/hidraw",
        "/dev/hidraw1x", "/dev/ttyUSB0", "virtual:", "replay:", "any"}) {
    EXPECT_TRUE(contains(sentenceOf<BadDeviceName>([&] { parseDeviceName(text); }), text));
  }
}

TEST(OpenErrors, PermissionNamesTheUdevRule) {
  const std::string sentence =
      sentenceOf<PermissionDenied>([] { throwOpenError(EACCES, "/dev/hidraw3"); });
  EXPECT_TRUE(contains(sentence, "/dev/hidraw3"));
  EXPECT_TRUE(contains(sentence, kUdevRule));
}

TEST(OpenErrors, NamedRuleIsShipped) {
  std::ifstream file(std::string(UDEV_DIRECTORY) + "/" + kUdevRule);
  std::string all((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  EXPECT_TRUE(contains(all, "KERNELS==\"*057E:0306*\""));
  EXPECT_TRUE(contains(all, "KERNELS==\"*057E:0330*\""));
}

TEST(OpenErrors, MissingNode) {
  EXPECT_TRUE(contains(sentenceOf<NoSuchDevice>([] { throwOpenError(ENOENT, "/dev/hidraw3"); }),
                       "/dev/hidraw3"));
  EXPECT_TRUE(contains(sentenceOf<TransportError>([] { throwOpenError(EIO, "/dev/hidraw3"); }),
                       "/dev/hidraw3"));
}

TEST(OpenErrors, HidrawThatIsNotThere) {
  const std::string address = "00:00:00:00:00:00";
  EXPECT_TRUE(contains(sentenceOf<NoSuchDevice>([&] { open(parseDeviceName(address)); }), address));
  const std::string path = "/dev/hidraw98765";
  EXPECT_TRUE(contains(sentenceOf<NoSuchDevice>([&] { open(parseDeviceName(path)); }), path));
}

/// A separate directory for the sockets of each test.
class Sockets : public testing::Test {
 protected:
  std::unique_ptr<Server> serve() const {
    return std::make_unique<Server>(path_, "00:1f:32:00:00:01", virtual_wiimote::Device::Options());
  }
  std::unique_ptr<Transport> connect() const { return open(parseDeviceName("virtual:" + path_)); }

  /// A socket at the path, to which nobody listens yet.
  int boundSocket() const {
    const int fd = ::socket(AF_UNIX, SOCK_SEQPACKET, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path_.copy(address.sun_path, sizeof(address.sun_path) - 1);
    EXPECT_EQ(0, ::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof(address)));
    return fd;
  }

  /// The next report, which must come.
  static Report next(Transport& transport) {
    Report report;
    EXPECT_TRUE(transport.read(report, 10.0));
    return report;
  }

  const TemporaryFolder folder_;
  const std::string path_ = folder_ / "remote.sock";
};

TEST_F(Sockets, ReportsPassInBothDirections) {
  const auto server = serve();
  const auto transport = connect();
  EXPECT_EQ("00:1f:32:00:00:01", transport->remote().identity);
  EXPECT_EQ("virtual:" + path_, transport->remote().description);
  EXPECT_EQ("", transport->remote().kernel_driver);
  transport->write({0x15, 0x00});
  EXPECT_EQ((Report{0x20, 0, 0, 0, 0, 0, 0xa0}), next(*transport));
  transport->write({0x12, 0x06, 0x31});
  EXPECT_EQ((Report{0x22, 0, 0, 0x12, 0x00}), next(*transport));
  EXPECT_EQ(0x31, next(*transport).id());
  virtual_wiimote::Senses senses;
  senses.buttons = 0x0008;
  server->sample(senses);
  EXPECT_EQ((Report{0x31, 0x60, 0x48, 0x84, 0x82, 0x9f}), next(*transport));
}

TEST_F(Sockets, ReadReturnsEmptyHandedAtItsTimeout) {
  const auto server = serve();
  const auto transport = connect();
  Report report;
  EXPECT_FALSE(transport->read(report, 0.0));
  const double begin = steadyNow();
  EXPECT_FALSE(transport->read(report, 0.05));
  EXPECT_LE(0.05, steadyNow() - begin);
}

TEST_F(Sockets, RefusesASocketWithoutAServer) {
  EXPECT_TRUE(contains(sentenceOf<NoSuchDevice>([&] { connect(); }), path_));
  std::ofstream(path_) << "not a socket";
  EXPECT_TRUE(contains(sentenceOf<NoSuchDevice>([&] { connect(); }), path_));
}

TEST_F(Sockets, SaysWhereARelativePathBegins) {
  const std::string folder = std::filesystem::current_path().string();
  const auto sentence = [](const std::string& path) {
    return sentenceOf<NoSuchDevice>([&] { open(parseDeviceName("virtual:" + path)); });
  };
  EXPECT_TRUE(contains(sentence("nowhere.sock"), "at nowhere.sock in " + folder + ": "));
  EXPECT_TRUE(contains(sentence("/nowhere.sock"), "at /nowhere.sock: "));
}

TEST_F(Sockets, TooLongPath) {
  const std::string path = "/tmp/" + std::string(200, 'x');
  EXPECT_TRUE(
      contains(sentenceOf<BadDeviceName>([&] { open(parseDeviceName("virtual:" + path)); }), path));
  EXPECT_THROW(Server(path, "a", virtual_wiimote::Device::Options()), std::system_error);
}

TEST_F(Sockets, SecondHostIsRefusedUntilTheFirstHasGone) {
  const auto server = serve();
  auto first = connect();
  const std::string sentence = sentenceOf<DeviceTaken>([&] { connect(); });
  EXPECT_TRUE(contains(sentence, path_)) << sentence;
  EXPECT_TRUE(contains(sentence, "in use by this very process (")) << sentence;
  EXPECT_TRUE(server->connected());
  first.reset();
  EXPECT_TRUE(eventually([&] { return !server->connected(); }));
  EXPECT_EQ("00:1f:32:00:00:01", connect()->remote().identity);
}

TEST_F(Sockets, SecondHostGetsTheOtherProcess) {
  const auto server = serve();
  const pid_t other = ::fork();
  if (other == 0) {
    const auto transport = connect();
    Report report;
    while (transport->read(report, 60.0)) {
      // Until it is told to end.
    }
    ::_exit(0);
  }
  EXPECT_TRUE(eventually([&] { return server->connected(); }));
  const std::string sentence = sentenceOf<DeviceTaken>([&] { connect(); });
  EXPECT_TRUE(contains(sentence, "test_transport")) << sentence;
  EXPECT_TRUE(contains(sentence, "process " + std::to_string(other) + ")")) << sentence;
  ::kill(other, SIGKILL);
  ::waitpid(other, nullptr, 0);
}

TEST_F(Sockets, DeviceGoesAwayAndComesBackPowerCycled) {
  const auto server = serve();
  const auto transport = connect();
  transport->write({0x11, 0x12});
  EXPECT_EQ((Report{0x22, 0, 0, 0x11, 0x00}), next(*transport));
  EXPECT_EQ(0x01, server->leds());
  server->setPresent(false);
  Report report;
  EXPECT_TRUE(contains(sentenceOf<Disconnected>([&] { transport->read(report, 10.0); }), path_));
  EXPECT_THROW(transport->write({0x15, 0x00}), Disconnected);
  EXPECT_THROW(connect(), NoSuchDevice);
  EXPECT_FALSE(server->connected());
  server->sample(virtual_wiimote::Senses());
  server->setPresent(true);
  const auto again = connect();
  EXPECT_EQ(0x00, server->leds());
  again->write({0x15, 0x00});
  EXPECT_EQ(0x20, next(*again).id());
}

TEST_F(Sockets, AHostThatDoesNotReadDoesNotBlock) {
  const auto server = serve();
  const auto transport = connect();
  transport->write({0x12, 0x06, 0x30});
  EXPECT_EQ(0x22, next(*transport).id());
  for (int i = 0; i < 20000; ++i)
    server->sample(virtual_wiimote::Senses());
  EXPECT_EQ(0x30, next(*transport).id());
}

// The kernel reports that a peer left with unread reports before it delivers that peer's writes.
TEST_F(Sockets, LastWritesOfAHostThatLeavesReportsUnreadArrive) {
  const auto server = serve();
  for (int i = 0; i < 200; ++i) {
    auto transport = connect();
    transport->write({0x12, 0x06, 0x30});
    EXPECT_EQ(0x22, next(*transport).id());
    server->sample(virtual_wiimote::Senses());
    const auto leds = static_cast<std::uint8_t>(i % 16);
    transport->write({0x11, static_cast<std::uint8_t>(leds << 4)});
    transport.reset();
    ASSERT_TRUE(eventually([&] { return !server->connected(); }));
    ASSERT_EQ(leds, server->leds()) << "round " << i;
  }
}

TEST_F(Sockets, StaleFileIsReplacedALiveOneIsNot) {
  ::close(boundSocket());
  const auto server = serve();
  EXPECT_EQ("00:1f:32:00:00:01", connect()->remote().identity);
  EXPECT_THROW(serve(), std::system_error);
}

// The first attempt fills the queue of those who wait to be accepted.
TEST_F(Sockets, OneThatHangsIsNotCalledTakenAndDoesNotBlock) {
  const int fd = boundSocket();
  ASSERT_EQ(0, ::listen(fd, 0));
  const auto attempts = std::async(std::launch::async, [&] {
    for (int i = 0; i < 2; ++i)
      EXPECT_TRUE(contains(sentenceOf<TransportError>([&] { connect(); }), "does not answer"));
    EXPECT_THROW(serve(), std::system_error);
  });
  EXPECT_EQ(std::future_status::ready, attempts.wait_for(std::chrono::seconds(30)));
  ::close(fd);  // ends the wait
}

TEST_F(Sockets, DirectoryThatIsNotThere) {
  EXPECT_THROW(Server(folder_ / "none/remote.sock", "a", virtual_wiimote::Device::Options()),
               std::system_error);
}

}  // namespace
}  // namespace wiimote_tracker::transport
