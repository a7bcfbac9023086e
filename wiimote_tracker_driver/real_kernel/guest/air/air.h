#pragma once

#include "adapter.h"

#include <atomic>
#include <deque>
#include <mutex>
#include <string>
#include <thread>

namespace wiimote_tracker::real_kernel {

/// The Wii Remotes and Bluetooth adapters of a room. Thread-safe; one thread serves all.
class Air {
 public:
  Air();
  ~Air();

  void addAdapter(const std::string& address);
  void addRemote(const std::string& address, Scene& scene, bool plus = false);

  /// The user presses buttons of the remote.
  void press(const std::string& address, Press press);

  /// Its batteries are taken out: the link is lost.
  void cutPower(const std::string& address);

 private:
  Remote& remote(const std::string& address);
  void call(Remote& remote, double end);
  void run();

  std::mutex mutex_;  // guards all but the thread
  Timers timers_;
  std::deque<Remote> remotes_;
  std::deque<Adapter> adapters_;

  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace wiimote_tracker::real_kernel
