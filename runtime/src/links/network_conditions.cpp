#include "links/network_conditions.hpp"

#include <fmt/core.h>

#include <charconv>
#include <system_error>

#include "tessera/given_values.hpp"
#include "tessera/nearest.hpp"

namespace tessera {
namespace {

[[nodiscard]] std::optional<double> probability(const std::string& text) {
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, problem] = std::from_chars(text.data(), end, number);
  if (problem != std::errc{} || stop != end || !(number >= 0 && number <= 1)) return std::nullopt;
  return number;
}

}  // namespace

std::optional<NetworkConditions> read_network(const std::string& text, std::string& error) {
  NetworkConditions read;
  const std::vector<std::string> known{"delay", "jitter", "loss", "duplicate", "reorder"};
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string part = text.substr(begin, end - begin);
    begin = end + 1;
    const std::size_t equals = part.find('=');
    const std::string name = part.substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : part.substr(equals + 1);
    const auto fail = [&](const std::string& what) {
      error = fmt::format("--network {}: {}", text, what);
      return std::nullopt;
    };
    if (name == "delay" || name == "jitter") {
      const std::optional<Duration> time = parse_duration(value);
      if (!time) return fail(fmt::format("'{}' is no time such as 2ms", value));
      (name == "delay" ? read.delay : read.jitter) = *time;
    } else if (name == "loss" || name == "duplicate" || name == "reorder") {
      const std::optional<double> share = probability(value);
      if (!share) return fail(fmt::format("'{}' is no probability between 0 and 1", value));
      (name == "loss" ? read.loss : name == "duplicate" ? read.duplicate : read.reorder) = *share;
    } else {
      return fail(
          with_hint(fmt::format("unknown '{}'; there are delay, jitter, loss, duplicate, reorder", name),
                    did_you_mean(name, known)));
    }
  }
  return read;
}

}  // namespace tessera
