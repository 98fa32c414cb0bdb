#include "codegen/net_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <span>
#include <utility>

#include "codegen/cpp_text.hpp"

namespace tessera::codegen {
namespace {

/// One row of a table, cell by cell; empty cells at the end are left out.
struct Row {
  net::BehaviourId behaviour{};  ///< that it belongs to; none: the subsystem itself
  std::vector<std::string> cells;
  std::string comment{};  ///< behind it
};

std::string list(const std::vector<std::string>& ends) {
  return fmt::format("{{{}}}", fmt::join(ends, ", "));
}

Row row(const LocalNet::Place& place) {
  const std::string tokens = place.tokens == 0 ? "" : std::to_string(place.tokens);
  return {place.behaviour, {string_literal(place.name), place.does, tokens}};
}

Row row(const LocalNet::Fact& fact) { return {{}, {fact.kind, string_literal(fact.name)}}; }

Row row(const LocalNet::Transition& transition) {
  return {transition.behaviour,
          {string_literal(transition.name), list(transition.inputs), list(transition.outputs),
           transition.guard.empty() ? "{}" : transition.guard, transition.role},
          transition.in_words};
}

Row row(const LocalNet::Port& port) {
  return {{},
          {string_literal(port.name), port.sends ? "tessera::Side::send" : "tessera::Side::receive",
           string_literal(port.buffer)}};
}

/// Rows of one group stand together, groups in the order of the specification.
template <class Element>
std::vector<Row> grouped(const std::vector<Element>& elements, const spec::Subsystem& subsystem) {
  std::vector<std::vector<Row>> groups(1 + subsystem.behaviours.size());
  for (const Element& element : elements) {
    Row made = row(element);
    groups[made.behaviour.valid() ? made.behaviour.value + 1 : 0].push_back(std::move(made));
  }
  std::vector<Row> rows;
  for (std::vector<Row>& group : groups) std::ranges::move(group, std::back_inserter(rows));
  return rows;
}

using Widths = std::array<std::size_t, 5>;
using Rows = std::span<const Row>;

/// The column widths of one group of rows, so that one long name does not widen all rows.
Widths widths_of(Rows rows) {
  Widths widths{};
  for (const Row& each : rows)
    for (std::size_t cell = 0; cell < each.cells.size(); ++cell)
      widths[cell] = std::max(widths[cell], each.cells[cell].size());
  return widths;
}

std::size_t cells_used(const Row& row) {
  std::size_t last = row.cells.size();
  while (row.cells[last - 1].empty()) --last;
  return last;
}

std::string line(const Row& row, const Widths& widths) {
  std::string out = "    {";
  const std::size_t last = cells_used(row) - 1;
  for (std::size_t cell = 0; cell < last; ++cell)
    out += fmt::format("{:<{}} ", row.cells[cell] + ',', widths[cell] + 1);
  const std::string end = row.cells[last] + "},";
  if (row.comment.empty()) return out += end + '\n';
  return out += fmt::format("{:<{}}  // {}\n", end, widths[last] + 2, row.comment);
}

std::string list_of(const Row& row) {
  return fmt::format("{{{}}}", fmt::join(std::span(row.cells).first(cells_used(row)), ", "));
}

/// Rows of a single cell share lines, with the comments of the first and the last.
std::string packed(const std::vector<Row>& rows) {
  std::string out, current, first, last;
  const auto end_line = [&] {
    if (current.empty()) return;
    out += "   " + current;
    if (!first.empty()) out += "  // " + (first == last ? first : first + " to " + last);
    out += '\n';
    current.clear();
  };
  for (const Row& each : rows) {
    const std::string cell = fmt::format(" {{{}}},", each.cells.front());
    if (3 + current.size() + cell.size() > column_limit) end_line();
    if (current.empty()) first = each.comment;
    last = each.comment;
    current += cell;
  }
  end_line();
  return out;
}

/// In the order of the rows, since others name them by number.
std::string group_lines(Rows rows) {
  std::vector<Row> full;
  std::ranges::copy_if(rows, std::back_inserter(full), [](const Row& each) { return cells_used(each) > 1; });
  const Widths widths = widths_of(full);
  std::string out;
  std::vector<Row> bare;
  for (const Row& each : rows) {
    if (cells_used(each) == 1) {
      bare.push_back(each);
      continue;
    }
    out += packed(std::exchange(bare, {})) + line(each, widths);
  }
  return out + packed(bare);
}

std::string table(const spec::Subsystem& subsystem, std::string_view head, Rows rows) {
  if (rows.empty()) return {};
  std::string out = fmt::format("{}[] = {{\n", head);
  for (std::size_t begin = 0; begin < rows.size();) {
    const net::BehaviourId id = rows[begin].behaviour;
    std::size_t end = begin;
    while (end < rows.size() && rows[end].behaviour == id) ++end;
    if (id.valid()) {
      out += fmt::format("    // {}\n", subsystem.behaviours[id].name);
    }
    out += group_lines(rows.subspan(begin, end - begin));
    begin = end;
  }
  return out += "};\n";
}

std::string table_name(std::string_view of, spec::BehaviourId behaviour) {
  return fmt::format("{}_{}", of, behaviour.value);
}

std::string times_table(const spec::Behaviour& behaviour, spec::BehaviourId id) {
  std::string out =
      fmt::format("// The distribution of the times of '{}'.\nconstexpr tessera::TimePoint {}[] = {{\n",
                  behaviour.name, table_name("times", id));
  std::vector<Row> points;
  for (const spec::TimePoint& point : behaviour.takes.points)
    points.push_back({{}, {fmt::format("{}ns, {}U", point.time.count(), point.below)}});
  return out + packed(points) + "};\n";
}

std::string uses_table(const Project& project, const spec::Behaviour& behaviour, spec::BehaviourId id) {
  const std::vector<spec::Resource> resources = spec::resources_of(project.model);
  std::string rows;
  for (const spec::ResourceUse& use : behaviour.uses) {
    const auto number = std::ranges::find(resources, use.resource, &spec::Resource::name) - resources.begin();
    rows += fmt::format("{}{{{}, {}}}", rows.empty() ? "" : ", ", number, use.per_second);
  }
  return fmt::format("constexpr tessera::Use {}[] = {{{}}};\n", table_name("uses", id), rows);
}

std::string behaviours_table(const Project& project, const spec::Subsystem& subsystem) {
  std::vector<Row> rows;
  std::string before;
  for (const spec::BehaviourId id : subsystem.behaviours.ids()) {
    const spec::Behaviour& behaviour = subsystem.behaviours[id];
    const spec::Duration shortest = behaviour.takes.shortest, longest = behaviour.takes.longest;
    const bool draws = longest > shortest && !behaviour.takes.points.empty();
    const bool uses = !behaviour.uses.empty();
    std::string takes, times, used;
    if (longest.count() > 0) takes = duration(shortest);
    if (longest > shortest) takes += ", " + duration(longest);
    if (takes.empty() && uses) takes = "0ns";
    if (longest <= shortest && uses) takes += ", 0ns";
    if (draws) times = table_name("times", id);
    if (uses && !draws) times = "{}";
    if (uses) used = table_name("uses", id);
    if (draws) before += times_table(behaviour, id);
    if (uses) before += uses_table(project, behaviour, id);
    rows.push_back({{}, {string_literal(behaviour.name), takes, times, used}});
  }
  const std::string head = "constexpr tessera::Behaviour behaviours[] = {";
  std::string short_form;
  for (const Row& each : rows) short_form += (short_form.empty() ? "" : ", ") + list_of(each);
  if (head.size() + short_form.size() + 2 <= column_limit) return before + head + short_form + "};\n";
  return before + head + '\n' + group_lines(rows) + "};\n";
}

/// Which agents execute a variant: the first by name, the rest by number.
std::string executed_by(const Project& project, const Unit& unit, const NetVariants& variants,
                        std::size_t variant) {
  std::size_t count = 0;
  std::string first;
  for (std::size_t at = 0; at < unit.instances.size(); ++at)
    if (variants.of_instance[at] == variant && count++ == 0)
      first = project.model.instance_path(unit.instances[at]);
  return count == 1 ? first : fmt::format("{} and {} more", first, count - 1);
}

}  // namespace

std::string variant_suffix(std::size_t variant) {
  return variant == 0 ? "" : fmt::format("_{}", variant + 1);
}

std::string net_tables(const Project& project, const Unit& unit, const NetVariants& variants) {
  std::string out = "// clang-format off\n" + behaviours_table(project, *unit.subsystem);
  for (std::size_t variant = 0; variant < variants.nets.size(); ++variant) {
    const LocalNet& net = variants.nets[variant];
    const std::string suffix = variant_suffix(variant);
    if (variants.nets.size() > 1)
      out += fmt::format("\n// The net of {}.\n", executed_by(project, unit, variants, variant));
    std::vector<Row> ports;
    for (const LocalNet::Port& port : net.ports) ports.push_back(row(port));
    out += table(*unit.subsystem, "constexpr tessera::Port ports" + suffix, ports);
    std::vector<Row> facts;
    for (const LocalNet::Fact& fact : net.facts) facts.push_back(row(fact));
    out += table(*unit.subsystem, "constexpr tessera::Fact facts" + suffix, facts);
    std::vector<Row> places = grouped(net.places, *unit.subsystem);
    for (std::size_t place = 0; place < places.size(); ++place) places[place].comment = std::to_string(place);
    out += table(*unit.subsystem, "constexpr tessera::Place places" + suffix, places);
    // Not constexpr: GCC 12 rejects constant initializer_lists in aggregates.
    out += table(*unit.subsystem, "const tessera::Transition transitions" + suffix,
                 grouped(net.transitions, *unit.subsystem));
  }
  return out += "// clang-format on\n";
}

std::string net_definitions(const NetVariants& variants) {
  std::string out;
  for (std::size_t variant = 0; variant < variants.nets.size(); ++variant) {
    const std::string suffix = variant_suffix(variant);
    const std::string ports = variants.nets[variant].ports.empty() ? "{}" : "ports" + suffix;
    out += fmt::format(
        "const tessera::SubsystemNet net{0}{{behaviours, {1}, places{0}, transitions{0}, {2}, {3}{4}}};\n",
        suffix, ports, variants.nets[variant].in, variants.nets[variant].out,
        variants.nets[variant].facts.empty() ? "" : ", facts" + suffix);
  }
  return out;
}

}  // namespace tessera::codegen
