#include "project/build/cpp_mistakes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace tessera::project {

namespace {

bool has(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }

bool has_one(std::string_view text, const std::vector<std::string_view>& parts) {
  return std::ranges::any_of(parts, [&](std::string_view part) { return has(text, part); });
}

/// The text in the quotes of that number.
std::string quoted_part(std::string_view text, std::size_t number = 0) {
  std::size_t at = text.find('\'');
  for (; number > 0 && at != std::string_view::npos; --number) {
    at = text.find('\'', at + 1);
    if (at != std::string_view::npos) at = text.find('\'', at + 1);
  }
  const std::size_t end = at == std::string_view::npos ? at : text.find('\'', at + 1);
  return end == std::string_view::npos ? std::string() : std::string(text.substr(at + 1, end - at - 1));
}

void erase_all(std::string& text, std::string_view part) {
  for (std::size_t at = text.find(part); !part.empty() && at != std::string::npos; at = text.find(part))
    text.erase(at, part.size());
}

constexpr std::string_view returns_nothing =
    "write void FUNCTION(Context& context, const Inputs& in, Memory& memory, Outputs& out)";
constexpr std::string_view read_only =
    "inputs and parameters cannot be changed: a transition function writes to out and memory";
constexpr std::string_view chrono =
    "write a duration: 500ms, with `using namespace std::chrono_literals;` at the top of the file";

/// A kind of mistake, and the hint that the compiler cannot give. The words are those of g++ and clang.
struct KnownMistake {
  std::vector<std::string_view> words;  ///< one of them is in the message
  const char* code;
  std::string_view hint;
};
const std::vector<KnownMistake> known_mistakes{
    {{"is not a member of 'std", "in namespace 'std"}, "E503", "include the header that declares it"},
    {{"has no member named 'skip'", "no member named 'skip' in 'tessera::"},
     "E501",
     "for an output, allow it in the behaviour: send: { NAME: { skip: allowed } }"},
    {{"has no member named '", "no member named '"}, "E501", ""},
    {{": No such file or directory", "' file not found"},
     "E504",
     "headers of the project are in src/ and are included by their path in it"},
    {{"numeric literal operator", "no matching literal operator", "invalid suffix"}, "E502", chrono},
    {{"ambiguating new declaration", "differ only in their return type", "return-statement with a value",
      "should not return a value"},
     "E507",
     returns_nothing},
    {{"redefinition of '"}, "E507", "keep one of them"},
    {{"ambiguous overload for 'operator='", "operator '=' is ambiguous"},
     "E506",
     "'= {}' may mean the value or the whole output: name the type, = TYPE{}"},
    {{"in read-only object", "of read-only", "with const-qualified type", "discards qualifiers",
      "marked const"},
     "E506",
     read_only},
    {{"'const tessera::Duration'", "'tessera::Duration'"}, "E506", chrono},
    {{"array<tessera::Buffer<"},
     "E506",
     "it has an element for each member of the fleet: write out.NAME[i] = in.OTHER[i] for each i"},
    {{"no match for 'operator", "invalid operands to binary", "no viable overloaded '='", "could not convert",
      "cannot convert", "no viable conversion", "not contextually convertible", "cannot initialize",
      "different signedness", "invalid initialization of reference", "cannot bind"},
     "E506",
     ""},
    {{"but does not override", "only virtual member functions can be marked", "conflicting return type",
      "different return type", "invalid covariant return type", "abstract class"},
     "E505",
     driver_rule},
};

/// Reads one error.
class Meaning {
 public:
  Meaning(const CompilerError& error, const spec::Model& model, const TransitionFunctions& functions)
      : error_(error), model_(model), functions_(functions), text_(error.text) {}

  [[nodiscard]] CppMistake find() const {
    // The compiler reports these in a library.
    if (has(error_.at.file, "/fmt/") || has(text_, "fmt::") || has(text_, "Cannot format"))
      return {"E509", "the text and its arguments do not go together",
              "write one {} for each argument, and only numbers, bools and texts as arguments"};
    if (const std::size_t at = text_.find("static assertion failed"); at != std::string::npos) {
      const std::size_t colon = text_.find(": ", at);
      return {"E505", colon == std::string::npos ? text_ : text_.substr(colon + 2), ""};
    }
    if (text_.starts_with("expected ")) return punctuation();
    if (has(text_, "variable or field '") && has(text_, "declared void"))
      if (auto unknown = unknown_arguments(quoted_part(text_))) return *std::move(unknown);
    if (has_one(text_, {"was not declared in this scope", "use of undeclared identifier",
                        "does not name a type", "unknown type name", "has not been declared"}))
      return told("E502", hint_for_name(quoted_part(text_)), "declare it, or include the header that does");
    if (text_.starts_with("request for member '")) {
      const std::string object = quoted_part(text_, 1);
      return {"E501",
              fmt::format("{} has no field '{}': it is '{}'", object.substr(object.find_last_of(".:") + 1),
                          quoted_part(text_), quoted_part(text_, 2)),
              "numbers, bools and durations have no fields"};
    }
    for (const KnownMistake& known : known_mistakes)
      if (has_one(text_, known.words)) return told(known.code, "", std::string(known.hint));
    return told("E500", "");
  }

 private:
  /// In the words of the compiler, without the namespaces of the project. Without a hint, the compiler's proposal is
  /// it, or otherwise the last.
  [[nodiscard]] CppMistake told(const char* code, std::string hint, std::string otherwise = "") const {
    std::string text = text_;
    for (const codegen::Stub& stub : functions_.wanted()) erase_all(text, stub.space + "::");
    for (const std::string& space :
         {model_.system + "::", std::string("{anonymous}::"), std::string("(anonymous namespace)::"),
          std::string(" [-fpermissive]"), std::string("const struct "), std::string("struct ")})
      erase_all(text, space);
    if (const std::size_t at = text.find("; did you mean "); at != std::string::npos) {
      if (hint.empty()) hint = text.substr(at + 2, text.find('?', at) - at - 1);
      text.resize(at);
    }
    // "'std::vector' is defined in header '<vector>'; did you forget to '#include <vector>'?"
    for (const std::string& note : error_.notes)
      if (const std::size_t at = note.find("#include <"); at != std::string::npos)
        hint = "write at the top of the file: " + note.substr(at, note.find('>', at) - at + 1);
    return {code, std::move(text), hint.empty() ? std::move(otherwise) : std::move(hint)};
  }

  /// The members of the specification, which the compiler does not propose.
  [[nodiscard]] std::string hint_for_name(const std::string& name) const {
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
    return {};
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

  [[nodiscard]] CppMistake punctuation() const {
    std::string hint;
    if (text_.starts_with("expected ';'") || text_.starts_with("expected ',' or ';'"))
      hint = "end the statement with ;";
    // The places of the notes are the last ones.
    const std::size_t before = error_.reached.size() - std::min(error_.reached.size(), error_.notes.size());
    for (std::size_t i = 0; i < error_.notes.size() && before + i < error_.reached.size(); ++i)
      if (error_.notes[i].starts_with("to match this '"))
        hint = fmt::format("a {} from line {} on is not closed", error_.notes[i].substr(15, 1),
                           error_.reached[before + i].line);
    return told("E508", std::move(hint));
  }

  const CompilerError& error_;
  const spec::Model& model_;
  const TransitionFunctions& functions_;
  std::string text_;
};

}  // namespace

CppMistake understand(const CompilerError& error, const spec::Model& model,
                      const TransitionFunctions& functions) {
  return Meaning(error, model, functions).find();
}

}  // namespace tessera::project
