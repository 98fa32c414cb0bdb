#include "executor/worker_pool.hpp"

#include <utility>

namespace tessera {

WorkerPool::WorkerPool(std::uint32_t threads, std::function<void()> on_finished)
    : on_finished_(std::move(on_finished)) {
  for (std::uint32_t i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
}

WorkerPool::~WorkerPool() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
    jobs_.clear();
  }
  job_or_end_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void WorkerPool::submit(std::uint32_t place, const std::function<void()>& operation) {
  {
    const std::lock_guard lock(mutex_);
    jobs_.push_back({place, &operation});
  }
  job_or_end_.notify_one();
}

void WorkerPool::collect(std::vector<Finished>& finished) {
  const std::lock_guard lock(mutex_);
  finished.insert(finished.end(), finished_.begin(), finished_.end());
  finished_.clear();
}

void WorkerPool::halt(std::vector<std::uint32_t>& not_begun) {
  std::unique_lock lock(mutex_);
  for (const Job& job : jobs_) not_begun.push_back(job.place);
  jobs_.clear();
  idle_.wait(lock, [this] { return running_ == 0; });
}

void WorkerPool::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    job_or_end_.wait(lock, [this] { return ending_ || !jobs_.empty(); });
    if (ending_) return;
    const Job job = jobs_.front();
    jobs_.pop_front();
    ++running_;
    lock.unlock();
    std::exception_ptr thrown;
    try {
      (*job.operation)();
    } catch (...) {
      thrown = std::current_exception();
    }
    lock.lock();
    finished_.push_back({job.place, std::move(thrown)});
    on_finished_();
    if (--running_ == 0) idle_.notify_all();
  }
}

}  // namespace tessera
