#include "cli/watching/offers.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "cli/terminal.hpp"
#include "tessera/control_messages.hpp"
#include "tessera/nearest.hpp"
#include "tessera/result.hpp"

namespace tessera::cli {

namespace {

/// nullopt: the mistake has been printed.
std::optional<Offered> offered_by(RunningController& controller) {
  std::optional<CommandAnswer> answer;
  if (controller.tell(command::Offers{})) answer = controller.answer();
  if (answer && answer->offered) return std::move(answer->offered);
  complain(controller.name() + (answer ? " does not say what it has: another version of Tessera made it"
                                       : " has ended, or does not answer: what it has is unknown"));
  return std::nullopt;
}

/// The offers of all processes together. code: `failed` if one does not answer.
Offered offered_by_all(std::vector<SeenController>& processes, int& code) {
  Offered all;
  for (SeenController& one : processes) {
    std::optional<Offered> offered = offered_by(one.controller);
    if (!offered) code = failed;
    if (!offered) continue;
    std::ranges::move(offered->parameters, std::back_inserter(all.parameters));
    std::ranges::move(offered->panels, std::back_inserter(all.panels));
  }
  return all;
}

std::string range_text(const std::optional<double>& minimum, const std::optional<double>& maximum) {
  if (minimum && maximum) return fmt::format("{} .. {}", *minimum, *maximum);
  if (minimum) return fmt::format("at least {}", *minimum);
  return maximum ? fmt::format("at most {}", *maximum) : "";
}

std::string value_text(const std::string& value, const std::string& unit) {
  return unit.empty() ? value : value + ' ' + unit;
}

using Row = std::array<std::string, 3>;

/// In columns.
void print_rows(const std::vector<Row>& rows, const char* indent) {
  std::array<std::size_t, 2> widths{};
  for (const Row& row : rows)
    for (std::size_t at = 0; at < widths.size(); ++at) widths[at] = std::max(widths[at], row[at].size());
  for (const Row& row : rows) {
    std::string line =
        fmt::format("{}{:<{}}  {:<{}}  {}", indent, row[0], widths[0], row[1], widths[1], row[2]);
    line.erase(line.find_last_not_of(' ') + 1);
    fmt::print("{}\n", line);
  }
}

Row row_of(const Offered::Value& one, const std::string& name) {
  return {name, value_text(one.value, one.unit), range_text(one.minimum, one.maximum)};
}

bool are_alike(const Offered::Value& one, const Offered::Value& other) {
  const auto facts = [](const Offered::Value& of) {
    return std::tie(of.value, of.unit, of.minimum, of.maximum);
  };
  return facts(one) == facts(other);
}

/// A name that means the same in several subsystems is one row: `tessera set` sets it in all of them.
std::vector<Row> rows_of(const std::vector<Offered::Value>& parameters) {
  std::map<std::string, std::vector<const Offered::Value*>> by_name;
  for (const Offered::Value& one : parameters)
    by_name[one.path.substr(one.path.rfind('.') + 1)].push_back(&one);
  std::vector<Row> rows;
  for (const auto& [name, all] : by_name) {
    const Offered::Value& first = *all.front();
    const bool alike =
        std::ranges::all_of(all, [&](const Offered::Value* one) { return are_alike(*one, first); });
    if (all.size() > 1 && alike)
      rows.push_back(row_of(first, name));
    else
      for (const Offered::Value* one : all) rows.push_back(row_of(*one, one->path));
  }
  return rows;
}

}  // namespace

int list_parameters(std::vector<SeenController>& processes) {
  int code = ok;
  const Offered all = offered_by_all(processes, code);
  if (all.parameters.empty() && code == ok) fmt::print("there are no parameters\n");
  print_rows(rows_of(all.parameters), "");
  return code;
}

int list_panels(std::vector<SeenController>& processes, const std::string& path) {
  int code = ok;
  const Offered all = offered_by_all(processes, code);
  std::vector<std::string> paths;
  for (const Offered::Panel& panel : all.panels) {
    paths.push_back(panel.path);
    if (!path.empty() && panel.path != path) continue;
    fmt::print("{}  {}; an input counts for {:.3g} s\n", panel.path,
               panel.operated ? "an operator has it" : "neutral", panel.stale_s);
    std::vector<Row> rows;
    for (const Offered::Value& one : panel.controls)
      rows.push_back({one.path, value_text(one.value, one.unit), range_text(one.minimum, one.maximum)});
    print_rows(rows, "  ");
  }
  if (code == ok && paths.empty() && path.empty()) fmt::print("there are no panels\n");
  if (code == ok && !path.empty() && std::ranges::count(paths, path) == 0)
    code = complain(with_hint("there is no panel '" + path + "'", did_you_mean(path, paths)));
  return code;
}

}  // namespace tessera::cli
