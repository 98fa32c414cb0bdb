#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <deque>

#include "codegen/cpp_text.hpp"
#include "codegen/driver_tables.hpp"
#include "codegen/emit.hpp"
#include "codegen/kept_memory.hpp"

namespace tessera::codegen {
namespace {

using spec::SubsystemKind;

/// Writes the header of one unit.
class Header {
 public:
  Header(const Project& project, const Unit& unit)
      : project_(project),
        unit_(unit),
        subsystem_(*unit.subsystem),
        parameters_(parameters_of(project.model, unit)) {
    for (const spec::Behaviour& behaviour : subsystem_.behaviours)
      hidden_.insert(functions_.emplace_back(function_name(behaviour)));
    using Fields = const std::vector<spec::Field>*;
    for (const Fields fields : std::initializer_list<Fields>{&subsystem_.inputs, &subsystem_.outputs,
                                                             &subsystem_.memory, &subsystem_.real})
      for (const spec::Field& field : *fields) {
        hidden_.insert(written_name(field));
        if (field.member) headers_.insert("<array>");
        if (!field.few) add_headers(field.type, headers_);
      }
    for (const spec::Parameter* parameter : parameters_) add_headers(parameter->type, headers_);
    for (const spec::Field& field : subsystem_.memory)
      if (field.few) headers_.insert({"<array>", "<cstdint>", "<string_view>", "<tessera/kept.hpp>"});
  }

  std::string data() {
    return fmt::format(R"({}#pragma once

{}#include "../types.hpp"

/// The data of {}.
namespace {} {{

{}}}  // namespace {}
)",
                       project_.banner(), include_block(headers_), unit_path(unit_), space(), structures(),
                       space());
  }

  std::string text() {
    return fmt::format(R"({}#pragma once

#include <tessera/context.hpp>

#include "{}.data.hpp"  // Inputs, Outputs, Memory, Parameters

/// {}
namespace {} {{

struct Context : tessera::Context {{
  explicit Context(const Parameters& values) : parameters(values) {{}}
  const Parameters& parameters;
}};

// The transition functions, eq. (1) of the paper. They are yours: {}.
{}
}}  // namespace {}
)",
                       project_.banner(), subsystem_.name, title(), space(), user_file(project_.units, unit_),
                       functions(), space());
  }

 private:
  [[nodiscard]] std::string space() const { return unit_namespace(project_.model, unit_); }

  [[nodiscard]] std::string title() const {
    constexpr std::array kinds{"Control subsystem", "Virtual receptor", "Virtual effector"};
    const std::string every = subsystem_.period ? ", every " + duration(*subsystem_.period) : "";
    return fmt::format("{} {}{}", kinds[static_cast<std::size_t>(subsystem_.kind)], unit_path(unit_), every);
  }

  /// Empty ones stand together.
  [[nodiscard]] std::string structures() const {
    std::string out;
    for (const std::string& each : {inputs(), outputs(), memory(), parameters()}) {
      const bool empty = std::ranges::count(each, '\n') == 1;
      if (empty && out.ends_with("{};\n\n")) out.pop_back();
      out += each + '\n';
    }
    if (has_whole_driver(project_, unit_)) out += real() + '\n';
    return out;
  }

  void add_buffers(const std::vector<spec::Field>& fields, std::string_view template_name,
                   std::vector<Declaration>& members) const {
    for (const spec::Field& field : fields) {
      if (!is_first(field)) continue;
      const std::string buffer =
          fmt::format("tessera::{}<{}>", is_skippable(field) ? "SkippableOutput" : template_name,
                      type_name(project_.model, field.type, hidden_));
      members.push_back({field.member ? fmt::format("std::array<{}, {}> {};", buffer, field.member->count,
                                                    field.member->family)
                                      : fmt::format("{} {};", buffer, field.name),
                         comment_text(field.type.unit)});
    }
  }

  /// An output, or one of its family, that the transition function of some behaviour may skip.
  [[nodiscard]] bool is_skippable(const spec::Field& field) const {
    return std::ranges::any_of(subsystem_.behaviours, [&](const spec::Behaviour& behaviour) {
      return std::ranges::any_of(behaviour.skippable, [&](const spec::Skippable& one) {
        const spec::Field& output = subsystem_.outputs[one.output];
        if (!one.by_function || written_name(output) != written_name(field)) return false;
        return &output == &field || (output.member && field.member && is_output(field));
      });
    });
  }

  [[nodiscard]] bool is_output(const spec::Field& field) const {
    return std::ranges::any_of(subsystem_.outputs, [&](const spec::Field& one) { return &one == &field; });
  }

  [[nodiscard]] std::string inputs() const {
    std::vector<Declaration> members;
    if (subsystem_.kind == SubsystemKind::receptor) add_buffers(subsystem_.real, "Input", members);
    add_buffers(subsystem_.inputs, "Input", members);
    return structure("Inputs", members);
  }

  [[nodiscard]] std::string outputs() const {
    std::vector<Declaration> members;
    if (subsystem_.kind == SubsystemKind::effector) add_buffers(subsystem_.real, "Output", members);
    add_buffers(subsystem_.outputs, "Output", members);
    return structure("Outputs", members);
  }

  [[nodiscard]] std::string memory() const {
    std::vector<Declaration> members;
    for (const spec::Field& field : subsystem_.memory)
      if (!field.few)
        members.push_back({fmt::format("{} {}{{{}}};", type_name(project_.model, field.type, hidden_),
                                       field.name, field.initial),
                           comment_text(field.type.unit)});
      else
        members.push_back({fmt::format("{} {}{};", kept_type(project_.model, subsystem_, field), field.name,
                                       kept_initial(project_.model, subsystem_, field)),
                           "the net changes it"});
    const std::string text = structure("Memory", members),
                      kept = kept_enumerations(project_.model, subsystem_);
    return kept.empty() ? text : "struct Memory {\n" + kept + text.substr(text.find('\n') + 1);
  }

  [[nodiscard]] std::string parameters() const {
    std::vector<Declaration> members;
    for (const spec::Parameter* parameter : parameters_)
      members.push_back({fmt::format("{} {}{{{}}};", type_name(project_.model, parameter->type),
                                     parameter->name, parameter->initial),
                         comment_text(parameter->type.unit)});
    return structure("Parameters", members);
  }

  [[nodiscard]] std::string real() const {
    std::vector<Declaration> members;
    for (const spec::Field& field : subsystem_.real)
      members.push_back(
          {fmt::format("{} {}{{}};", type_name(project_.model, field.type, hidden_), field.name),
           comment_text(field.type.unit)});
    return "/// All real buffers, for the driver that serves them all.\n" + structure("Real", members);
  }

  [[nodiscard]] std::string functions() const {
    std::string out;
    for (const spec::Behaviour& behaviour : subsystem_.behaviours)
      if (is_first(behaviour) && !behaviour.is_group())
        out += fmt::format(
            "void {}(Context& context, const Inputs& in, Memory& memory, Outputs& out);{}\n",
            function_name(behaviour),
            behaviour.member ? fmt::format("  // of each {}: context.member", behaviour.member->fleet) : "");
    return out;
  }

  const Project& project_;
  const Unit& unit_;
  const spec::Subsystem& subsystem_;
  std::vector<const spec::Parameter*> parameters_;
  std::set<std::string> headers_{"<tessera/buffer.hpp>"};
  std::deque<std::string> functions_;
  std::set<std::string_view> hidden_{"Inputs", "Outputs", "Memory", "Parameters", "Context", "Real"};
};

}  // namespace

std::vector<File> subsystem_headers(const Project& project, const Unit& unit) {
  Header header(project, unit);
  return {{data_header(unit), header.data()}, {unit_header(unit), header.text()}};
}

}  // namespace tessera::codegen
