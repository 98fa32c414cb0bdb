#include "codegen/kept_memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <vector>

#include "codegen/cpp_text.hpp"

namespace tessera::codegen {
namespace {

bool has_enumeration(const spec::Field& cell) { return cell.few && !cell.few->counts; }

/// Members of `Memory`, types of the specification and other enumerations keep their names.
std::string enumeration_of(const spec::Model& model, const spec::Subsystem& subsystem,
                           const spec::Field& cell) {
  std::set<std::string> taken;
  for (const spec::Structure& structure : model.structures) taken.insert(structure.name);
  for (const spec::Field& other : subsystem.memory) taken.insert(other.name);
  for (const spec::Field& other : subsystem.memory) {
    if (!has_enumeration(other)) continue;
    std::string name = spec::enumeration_name(other.name, taken);
    if (&other == &cell) return name;
    taken.insert(std::move(name));
  }
  return {};
}

}  // namespace

std::string kept_type(const spec::Model& model, const spec::Subsystem& subsystem, const spec::Field& cell) {
  if (cell.few->counts)
    return fmt::format("tessera::Counter<{}, {}>", cell.few->names.front(), cell.few->names.back());
  return fmt::format("tessera::Kept<{}>", enumeration_of(model, subsystem, cell));
}

std::string kept_initial(const spec::Model& model, const spec::Subsystem& subsystem,
                         const spec::Field& cell) {
  const spec::FewValues& few = *cell.few;
  if (few.initial == 0) return {};
  if (few.counts) return "{" + few.names[few.initial] + "}";
  const std::string name = enumeration_of(model, subsystem, cell);
  const bool is_member = few.initial >= few.first_member && few.initial - few.first_member < few.member_count;
  return is_member ? fmt::format("{{{}{{{}}}}}", name, few.initial)
                   : fmt::format("{{{}::{}}}", name, few.names[few.initial]);
}

std::string kept_enumerations(const spec::Model& model, const spec::Subsystem& subsystem) {
  std::string out;
  for (const spec::Field& cell : subsystem.memory) {
    if (!has_enumeration(cell)) continue;
    const std::string name = enumeration_of(model, subsystem, cell);
    const spec::FewValues& few = *cell.few;
    std::vector<std::string> literals, values;
    for (std::uint32_t value = 0; value < few.names.size(); ++value) {
      literals.push_back(string_literal(few.names[value]));
      const bool is_member = value >= few.first_member && value - few.first_member < few.member_count;
      if (!is_member)
        values.push_back(few.member_count > 0 && value > few.first_member
                             ? fmt::format("{} = {}", few.names[value], value)
                             : few.names[value]);
    }
    std::string text =
        enumeration(fmt::format("enum class {} : std::uint{}_t", name, literals.size() > 256 ? 16 : 8),
                    {values.begin(), values.end()});
    if (few.member_count > 0)
      text += fmt::format(
          "// The members of {0} are values, too: memory.{1} == tessera::Member{{3}}, memory.{1}.member().\n"
          "friend constexpr tessera::MemberValues tessera_members_of({2}) {{ return {{{3}, {4}}}; }}\n",
          few.fleet, cell.name, name, few.first_member, few.member_count);
    text += fmt::format("friend constexpr std::array<std::string_view, {}> tessera_names_of({}) {{\n",
                        literals.size(), name);
    const std::string list = few.goal ? std::string("  return tessera::goal_state_names;\n")
                                      : fmt::format("  return {{{}}};\n", fmt::join(literals, ", "));
    text += (list.size() <= column_limit - 2
                 ? list
                 : fmt::format("  return {{\n      {},\n  }};\n", fmt::join(literals, ",\n      "))) +
            "}\n";
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = text.find('\n', begin) + 1;
      out += "  " + text.substr(begin, end - begin);
      begin = end;
    }
    out += '\n';
  }
  return out;
}

std::string value_constant(const spec::Model& model, const spec::Subsystem& subsystem,
                           std::string_view value) {
  const bool is_fleet = std::ranges::any_of(subsystem.memory, [&](const spec::Field& cell) {
    return has_enumeration(cell) && cell.few->fleet == value;
  });
  if (is_fleet) return fmt::format("tessera::Members {}{{}};", value);
  std::vector<std::string> meanings;
  for (const spec::Field& cell : subsystem.memory)
    if (has_enumeration(cell) && cell.few->find(value))
      meanings.push_back(fmt::format("Memory::{}", enumeration_of(model, subsystem, cell)));
  if (meanings.size() == 1) return fmt::format("{0} {1} = {0}::{1};", meanings.front(), value);
  for (std::string& meaning : meanings) meaning += fmt::format("::{}", value);
  return fmt::format("tessera::NamedValues<{}> {}{{}};", fmt::join(meanings, ", "), value);
}

}  // namespace tessera::codegen
