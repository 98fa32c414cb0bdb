#include "cli/recordings/legality_text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "cli/terminal.hpp"
#include "tessera/printable.hpp"

namespace tessera::cli {
namespace {

const char* word_of(replay::Legality::Verdict verdict) {
  switch (verdict) {
    case replay::Legality::Verdict::legal:
      return "legal";
    case replay::Legality::Verdict::illegal:
      return "illegal";
    case replay::Legality::Verdict::incomplete:
      return "incomplete";
  }
  return "";
}

/// "cart[0]: stopped: ..."; nullopt: it has ended in order, or its end is missing.
std::optional<std::string> failure_of(const Recording& recording) {
  const auto stop = std::ranges::find_if(recording.entries, [](const Recording::Entry& entry) {
    return entry.event.kind() == Event::Kind::stop && entry.event.version != 0;
  });
  if (stop == recording.entries.end()) return std::nullopt;
  return (recording.process ? recording.process->name + ": " : "") + stop->text;
}

}  // namespace

void print_verdict(const replay::Legality& legality, std::span<const Recording> recordings) {
  const std::string in = recordings.size() > 1 ? fmt::format(" in {} recordings", recordings.size()) : "";
  fmt::print("{}: {} firings of the net {}{}{}{}\n", word_of(legality.verdict), legality.firings,
             printable(recordings.front().net_hash), in, legality.why.empty() ? "" : "; then ",
             printable(legality.why));
  for (const Recording& recording : recordings)
    if (const std::optional<std::string> failure = failure_of(recording))
      fmt::print("the run has failed: {}\n", printable(*failure));
}

nlohmann::json json_of(const replay::Legality& legality, std::span<const Recording> recordings) {
  nlohmann::json failures = nlohmann::json::array();
  for (const Recording& recording : recordings)
    if (std::optional<std::string> failure = failure_of(recording)) failures.push_back(*std::move(failure));
  nlohmann::json result{
      {"verdict", word_of(legality.verdict)}, {"firings", legality.firings}, {"why", legality.why}};
  if (!failures.empty()) result["failures"] = std::move(failures);
  return result;
}

int exit_code_of(replay::Legality::Verdict verdict) {
  using Verdict = replay::Legality::Verdict;
  return verdict == Verdict::legal ? ok : verdict == Verdict::illegal ? failed : unknown;
}

}  // namespace tessera::cli
