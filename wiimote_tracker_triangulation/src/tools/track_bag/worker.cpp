#include "worker.h"

#include <utility>

namespace wiimote_tracker {
namespace {

// Handing a job over costs more than doing it.
constexpr std::size_t kBatch = 256;
constexpr std::size_t kMostWaiting = 16;  // batches

}  // namespace

Worker::Worker(bool has_thread) {
  if (has_thread)
    thread_ = std::thread(&Worker::work, this);
}

Worker::~Worker() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_over_ = true;
    waiting_.clear();
  }
  changed_.notify_all();
  if (thread_.joinable())
    thread_.join();
}

void Worker::give(Job job) {
  if (!thread_.joinable()) {
    job();
    return;
  }
  collected_.push_back(std::move(job));
  if (collected_.size() >= kBatch)
    handOver();
}

void Worker::finish() {
  if (!thread_.joinable())
    return;
  handOver();
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [&] { return waiting_.empty() && !is_busy_; });
  rethrow();
}

void Worker::handOver() {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [&] { return waiting_.size() < kMostWaiting; });
  rethrow();
  waiting_.push_back(std::move(collected_));
  collected_.clear();
  changed_.notify_all();
}

void Worker::rethrow() {
  if (error_)
    std::rethrow_exception(error_);
}

void Worker::work() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return is_over_ || !waiting_.empty(); });
    if (is_over_)
      return;
    const Batch batch = std::move(waiting_.front());
    waiting_.pop_front();
    is_busy_ = true;
    changed_.notify_all();
    const bool has_failed = error_ != nullptr;
    lock.unlock();
    std::exception_ptr error;
    if (!has_failed) {
      try {
        for (const Job& job : batch)
          job();
      } catch (...) {
        error = std::current_exception();
      }
    }
    lock.lock();
    if (error)
      error_ = error;
    is_busy_ = false;
    changed_.notify_all();
  }
}

}  // namespace wiimote_tracker
