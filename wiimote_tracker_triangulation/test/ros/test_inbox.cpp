#include "inbox.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <future>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

namespace wiimote_tracker {
namespace {

constexpr auto kDeadline = std::chrono::seconds(60);
constexpr std::size_t kMany = 1000000;

TEST(Inbox, HandlesInTheOrderInWhichItemsWerePutIn) {
  std::vector<int> handled;
  Inbox<int> inbox([&](int item) { handled.push_back(item); }, kMany);
  for (const int item : {3, 1, 2})
    inbox.put(item);
  EXPECT_TRUE(handled.empty());
  inbox.handle();
  EXPECT_EQ((std::vector<int>{3, 1, 2}), handled);
}

TEST(Inbox, GivesUpTheOldestWhenItIsFull) {
  std::vector<int> handled;
  Inbox<int> inbox([&](int item) { handled.push_back(item); }, 2);
  for (const int item : {1, 2, 3})
    inbox.put(item);
  inbox.handle();
  EXPECT_EQ((std::vector<int>{2, 3}), handled);
}

TEST(Inbox, WhatComesWhileOneIsHandledComesAfterIt) {
  std::vector<int> handled;
  Inbox<int>* self = nullptr;
  Inbox<int> inbox(
      [&](int item) {
        if (item == 1) {
          self->put(2);
          self->handle();
        }
        handled.push_back(item);
      },
      kMany);
  self = &inbox;
  inbox.put(1);
  inbox.handle();
  EXPECT_EQ((std::vector<int>{1, 2}), handled);
}

TEST(Inbox, NobodyWaitsForTheThreadThatHandles) {
  std::promise<void> started, go_on;
  std::vector<int> handled;
  std::thread::id handler;
  Inbox<int> inbox(
      [&](int item) {
        if (item == 1) {
          started.set_value();
          go_on.get_future().wait();
        }
        handler = std::this_thread::get_id();
        handled.push_back(item);
      },
      kMany);
  std::thread busy([&] {
    inbox.put(1);
    inbox.handle();
  });
  const std::thread::id busy_id = busy.get_id();
  started.get_future().wait();
  inbox.put(2);
  inbox.handle();  // would last for ever
  go_on.set_value();
  busy.join();
  EXPECT_EQ((std::vector<int>{1, 2}), handled);
  EXPECT_EQ(busy_id, handler);
}

TEST(Inbox, WhatComesWhileAnotherIsAloneIsHandledThereAfterwards) {
  bool is_alone = false;
  std::vector<int> handled;
  std::thread::id handler;
  Inbox<int> inbox(
      [&](int item) {
        EXPECT_FALSE(is_alone);
        handled.push_back(item);
        handler = std::this_thread::get_id();
      },
      kMany);
  inbox.alone([&] {
    is_alone = true;
    std::thread([&] {
      inbox.put(1);
      inbox.handle();
    }).join();
    EXPECT_TRUE(handled.empty());
    is_alone = false;
  });
  EXPECT_EQ((std::vector<int>{1}), handled);
  EXPECT_EQ(std::this_thread::get_id(), handler);
}

TEST(Inbox, GoesOnAfterAnException) {
  std::vector<int> handled;
  Inbox<int> inbox(
      [&](int item) {
        if (item == 1)
          throw std::runtime_error("one");
        handled.push_back(item);
      },
      kMany);
  inbox.put(1);
  inbox.put(2);
  EXPECT_THROW(inbox.handle(), std::runtime_error);
  EXPECT_THROW(inbox.alone([] { throw std::runtime_error("alone"); }), std::runtime_error);
  inbox.handle();
  EXPECT_EQ((std::vector<int>{2}), handled);
}

// As roscpp has it: whoever publishes holds one lock for all, while the items are brought too; and
// handling an item publishes. The owner's task takes the lock only after it has its turn.
TEST(Inbox, ThreadsThatHoldALockThatHandlingNeedsDoNotLockUp) {
  constexpr int kThreads = 4;
  constexpr int kItems = 5000;
  using Item = std::pair<int, int>;  // thread, count
  std::recursive_mutex publishing;
  std::atomic<int> at_once{0};
  std::vector<int> newest(kThreads, -1);
  int handled = 0;
  int tasks = 0;
  Inbox<Item> inbox(
      [&](const Item& item) {
        EXPECT_EQ(1, ++at_once);
        const std::lock_guard<std::recursive_mutex> lock(publishing);
        EXPECT_EQ(newest[item.first] + 1, item.second);
        newest[item.first] = item.second;
        ++handled;
        --at_once;
      },
      kMany);
  auto all = std::async(std::launch::async, [&] {
    std::atomic<int> running{kThreads};
    std::vector<std::thread> threads;
    for (int i = 0; i < kThreads; ++i) {
      threads.emplace_back([&, i] {
        for (int k = 0; k < kItems; ++k) {
          // One of them comes without the lock, as over a network.
          std::unique_lock<std::recursive_mutex> lock(publishing, std::defer_lock);
          if (i > 0)
            lock.lock();
          inbox.put({i, k});
          inbox.handle();
        }
        --running;
      });
    }
    while (running > 0) {
      inbox.alone([&] {
        EXPECT_EQ(1, ++at_once);
        const std::lock_guard<std::recursive_mutex> lock(publishing);
        ++tasks;
        --at_once;
      });
    }
    for (std::thread& thread : threads)
      thread.join();
  });
  if (all.wait_for(kDeadline) != std::future_status::ready) {
    std::fprintf(stderr, "The threads wait for one another.\n");
    std::abort();  // nothing can end them
  }
  EXPECT_EQ(kThreads * kItems, handled);
  EXPECT_LT(0, tasks);
}

}  // namespace
}  // namespace wiimote_tracker
