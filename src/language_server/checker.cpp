#include "language_server/checker.hpp"

#include <algorithm>
#include <utility>

#include "language_server/workspace.hpp"
#include "project/verification/pipeline.hpp"

namespace tessera::language_server {

Checked check(const std::string& uri, const std::string& text) {
  const std::filesystem::path folder = path_of(uri).parent_path();
  diagnostics::Diagnostics out(uri, text, folder);
  project::Draft draft = project::draft_of(out);
  Checked checked;
  const std::vector<std::string> names = out.sources().included();
  for (std::size_t at = 0; at < names.size(); ++at)
    checked.included.push_back({folder / names[at], out.included_text(at)});
  for (diagnostics::Diagnostic& one : out.sorted()) {
    const diagnostics::SourceLine place = out.sources().at(one.span.line);
    const auto file = std::ranges::find(names, place.file);
    one.span.line = place.line;
    auto& found = file == names.end()
                      ? checked.found
                      : checked.included[static_cast<std::size_t>(file - names.begin())].found;
    found.push_back(std::move(one));
  }
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
