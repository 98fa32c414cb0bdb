#include "subsystem/memory_gauge.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <utility>

namespace tessera {
namespace {

constexpr std::size_t word_size = sizeof(std::uint64_t);

[[nodiscard]] std::size_t longest_memory(const Bindings& bindings) {
  std::size_t bytes = 0;
  for (const Bindings::Remembered& field : bindings.memory)
    if (field.encoding != nullptr && bytes + field.encoding->most <= MemoryGauge::most_bytes)
      bytes += field.encoding->most;
  return bytes;
}

}  // namespace

MemoryGauge::MemoryGauge(const Bindings& bindings)
    : now_(longest_memory(bindings)), shown_(longest_memory(bindings)) {
  std::size_t bytes = 0;
  for (const Bindings::Remembered& field : bindings.memory) {
    if (field.encoding == nullptr || bytes + field.encoding->most > most_bytes) continue;
    bytes += field.encoding->most;
    std::optional<ValueLayout> layout = ValueLayout::parse(field.encoding->type());
    if (layout)
      sources_.push_back({std::string(field.name), field.value, field.encoding, *std::move(layout)});
  }
  ends_.resize(sources_.size());
  words_ = std::vector<std::atomic<std::uint64_t>>(sources_.size() + (bytes + word_size - 1) / word_size);
  show();
}

/// A reader that sees one of the new words also sees a new version: each word is released after the odd
/// version.
void MemoryGauge::show() {
  now_.clear();
  for (std::size_t field = 0; field < sources_.size(); ++field) {
    sources_[field].encoding->put(sources_[field].value, now_);
    ends_[field] = now_.size();
  }
  const std::uint64_t version = version_.load(std::memory_order_relaxed);
  if (version != 0 && now_ == shown_) return;
  version_.store(version + 1, std::memory_order_relaxed);
  std::size_t word = 0;
  for (const std::uint64_t end : ends_) words_[word++].store(end, std::memory_order_release);
  const std::span<const std::byte> bytes = now_.bytes();
  for (std::size_t from = 0; from < bytes.size(); from += word_size) {
    std::uint64_t content = 0;
    std::memcpy(&content, bytes.data() + from, std::min(word_size, bytes.size() - from));
    words_[word++].store(content, std::memory_order_release);
  }
  version_.store(version + 2, std::memory_order_release);
  std::swap(now_, shown_);
}

/// false: the words are of several moments.
bool MemoryGauge::copy(std::vector<std::uint64_t>& words) const {
  const std::uint64_t before = version_.load(std::memory_order_acquire);
  for (std::size_t word = 0; word < words_.size(); ++word)
    words[word] = words_[word].load(std::memory_order_acquire);
  return before % 2 == 0 && version_.load(std::memory_order_relaxed) == before;
}

std::vector<Snapshot::MemoryField> MemoryGauge::read() const {
  constexpr int attempts = 100;
  std::vector<std::uint64_t> words(words_.size());
  int attempt = 0;
  while (!copy(words))
    if (++attempt == attempts) return {};
  std::string bytes((words.size() - sources_.size()) * word_size, '\0');
  if (!bytes.empty()) std::memcpy(bytes.data(), words.data() + sources_.size(), bytes.size());
  std::vector<Snapshot::MemoryField> fields;
  std::size_t begin = 0;
  for (std::size_t field = 0; field < sources_.size(); ++field) {
    const std::string_view value = std::string_view(bytes).substr(begin, words[field] - begin);
    fields.push_back({sources_[field].name, sources_[field].layout.shown(value)});
    begin = words[field];
  }
  return fields;
}

}  // namespace tessera
