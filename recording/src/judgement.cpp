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
  return lines;
}

}  // namespace tessera
