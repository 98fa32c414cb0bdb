#include "tessera/judgement.hpp"

#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>

namespace tessera {

std::string judgement_lines(const std::string& text) {
  const auto json = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object()) return {};
  std::string lines;
  const auto out = std::back_inserter(lines);
  for (const auto& check : json.value("checks", nlohmann::json::array())) {
    fmt::format_to(out, "  check {}: {}", check.value("name", ""), check.value("verdict", ""));
    if (check.contains("time_s")) fmt::format_to(out, " at {:.3f} s", check["time_s"].get<double>());
    if (check.contains("detail")) fmt::format_to(out, "; {}", check["detail"].get<std::string>());
    lines += '\n';
  }
  const nlohmann::json measures = json.value("measures", nlohmann::json::object());
  for (const auto& [name, measure] : measures.items()) {
    if (!measure.is_object()) continue;
    const std::string unit = measure.value("unit", "");
    fmt::format_to(out,
                   "  {}: {:.6g}{space}{unit} (at {:.3f} s) to {:.6g}{space}{unit} (at {:.3f} s), mean "
                   "{:.6g}{space}{unit}\n",
                   name, measure["least"].get<double>(), measure["least_at_s"].get<double>(),
                   measure["greatest"].get<double>(), measure["greatest_at_s"].get<double>(),
                   measure["mean"].get<double>(), fmt::arg("space", unit.empty() ? "" : " "),
                   fmt::arg("unit", unit));
  }
  constexpr std::size_t most_agents = 5;
  for (const auto& used : json.value("used", nlohmann::json::array())) {
    const std::string unit = used.value("unit", "");
    fmt::format_to(out, "  {} used: {:.6g}{}{}", used.value("resource", ""), used.value("amount", 0.0),
                   unit.empty() ? "" : " ", unit);
    const nlohmann::json agents = used.value("agents", nlohmann::json::object());
    std::size_t shown = 0;
    for (const auto& [agent, amount] : agents.items())
      if (agents.size() > 1 && shown < most_agents)
        fmt::format_to(out, "{}{} {:.6g}", shown++ == 0 ? " (" : ", ", agent, amount.get<double>());
    if (shown > 0)
      fmt::format_to(out, "{})",
                     agents.size() > shown ? fmt::format(" and {} more", agents.size() - shown) : "");
    lines += '\n';
  }
  return lines;
}

}  // namespace tessera
