#include "language_server/checker.hpp"

#include <algorithm>
#include <utility>

#include "project/verification/pipeline.hpp"

namespace tessera::language_server {

Checked check(const std::string& name, const std::string& text) {
  diagnostics::Diagnostics out(name, text);
  project::Draft draft = project::draft_of(out);
  Checked checked{out.sorted(), nullptr};
  if (draft.nets.pages && !out.has_errors())
    checked.pages = std::make_shared<const net::HierarchicalNet>(*std::move(draft.nets.pages));
  return checked;
}

Checker::Checker(std::chrono::milliseconds delay, Told told)
    : delay_(delay), told_(std::move(told)), thread_([this] { work(); }) {}

Checker::~Checker() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Checker::changed(Text text) {
  {
    const std::lock_guard lock(mutex_);
    std::string uri = text.uri;
    waiting_[std::move(uri)] = {std::move(text), Clock::now() + delay_};
  }
  changed_.notify_all();
}

void Checker::forget(const std::string& uri) {
  const std::lock_guard lock(mutex_);
  waiting_.erase(uri);
  if (checked_now_ == uri) forgotten_ = true;
}

void Checker::work() {
  std::unique_lock lock(mutex_);
  while (!ends_) {
    const auto next = std::min_element(waiting_.begin(), waiting_.end(), [](const auto& a, const auto& b) {
      return a.second.due < b.second.due;
    });
    if (next == waiting_.end()) {
      changed_.wait(lock);
      continue;
    }
    if (next->second.due > Clock::now()) {
      const Clock::time_point due = next->second.due;  // the text may be forgotten meanwhile
      changed_.wait_until(lock, due);
      continue;
    }
    const Text text = std::move(next->second.text);
    waiting_.erase(next);
    checked_now_ = text.uri;
    forgotten_ = false;
    lock.unlock();
    const Checked found = check(text.uri, text.text);
    lock.lock();
    // A newer text follows, or the text was closed.
    if (!forgotten_ && !waiting_.contains(text.uri) && !ends_) told_(text, found);
    checked_now_.clear();
  }
}

}  // namespace tessera::language_server
