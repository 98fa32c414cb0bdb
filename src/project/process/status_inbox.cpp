#include "project/process/status_inbox.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <variant>

namespace tessera::project {

namespace {

/// A process that was started again and again was heard as several sources. More of them are of no use.
constexpr int most_starts = 8;
/// The number of texts that are kept if the client hangs and does not take them: the newest ones.
constexpr std::size_t most_kept = 4096;

/// The limit of nesting, so that no function needs a deep stack for a text.
constexpr int deepest = 16;

/// Brackets in brackets, those in strings left out.
bool is_deep(std::string_view text) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t at = 0; at < text.size() && depth <= deepest; ++at) {
    const char letter = text[at];
    if (quoted && letter == '\\') ++at;
    if (letter == '"') quoted = !quoted;
    if (quoted) continue;
    depth +=
        static_cast<int>(letter == '[' || letter == '{') - static_cast<int>(letter == ']' || letter == '}');
  }
  return depth > deepest;
}

/// Letters of other alphabets, and control characters of terminals, are escaped.
std::string of_plain_letters(std::string_view text) {
  return nlohmann::json::parse(text).dump(-1, ' ', /*ensure_ascii=*/true,
                                          nlohmann::json::error_handler_t::replace);
}

}  // namespace

StatusInbox::StatusInbox(std::string system, const Snapshot::Deployment& deployment)
    : system_(std::move(system)) {
  for (const Snapshot::Deployment::Process& one : deployment.processes) processes_.insert(one.name);
}

std::optional<HeardStatus> StatusInbox::read(const network::StatusSource& source, network::StatusPart part,
                                             std::string_view text) const {
  std::optional<ControlLine> line;
  if (text.size() <= network::longest_status_bytes && !is_deep(text)) line = read_control_line(text);
  if (!line) return std::nullopt;
  if (std::holds_alternative<ControllerHasEnded>(*line)) {
    const auto known = names_.find(source);
    if (known == names_.end()) return std::nullopt;
    return HeardStatus{HeardStatus::What::ended, known->second, std::to_string(source.incarnation), {}, {}};
  }
  auto* snapshot = std::get_if<Snapshot>(&*line);
  const bool is_whole = part == network::StatusPart::whole;
  if (snapshot == nullptr || snapshot->system != system_ || !snapshot->process ||
      !processes_.contains(*snapshot->process) ||
      snapshot->incarnation != std::to_string(source.incarnation) || snapshot->brief == is_whole)
    return std::nullopt;
  snapshot->deployment.reset();  // a text from the network never leads to another network
  snapshot->recording.reset();
  std::string name = *snapshot->process, incarnation = snapshot->incarnation;
  return HeardStatus{HeardStatus::What::told, std::move(name), std::move(incarnation), std::move(*snapshot),
                     is_whole ? of_plain_letters(text) : std::string()};
}

bool StatusInbox::admit(const network::StatusSource& source, const std::string& process) {
  if (const auto known = names_.find(source); known != names_.end()) return known->second == process;
  auto oldest = names_.end();
  int starts = 0;
  for (auto one = names_.begin(); one != names_.end(); ++one) {
    if (one->second != process) continue;
    ++starts;
    if (oldest == names_.end() || one->first.incarnation < oldest->first.incarnation) oldest = one;
  }
  if (starts >= most_starts) {
    if (source.incarnation < oldest->first.incarnation) return false;
    names_.erase(oldest);
  }
  names_.emplace(source, process);
  return true;
}

void StatusInbox::heard(const network::StatusSource& source, network::StatusPart part,
                        std::string_view text) {
  const std::lock_guard lock(mutex_);
  std::optional<HeardStatus> heard = read(source, part, text);
  if (!heard || !admit(source, heard->process))
    ++dropped_;
  else
    keep(std::move(*heard));
}

void StatusInbox::left(const network::StatusSource& source) {
  const std::lock_guard lock(mutex_);
  const auto known = names_.find(source);
  if (known == names_.end()) return;
  keep({HeardStatus::What::vanished, known->second, std::to_string(source.incarnation), {}, {}});
  names_.erase(known);
}

void StatusInbox::keep(HeardStatus heard) {
  const auto older = std::ranges::find_if(kept_, [&](const HeardStatus& one) {
    return one.process == heard.process && one.incarnation == heard.incarnation && one.what == heard.what &&
           one.snapshot.brief == heard.snapshot.brief;
  });
  if (older != kept_.end()) kept_.erase(older);
  if (kept_.size() < most_kept) kept_.push_back(std::move(heard));
}

void StatusInbox::complaint(std::string_view text) {
  const std::lock_guard lock(mutex_);
  complaint_ = text.substr(0, 300);
}

std::vector<HeardStatus> StatusInbox::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(kept_, {});
}

std::string StatusInbox::remark() const {
  const std::lock_guard lock(mutex_);
  if (dropped_ == 0) return complaint_;
  return fmt::format("{}{}{} messages that no process of {} sends were dropped", complaint_,
                     complaint_.empty() ? "" : "; ", dropped_, system_);
}

}  // namespace tessera::project
