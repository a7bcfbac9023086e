#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_INBOX_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_INBOX_H

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <utility>

namespace wiimote_tracker {

/// Items of several threads, handled one at a time in the order in which they were put in, by
/// whichever thread is there. A thread that brings items never waits for one that handles them, so
/// that it may hold any lock meanwhile.
template <typename Item>
class Inbox {
 public:
  /// @param most items that may wait; then the oldest is given up for a new one.
  Inbox(std::function<void(const Item&)> handle, std::size_t most)
      : handle_(std::move(handle)), most_(most) {}

  /// From any thread.
  void put(Item item) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (items_.size() >= most_)
      items_.pop_front();
    items_.push_back(std::move(item));
  }

  /// Handles what has been put in. When another thread is at it, or in alone(), that one will, and
  /// this returns at once. From any thread, also while it handles an item.
  void handle() {
    std::unique_lock<std::mutex> lock(mutex_);
    if (is_busy_)
      return;
    const Turn turn(this, &lock);
    handleAll(&lock);
  }

  /// Waits until nothing is being handled and does something else; then handles what has been put
  /// in meanwhile. From a thread that holds no lock which handling an item may need; not while it
  /// handles one.
  template <typename Task>
  void alone(Task task) {
    std::unique_lock<std::mutex> lock(mutex_);
    idle_.wait(lock, [this] { return !is_busy_; });
    const Turn turn(this, &lock);
    lock.unlock();
    task();
    lock.lock();
    handleAll(&lock);
  }

 private:
  /// Ends also when something is thrown.
  class Turn {
   public:
    Turn(Inbox* inbox, std::unique_lock<std::mutex>* lock) : inbox_(inbox), lock_(lock) {
      inbox_->is_busy_ = true;
    }
    ~Turn() {
      if (!lock_->owns_lock())
        lock_->lock();
      inbox_->is_busy_ = false;
      inbox_->idle_.notify_one();
    }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    Inbox* inbox_;
    std::unique_lock<std::mutex>* lock_;
  };

  void handleAll(std::unique_lock<std::mutex>* lock) {
    while (!items_.empty()) {
      const Item item = std::move(items_.front());
      items_.pop_front();
      lock->unlock();
      handle_(item);
      lock->lock();
    }
  }

  const std::function<void(const Item&)> handle_;
  const std::size_t most_;
  std::mutex mutex_;  // of all that follows
  std::condition_variable idle_;
  bool is_busy_ = false;
  std::deque<Item> items_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_INBOX_H
