#include "project/build/cpp_mistakes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "project/build/source_scan.hpp"
#include "project/build/standard_headers.hpp"
#include "project/files/files.hpp"
#include "tessera/nearest.hpp"

namespace tessera::project {

namespace {

bool has(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }

bool has_one(std::string_view text, std::initializer_list<std::string_view> parts) {
  return std::ranges::any_of(parts, [&](std::string_view part) { return has(text, part); });
}

/// The texts in quotes.
std::vector<std::string> quoted_parts(std::string_view text) {
  std::vector<std::string> parts;
  for (std::size_t at = text.find('\''); at != std::string_view::npos;) {
    const std::size_t end = text.find('\'', at + 1);
    if (end == std::string_view::npos) break;
    parts.emplace_back(text.substr(at + 1, end - at - 1));
    at = text.find('\'', end + 1);
  }
  return parts;
}

void erase_all(std::string& text, std::string_view part) {
  for (std::size_t at = text.find(part); !part.empty() && at != std::string::npos; at = text.find(part))
    text.erase(at, part.size());
}

std::string guess(std::string_view word, const std::vector<std::string>& names) {
  const std::string near = did_you_mean(word, names).text;
  if (!near.empty() || names.empty()) return near;
  std::string all;
  for (std::size_t i = 0; i < names.size() && i < 10; ++i) all += (i == 0 ? "" : ", ") + names[i];
  return "there " + std::string(names.size() == 1 ? "is: " : "are: ") + all +
         (names.size() > 10 ? " ..." : "");
}

template <class Named>
void add_names(std::vector<std::string>& names, const std::vector<Named>& all) {
  for (const Named& one : all) names.push_back(one.name);
}

constexpr std::string_view signature = "(Context& context, const Inputs& in, Memory& memory, Outputs& out)";

/// Reads one error.
class Meaning {
 public:
  Meaning(const CompilerError& error, const spec::Model& model, const TransitionFunctions& functions)
      : error_(error), model_(model), functions_(functions), text_(error.text), parts_(quoted_parts(text_)) {}

  CppMistake find() const {
    using Rule = std::optional<CppMistake> (Meaning::*)() const;
    constexpr std::array<Rule, 13> rules{
        &Meaning::text_to_print, &Meaning::not_in_std,   &Meaning::no_member,         &Meaning::missing_file,
        &Meaning::literal,       &Meaning::unknown_name, &Meaning::other_declaration, &Meaning::braces,
        &Meaning::read_only,     &Meaning::operators,    &Meaning::conversion,        &Meaning::driver,
        &Meaning::punctuation};
    for (const Rule rule : rules)
      if (std::optional<CppMistake> found = (this->*rule)()) return *std::move(found);
    return {"E500", simple(text_), ""};
  }

 private:
  /// Without the namespaces of the project and what the library writes around types.
  [[nodiscard]] std::string simple(std::string text) const {
    for (const codegen::Stub& stub : functions_.wanted()) erase_all(text, stub.space + "::");
    erase_all(text, model_.system + "::");
    erase_all(text, "{anonymous}::");
    erase_all(text, "(anonymous namespace)::");
    for (const std::string_view word : {"const struct ", "struct "})
      for (std::size_t at = text.find("'" + std::string(word)); at != std::string::npos;
           at = text.find("'" + std::string(word)))
        text.erase(at + 1, word.size());
    return text;
  }

  [[nodiscard]] std::string part(std::size_t index) const {
    return index < parts_.size() ? parts_[index] : "";
  }

  /// The structure of the specification in the name of a type; nullptr: none.
  [[nodiscard]] const spec::Structure* structure_in(std::string_view type) const {
    for (const spec::Structure& one : model_.structures) {
      const std::size_t at = type.find(one.name);
      if (at == std::string_view::npos) continue;
      const auto is_part = [&](std::size_t index) {
        return index < type.size() &&
               (std::isalnum(static_cast<unsigned char>(type[index])) != 0 || type[index] == '_');
      };
      if ((at == 0 || !is_part(at - 1)) && !is_part(at + one.name.size())) return &one;
    }
    return nullptr;
  }

  /// The subsystem of "rover::robot::control::Inputs".
  [[nodiscard]] const spec::Subsystem* subsystem_in(std::string_view type, std::string& path) const {
    for (const spec::Definition& definition : model_.definitions)
      for (const spec::Subsystem& subsystem : definition.subsystems)
        if (has(type, model_.system + "::" + definition.name + "::" + subsystem.name + "::")) {
          path = definition.name + "." + subsystem.name;
          return &subsystem;
        }
    return nullptr;
  }

  // ------------------------------------------------------------------------------------- the rules

  [[nodiscard]] std::optional<CppMistake> text_to_print() const {
    const bool is_fmt = has(error_.at.file, "/fmt/") || has(text_, "fmt::") || has(text_, "Cannot format");
    if (!is_fmt) return std::nullopt;
    return CppMistake{"E509", "the text and its arguments do not go together",
                      "write one {} for each argument, and only numbers, bools and texts as arguments"};
  }

  [[nodiscard]] std::optional<CppMistake> not_in_std() const {
    if (!has(text_, "is not a member of 'std") && !has(text_, "in namespace 'std")) return std::nullopt;
    const std::string name = part(0);
    std::string header = standard_header(name);
    for (const std::string& note : error_.notes)
      if (const std::size_t at = note.find("#include <"); at != std::string::npos)
        header = note.substr(at + 9, note.find('>', at) - at - 8);
    return CppMistake{"E503", "std::" + name + " is not known here",
                      header.empty() ? "include the header that declares it"
                                     : "write at the top of the file: #include " + header};
  }

  [[nodiscard]] std::optional<CppMistake> no_member() const {
    if (has(text_, "request for member '")) {
      const std::string object = part(1).substr(part(1).find_last_of(".:") + 1);
      return CppMistake{"E501",
                        fmt::format("{} has no field '{}': it is '{}'", object, part(0), simple(part(2))),
                        "numbers, bools and durations have no fields"};
    }
    const bool gcc = has(text_, "has no member named '"), clang = has(text_, "no member named '") && !gcc;
    if (!gcc && !clang) return std::nullopt;
    const std::string type = part(gcc ? 0 : 1), name = part(gcc ? 1 : 0);
    std::string path;
    if (const spec::Subsystem* subsystem = subsystem_in(type, path))
      if (auto known = no_member_of(*subsystem, path, type, name)) return known;
    std::vector<std::string> names;
    const spec::Structure* structure = structure_in(type);
    if (structure != nullptr) add_names(names, structure->fields);
    const bool in = has_one(type, {"Input<", "Arrival"}), out = has_one(type, {"Output<", "Departure"});
    if (in)
      names.insert(names.end(), {"fresh", "age", "stamp", "valid", "failed", "timed_out", "disconnected"});
    if (out) names.insert(names.end(), {"stamp", "timed_out", "disconnected"});
    const std::string what = structure != nullptr ? structure->name
                             : in                 ? "this input"
                             : out                ? "this output"
                                                  : simple("'" + type + "'");
    return CppMistake{"E501", fmt::format("{} has no field '{}'", what, name), guess(name, names)};
  }

  [[nodiscard]] std::optional<CppMistake> no_member_of(const spec::Subsystem& subsystem,
                                                       const std::string& path, std::string_view type,
                                                       const std::string& name) const {
    std::vector<std::string> names;
    std::string what, none;
    if (type.ends_with("::Inputs")) {
      what = "input", none = "declare it in the specification under `inputs`";
      add_names(names, subsystem.inputs);
      if (subsystem.kind == spec::SubsystemKind::receptor) add_names(names, subsystem.real);
    } else if (type.ends_with("::Outputs")) {
      what = "output", none = "declare it in the specification under `outputs`";
      add_names(names, subsystem.outputs);
      if (subsystem.kind == spec::SubsystemKind::effector) add_names(names, subsystem.real);
    } else if (type.ends_with("::Memory")) {
      what = "memory", none = fmt::format("declare it in the specification: memory: {{ {}: float64 }}", name);
      add_names(names, subsystem.memory);
    } else if (type.ends_with("::Parameters")) {
      what = "parameter", none = "declare it in the specification under `parameters`";
      add_names(names, subsystem.parameters);
      add_names(names, model_.parameters);
    } else if (type.ends_with("::Context")) {
      names = {"now", "period", "iteration",      "in_behaviour", "index",      "parameters",
               "log", "warn",   "emergency_stop", "stop",         "assert_that"};
      return CppMistake{"E501", fmt::format("the context has no '{}'", name), guess(name, names)};
    } else {
      return std::nullopt;
    }
    const std::string near = did_you_mean(name, names).text;
    return CppMistake{"E501", fmt::format("{} has no {} '{}'", path, what, name), near.empty() ? none : near};
  }

  [[nodiscard]] std::optional<CppMistake> missing_file() const {
    if (!has(text_, ": No such file or directory") && !has(text_, "' file not found")) return std::nullopt;
    const std::string file =
        has(text_, "' file not found") ? part(0) : text_.substr(0, text_.find(": No such"));
    return CppMistake{"E504", "there is no file " + file,
                      "headers of the project are in src/ and are included by their path in it"};
  }

  [[nodiscard]] std::optional<CppMistake> literal() const {
    if (!has_one(text_, {"numeric literal operator", "no matching literal operator", "invalid suffix"}))
      return std::nullopt;
    return CppMistake{"E502", "this unit behind a number is not known here",
                      "for durations write at the top of the file: using namespace std::chrono_literals;"};
  }

  [[nodiscard]] std::optional<CppMistake> unknown_name() const {
    if (!has_one(text_, {"was not declared in this scope", "use of undeclared identifier",
                         "does not name a type", "unknown type name", "has not been declared"}))
      return std::nullopt;
    const std::string name = part(0);
    return CppMistake{"E502", fmt::format("unknown name '{}'", name), hint_for_name(name)};
  }

  [[nodiscard]] std::string hint_for_name(const std::string& name) const {
    if (const std::uint32_t line = declaration_before(content_of(error_.at.file), name, error_.at.line);
        line > 0)
      return fmt::format("the '{}' of line {} ends with its block: declare it before that block", name, line);
    const auto holds = [&](const auto& all) {
      return std::ranges::any_of(all, [&](const auto& one) { return one.name == name; });
    };
    if (holds(model_.parameters)) return "write context.parameters." + name;
    for (const spec::Definition& definition : model_.definitions)
      for (const spec::Subsystem& subsystem : definition.subsystems) {
        if (holds(subsystem.parameters)) return "write context.parameters." + name;
        if (holds(subsystem.memory)) return "write memory." + name;
        if (holds(subsystem.inputs)) return "write in." + name;
        if (holds(subsystem.outputs)) return "write out." + name;
        if (holds(subsystem.real))
          return (subsystem.kind == spec::SubsystemKind::receptor ? "write in." : "write out.") + name;
      }
    if (const std::size_t at = text_.find("did you mean '"); at != std::string::npos)
      return simple(text_.substr(at));
    if (const std::string header = standard_header(name); !header.empty())
      return fmt::format("write std::{}, and at the top of the file: #include {}", name, header);
    std::vector<std::string> names{"context", "in", "memory", "out"};
    add_names(names, model_.structures);
    const std::string near = did_you_mean(name, names).text;
    return near.empty() ? "declare it, or include the header that does" : near;
  }

  [[nodiscard]] std::optional<CppMistake> other_declaration() const {
    if (has(text_, "variable or field '") && has(text_, "declared void"))
      if (auto unknown = unknown_arguments(part(0))) return unknown;
    if (has_one(text_, {"ambiguating new declaration", "differ only in their return type",
                        "return-statement with a value", "should not return a value"}))
      return CppMistake{"E507", "a transition function returns nothing",
                        fmt::format("write void FUNCTION{}", signature)};
    if (has(text_, "redefinition of '")) return CppMistake{"E507", simple(text_), "keep one of them"};
    return std::nullopt;
  }

  /// g++ says no more where it does not know the types of the arguments.
  [[nodiscard]] std::optional<CppMistake> unknown_arguments(const std::string& function) const {
    for (const codegen::Stub& stub : functions_.wanted()) {
      if (stub.function != function) continue;
      return CppMistake{"E507", fmt::format("the arguments of '{}' are not known here", function),
                        fmt::format("that of {} is in the namespace {}, in a file with {}", stub.subsystem,
                                    stub.space, stub.preamble.substr(0, stub.preamble.find('\n')))};
    }
    return std::nullopt;
  }

  [[nodiscard]] std::optional<CppMistake> braces() const {
    if (!has_one(text_, {"ambiguous overload for 'operator='", "operator '=' is ambiguous"}))
      return std::nullopt;
    if (has_one(text_, {"Input<", "Arrival"})) return read_only_mistake();
    const spec::Structure* structure = structure_in(text_);
    const std::string type = structure == nullptr ? "TYPE" : structure->name;
    return CppMistake{"E506", "'= {}' may mean the value or the whole output",
                      fmt::format("name the type: = {}{{}};", type)};
  }

  [[nodiscard]] static CppMistake read_only_mistake() {
    return {"E506", "inputs and parameters cannot be changed",
            "a transition function writes to out and memory; --set changes parameters"};
  }

  [[nodiscard]] std::optional<CppMistake> read_only() const {
    if (!has_one(text_, {"in read-only object", "of read-only", "with const-qualified type",
                         "discards qualifiers", "marked const"}))
      return std::nullopt;
    return read_only_mistake();
  }

  [[nodiscard]] std::optional<CppMistake> operators() const {
    const bool gcc = has(text_, "no match for 'operator"), clang = has(text_, "invalid operands to binary");
    const bool assigns = has(text_, "'operator='") || has(text_, "no viable overloaded '='");
    if (!gcc && !clang && !assigns) return std::nullopt;
    std::string hint;
    if (const spec::Structure* structure = structure_in(text_)) {
      hint = assigns                     ? fmt::format("write a {0}: = {0}{{...}};", structure->name)
             : structure->fields.empty() ? ""
                                         : fmt::format("choose a field of {}, for example .{}",
                                                       structure->name, structure->fields.front().name);
    } else if (has(text_, "Duration")) {
      hint = "write a duration: 500ms, with `using namespace std::chrono_literals;` at the top of the file";
    }
    std::string message = simple(text_);
    return CppMistake{"E506", message, hint};
  }

  [[nodiscard]] std::optional<CppMistake> conversion() const {
    if (!has_one(text_, {"could not convert", "cannot convert", "no viable conversion",
                         "not contextually convertible", "cannot initialize", "different signedness",
                         "invalid initialization of reference", "cannot bind"}))
      return std::nullopt;
    std::string hint;
    const spec::Structure* structure = structure_in(text_);
    if (has(text_, "'bool'") && structure != nullptr && !structure->fields.empty())
      hint = fmt::format("choose a field of {}, for example .{}", structure->name,
                         structure->fields.front().name);
    if (has(text_, "different signedness"))
      hint = "write std::cmp_less(a, b), std::cmp_equal(a, b) and so on: they also compare negative numbers";
    return CppMistake{"E506", simple(text_), hint};
  }

  [[nodiscard]] std::optional<CppMistake> driver() const {
    constexpr std::string_view assertion = "static assertion failed";
    if (const std::size_t at = text_.find(assertion); at != std::string::npos) {
      const std::size_t colon = text_.find(": ", at);
      return CppMistake{"E505", colon == std::string::npos ? text_ : text_.substr(colon + 2), ""};
    }
    if (has_one(text_, {"but does not override", "only virtual member functions can be marked",
                        "conflicting return type", "different return type", "invalid covariant return type"}))
      return CppMistake{"E505", simple(text_), driver_rule};
    if (has(text_, "abstract class")) return CppMistake{"E505", simple(text_), driver_rule};
    return std::nullopt;
  }

  [[nodiscard]] std::optional<CppMistake> punctuation() const {
    if (!text_.starts_with("expected ")) return std::nullopt;
    std::string hint;
    if (text_.starts_with("expected ';'") || text_.starts_with("expected ',' or ';'"))
      hint = "end the statement with ;";
    // The places of the notes are the last ones.
    const std::size_t before = error_.reached.size() - std::min(error_.reached.size(), error_.notes.size());
    for (std::size_t i = 0; i < error_.notes.size() && before + i < error_.reached.size(); ++i)
      if (error_.notes[i].starts_with("to match this '"))
        hint = fmt::format("a {} from line {} on is not closed", error_.notes[i].substr(15, 1),
                           error_.reached[before + i].line);
    return CppMistake{"E508", simple(text_), hint};
  }

  const CompilerError& error_;
  const spec::Model& model_;
  const TransitionFunctions& functions_;
  std::string text_;
  std::vector<std::string> parts_;
};

}  // namespace

CppMistake understand(const CompilerError& error, const spec::Model& model,
                      const TransitionFunctions& functions) {
  return Meaning(error, model, functions).find();
}

}  // namespace tessera::project
