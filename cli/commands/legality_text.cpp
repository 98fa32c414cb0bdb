#include "cli/commands/legality_text.hpp"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

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

}  // namespace

void print_verdict(const replay::Legality& legality, const std::string& net_hash, std::size_t recordings) {
  const std::string in = recordings > 1 ? fmt::format(" in {} recordings", recordings) : "";
  fmt::print("{}: {} firings of the net {}{}{}{}\n", word_of(legality.verdict), legality.firings,
             printable(net_hash), in, legality.why.empty() ? "" : "; then ", printable(legality.why));
}

nlohmann::json json_of(const replay::Legality& legality) {
  return {{"verdict", word_of(legality.verdict)}, {"firings", legality.firings}, {"why", legality.why}};
}

int exit_code_of(replay::Legality::Verdict verdict) {
  using Verdict = replay::Legality::Verdict;
  return verdict == Verdict::legal ? ok : verdict == Verdict::illegal ? failed : unknown;
}

}  // namespace tessera::cli
