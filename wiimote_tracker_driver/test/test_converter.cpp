// A converter (DolphinBar) shows four remotes, most of them empty slots: device "" finds the real
// ones. In place of the kernel, this program has hidapi's functions, four slots, and fake time.
#include "fake_remote.h"
#include "temporary_folder.h"
#include "transport/transport.h"
#include "wiimote/wiimote.h"

#include <gtest/gtest.h>
#include <hidapi/hidapi.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace wiimote_tracker::wiimote {
namespace {

enum class Slot { kSilent, kRefusesWrites, kRemote };

struct Converter {
  double now = 100.0;
  std::array<Slot, 4> slots{};
  std::array<FakeRemote, 4> remotes;
  std::array<std::string, 4> paths;  // real files, since they are locked
  std::array<std::string, 4> addresses;
  std::vector<std::size_t> opened;  // slots, in this order
} bar;

}  // namespace
}  // namespace wiimote_tracker::wiimote

using wiimote_tracker::wiimote::bar;
using wiimote_tracker::wiimote::Slot;

struct hid_device_ {
  std::size_t slot;
};

hid_device* hid_open_path(const char* path) {
  const auto at = std::find(bar.paths.begin(), bar.paths.end(), path);
  const auto slot = static_cast<std::size_t>(at - bar.paths.begin());
  bar.opened.push_back(slot);
  return new hid_device_{slot};
}

void hid_close(hid_device* device) {
  delete device;
}

int hid_write(hid_device* device, const unsigned char* data, std::size_t size) {
  if (bar.slots[device->slot] == Slot::kRefusesWrites) {
    errno = EPIPE;  // as hidraw does for an empty slot
    return -1;
  }
  wiimote_tracker::protocol::Report report;
  std::copy(data, data + size, report.bytes.begin());
  report.size = size;
  wiimote_tracker::wiimote::FakeRemote& remote = bar.remotes[device->slot];
  remote.now = bar.now;
  if (bar.slots[device->slot] == Slot::kRemote)
    remote.receive(report);
  return static_cast<int>(size);
}

int hid_read_timeout(hid_device* device, unsigned char* data, std::size_t, int timeout) {
  wiimote_tracker::wiimote::FakeRemote& remote = bar.remotes[device->slot];
  wiimote_tracker::protocol::Report report;
  remote.now = bar.now;
  const bool came = bar.slots[device->slot] == Slot::kRemote && remote.take(report, 1e-3 * timeout);
  bar.now = came ? remote.now : bar.now + 1e-3 * timeout;
  std::copy_n(report.bytes.begin(), report.size, data);
  return came ? static_cast<int>(report.size) : 0;
}

namespace wiimote_tracker::wiimote {
namespace {

std::vector<transport::KernelRemote> slots() {
  std::vector<transport::KernelRemote> slots(bar.paths.size());
  for (std::size_t i = 0; i < slots.size(); ++i) {
    slots[i].path = bar.paths[i];
    slots[i].address = bar.addresses[i];
  }
  return slots;
}

/// A driver with this device.
Wiimote driverOf(const std::string& device) {
  return {Options(), transport::opener(transport::parseDeviceName(device), slots),
          [] { return bar.now; }};
}

Wiimote anyRemote() {
  return driverOf("");
}

class AConverter : public testing::Test {
 protected:
  void SetUp() override {
    bar = Converter();
    for (std::size_t i = 0; i < bar.paths.size(); ++i) {
      bar.paths[i] = folder_ / ("hidraw" + std::to_string(i));
      std::ofstream(bar.paths[i]) << "";
    }
  }

  /// Runs the drivers in turn. @returns the images of each.
  static std::vector<int> run(const std::vector<Wiimote*>& drivers, double duration) {
    std::vector<int> images(drivers.size());
    for (const double end = bar.now + duration; bar.now < end; bar.now += 0.001) {
      for (std::size_t i = 0; i < drivers.size(); ++i)
        images[i] += drivers[i]->step(0.01) ? 1 : 0;
    }
    return images;
  }

  const TemporaryFolder folder_;
};

TEST_F(AConverter, SlotsThatRefuseWritesArePassed) {
  bar.slots = {Slot::kRefusesWrites, Slot::kRefusesWrites, Slot::kRefusesWrites, Slot::kRemote};
  Wiimote driver = anyRemote();
  EXPECT_GT(run({&driver}, 3.0)[0], 50);
  EXPECT_EQ((std::vector<std::size_t>{0, 1, 2, 3}), bar.opened);
  EXPECT_EQ(bar.paths[3], driver.link().remote.description);
}

TEST_F(AConverter, SilentSlotsArePassed) {
  bar.slots = {Slot::kSilent, Slot::kSilent, Slot::kRemote, Slot::kSilent};
  Wiimote driver = anyRemote();
  EXPECT_GT(run({&driver}, 8.0)[0], 50);
  EXPECT_EQ((std::vector<std::size_t>{0, 1, 2}), bar.opened);
}

TEST_F(AConverter, RemoteThatMovesToAnotherSlotIsFound) {
  bar.slots = {Slot::kSilent, Slot::kRemote, Slot::kSilent, Slot::kSilent};
  Wiimote driver = anyRemote();
  EXPECT_GT(run({&driver}, 5.0)[0], 50);
  bar.slots = {Slot::kRemote, Slot::kSilent, Slot::kSilent, Slot::kSilent};
  EXPECT_GT(run({&driver}, 20.0)[0], 50);
  EXPECT_EQ(bar.paths[0], driver.link().remote.description);
  EXPECT_EQ(1U, driver.link().clock_epoch);
}

TEST_F(AConverter, OneThatWorkedIsTakenAgain) {
  bar.slots = {Slot::kSilent, Slot::kRemote, Slot::kRemote, Slot::kRemote};
  Wiimote driver = anyRemote();
  EXPECT_GT(run({&driver}, 5.0)[0], 50);
  bar.slots[1] = Slot::kRefusesWrites;
  while (driver.link().state != Link::State::kSearching && bar.now < 200.0)
    driver.step(0.01);
  bar.slots[1] = Slot::kRemote;
  EXPECT_GT(run({&driver}, 3.0)[0], 50);
  EXPECT_EQ((std::vector<std::size_t>{0, 1, 1}), bar.opened);
}

TEST_F(AConverter, OneWithoutANodeIsPassed) {
  bar.slots = {Slot::kRemote, Slot::kRemote, Slot::kRemote, Slot::kRemote};
  bar.paths[0].clear();
  Wiimote driver = anyRemote();
  EXPECT_GT(run({&driver}, 3.0)[0], 50);
  EXPECT_EQ((std::vector<std::size_t>{1}), bar.opened);
}

TEST_F(AConverter, AnAddressIsThatOfOneRemote) {
  bar.slots = {Slot::kRemote, Slot::kRemote, Slot::kRemote, Slot::kRemote};
  bar.addresses = {"00:1f:32:00:00:01", "00:1f:32:00:00:02", "00:1f:32:00:00:0a",
                   "00:1f:32:00:00:04"};
  Wiimote driver = driverOf("00:1f:32:00:00:0a");
  EXPECT_GT(run({&driver}, 3.0)[0], 50);
  EXPECT_EQ((std::vector<std::size_t>{2}), bar.opened);
  EXPECT_EQ("00:1f:32:00:00:0a", driver.link().remote.identity);
}

TEST_F(AConverter, WhatCannotBeOpenedIsNotSaidToBeInUse) {
  for (const std::string& path : bar.paths) {
    std::filesystem::remove(path);
    std::filesystem::create_directory(path);
  }
  Wiimote driver = anyRemote();
  driver.step(0.01);
  EXPECT_EQ(0U, driver.link().error.find("cannot open ")) << driver.link().error;
}

TEST_F(AConverter, TwoDriversFindTwoRemotes) {
  bar.slots = {Slot::kSilent, Slot::kRefusesWrites, Slot::kRemote, Slot::kRemote};
  Wiimote first = anyRemote(), second = anyRemote();
  const std::vector<int> images = run({&first, &second}, 15.0);
  EXPECT_GT(images[0], 50);
  EXPECT_GT(images[1], 50);
  EXPECT_NE(first.link().remote.description, second.link().remote.description);
}

}  // namespace
}  // namespace wiimote_tracker::wiimote
