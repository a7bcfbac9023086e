#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_WORKER_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_WORKER_H

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace wiimote_tracker {

/// Does jobs one after the other, in a thread of its own or, without one, at once. The outcome is
/// the same. Jobs are given by one thread.
class Worker {
 public:
  using Job = std::function<void()>;

  explicit Worker(bool has_thread);

  /// Jobs that have not begun are left out.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Waits while far too many jobs wait. @throws what an earlier job threw.
  void give(Job job);

  /// Waits until all jobs are done. @throws what a job threw; the jobs after it were left out.
  void finish();

 private:
  using Batch = std::vector<Job>;

  void work();
  void handOver();
  void rethrow();

  Batch collected_;  // not yet handed over; only with a thread
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Batch> waiting_;
  bool is_busy_ = false;
  bool is_over_ = false;
  std::exception_ptr error_;
  std::thread thread_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_WORKER_H
