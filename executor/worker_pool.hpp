#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace tessera {

/// Threads that run the operations of places.
class WorkerPool {
 public:
  struct Finished {
    std::uint32_t place;
    std::exception_ptr thrown;  ///< null: the operation returned
  };

  /// on_finished: called by a worker when `collect` has something to return. Starts `threads` threads.
  WorkerPool(std::uint32_t threads, std::function<void()> on_finished);
  /// Waits for the operations that run; those that have not begun will not run.
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  /// operation: must live until `collect` or `halt` returns its place.
  void submit(std::uint32_t place, const std::function<void()>& operation);
  /// Appends the operations that have finished since the last call.
  void collect(std::vector<Finished>& finished);
  /// Waits for the operations that run. Drops those that have not begun, and appends their places.
  void halt(std::vector<std::uint32_t>& not_begun);

 private:
  struct Job {
    std::uint32_t place;
    const std::function<void()>* operation;
  };
  void work();

  std::function<void()> on_finished_;
  std::mutex mutex_;
  std::condition_variable job_or_end_, idle_;
  std::deque<Job> jobs_;
  std::vector<Finished> finished_;
  std::uint32_t running_ = 0;
  bool ending_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace tessera
