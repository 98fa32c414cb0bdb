#include "project/build/build_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "project/build/compiler_messages.hpp"
#include "project/build/cpp_mistakes.hpp"
#include "project/files/files.hpp"

namespace tessera::project {

namespace fs = std::filesystem;

namespace {

/// Mistakes that are shown: more do not fit on a screen.
constexpr std::size_t most_mistakes = 4;

/// A driver's row in the generated tables: {"robot.sensor.left", "Eye", &driver_places[2], ...
struct DriverRow {
  std::string buffer, name;
};

std::optional<DriverRow> driver_row(std::string_view line) {
  std::array<std::string, 2> texts;
  std::size_t at = line.find("{\"");
  for (std::string& text : texts) {
    at = line.find('"', at);
    const std::size_t end = at == std::string_view::npos ? at : line.find('"', at + 1);
    if (end == std::string_view::npos) return std::nullopt;
    text = line.substr(at + 1, end - at - 1);
    at = end + 1;
  }
  return DriverRow{texts[0], texts[1]};
}

/// "using tessera_driver_2 = Eye;"
std::optional<std::string> driver_alias(std::string_view line) {
  const std::size_t equals = line.find("= "), end = line.find(';');
  if (line.find("using tessera_driver_") == std::string_view::npos || equals == std::string_view::npos ||
      end == std::string_view::npos)
    return std::nullopt;
  return std::string(line.substr(equals + 2, end - equals - 2));
}

/// Explains the errors of the compiler one after the other.
class Explanation {
 public:
  explicit Explanation(const BuildContext& context) : context_(context) {}

  void add(CompilerError error) {
    lead_to_file(error.at);
    for (SourcePlace& place : error.reached) lead_to_file(place);
    const std::optional<Shown> shown = place_of(error);
    // Errors in a library follow from a mistake that has been shown.
    if (!shown || (count_ > 0 && !is_of_user(shown->file.string()))) return;
    // Two conditions may stand in one line of the specification.
    const bool is_specification = is_of_specification(shown->file);
    if (!is_specification && follows_from_punctuation(*shown)) return;
    const std::string place = fmt::format("{}:{}:{}", shown->file.string(), shown->span.line,
                                          is_specification ? shown->span.column : 0);
    if (!seen_.insert(place).second) return;
    if (!is_specification && shown->mistake.code == "E508") note_misread(*shown);
    if (++count_ > most_mistakes) return;
    text_ += rendered(*shown);
  }

  [[nodiscard]] std::string text() const {
    if (count_ <= most_mistakes) return text_;
    return text_ + fmt::format("{} more mistake{} not shown\n", count_ - most_mistakes,
                               count_ - most_mistakes == 1 ? " is" : "s are");
  }
  [[nodiscard]] std::size_t count() const { return count_; }

 private:
  struct Shown {
    fs::path file;
    diagnostics::Span span;
    CppMistake mistake;
  };

  /// Lines that the compiler has read wrongly, because a `;` or a bracket is missing before them.
  struct Misread {
    fs::path file;
    std::uint32_t first = 0, last = 0;
  };

  /// A place in a generated source whose text stands in the specification becomes the place there. The line before
  /// the text belongs to its beginning.
  void lead_to_file(SourcePlace& place) const {
    // Some compilers are started with paths that are relative to the folder of the build, for example by ccache.
    if (!place.file.starts_with('<'))  // "<command-line>"
      place.file = (context_.log.parent_path() / place.file).lexically_normal().string();
    const auto file = context_.lines.find(place.file);
    if (file == context_.lines.end()) return;
    const auto line = std::ranges::lower_bound(file->second, place.line, {}, &codegen::SourceLine::line);
    if (line == file->second.end() || line->line > place.line + 1) return;
    const diagnostics::SourceLine written = context_.specification.model.sources.at(line->spec_line);
    place = {file_of(written).string(), written.line,
             line->column + (line->line == place.line ? place.column - 1 : 0)};
  }

  [[nodiscard]] fs::path file_of(const diagnostics::SourceLine& line) const {
    return line.file.empty() ? context_.specification.file : context_.specification.project / line.file;
  }

  /// It is the specification or a file that it includes.
  [[nodiscard]] bool is_of_specification(const fs::path& file) const {
    const std::vector<std::string> included = context_.specification.model.sources.included();
    return file == context_.specification.file || std::ranges::any_of(included, [&](const std::string& one) {
             return file == context_.specification.project / one;
           });
  }

  [[nodiscard]] bool follows_from_punctuation(const Shown& shown) const {
    return std::ranges::any_of(misread_, [&](const Misread& one) {
      return one.file == shown.file && one.first <= shown.span.line && shown.span.line <= one.last;
    });
  }

  /// The rest of the function; outside of functions the rest of the file.
  void note_misread(const Shown& shown) {
    Misread rest{shown.file, shown.span.line, UINT32_MAX};
    for (const ScannedBody& body : scan_source(content_of(shown.file)).bodies)
      if (body.first <= shown.span.line && shown.span.line <= body.last) rest.last = body.last;
    misread_.push_back(std::move(rest));
  }

  [[nodiscard]] bool is_of_user(const std::string& file) const {
    const fs::path path = fs::path(file).lexically_normal();
    const std::string inside = path.lexically_relative(context_.specification.project).string();
    return !inside.empty() && !inside.starts_with("..") && !inside.starts_with(".tessera");
  }

  [[nodiscard]] std::optional<Shown> place_of(const CompilerError& error) const {
    CppMistake mistake = understand(error, context_.specification.model, context_.functions);
    const bool is_condition = is_of_specification(fs::path(error.at.file).lexically_normal());
    if (is_condition && (mistake.code == "E502" || mistake.code == "E503"))
      mistake.hint =
          "a condition includes no headers: call it in a transition function, and keep the result "
          "in memory";
    if (is_of_user(error.at.file)) return at(error.at, error.length, mistake);
    if (std::optional<Shown> driver = driver_of(error)) return driver;
    for (const SourcePlace& from : error.reached)
      if (is_of_user(from.file)) return at(from, 1, mistake);
    return at(error.at, error.length, mistake);
  }

  [[nodiscard]] static Shown at(const SourcePlace& place, std::uint32_t length, CppMistake mistake) {
    return {fs::path(place.file).lexically_normal(), {place.line, place.column, length}, std::move(mistake)};
  }

  /// Errors in the table of drivers belong to the line of the specification that names the class.
  [[nodiscard]] std::optional<Shown> driver_of(const CompilerError& error) const {
    std::vector<SourcePlace> places{error.at};
    places.insert(places.end(), error.reached.begin(), error.reached.end());
    for (const SourcePlace& place : places) {
      if (fs::path(place.file).filename() != "system.drivers.cpp" || is_of_user(place.file)) continue;
      if (error.text.starts_with("drivers.hpp:"))
        return of_driver("", "",
                         {"E504", "src/drivers.hpp is missing: it has the classes of the drivers",
                          fmt::format("write it, with #include <tessera/device.hpp>: {}", driver_rule)});
      const diagnostics::Diagnostics source(place.file, content_of(place.file));
      const std::string_view line = source.line(place.line);
      if (const auto alias = driver_alias(line))
        return of_driver(*alias, "",
                         {"E505", fmt::format("there is no class {} in src/drivers.hpp", *alias),
                          fmt::format("{}; a class in a namespace is named with it", driver_rule)});
      // A driver that does not fit causes further errors.
      const auto row = driver_row(line);
      if (!row || !error.text.starts_with("static assertion failed")) continue;
      const CppMistake mistake = understand(error, context_.specification.model, context_.functions);
      return of_driver(
          row->name, row->buffer,
          {"E505", fmt::format("the class {} does not fit: {}", row->name, mistake.message), mistake.hint});
    }
    return std::nullopt;
  }

  /// The line of the specification with that driver; empty names: the first one.
  [[nodiscard]] std::optional<Shown> of_driver(const std::string& name, const std::string& buffer,
                                               CppMistake mistake) const {
    const spec::Model& model = context_.specification.model;
    std::vector<const spec::Driver*> all;
    for (const spec::Driver& driver : model.drivers) all.push_back(&driver);
    if (model.simulation)
      for (const spec::Driver& driver : model.simulation->drivers) all.push_back(&driver);
    for (const spec::Driver* driver : all) {
      if (driver->kind != "cpp" || (!name.empty() && driver->target() != name) ||
          (!buffer.empty() && model.driver_path(*driver) != buffer))
        continue;
      return Shown{context_.specification.file, driver->targets.front().span, std::move(mistake)};
    }
    return std::nullopt;
  }

  [[nodiscard]] std::string rendered(const Shown& shown) const {
    const fs::path relative = shown.file.lexically_relative(context_.specification.project);
    const bool is_near = !relative.empty() && !relative.string().starts_with("..");
    diagnostics::Diagnostics source(is_near ? relative.string() : shown.file.string(),
                                    content_of(shown.file));
    const diagnostics::Diagnostic one{diagnostics::Severity::error, shown.mistake.code, shown.span,
                                      shown.mistake.message, shown.mistake.hint};
    return diagnostics::render(one, source);
  }

  const BuildContext& context_;
  std::string text_;
  std::size_t count_ = 0;
  std::set<std::string> seen_;
  std::vector<Misread> misread_;
};

/// The first lines of a text that is not understood.
std::string beginning(std::string_view text, std::size_t lines) {
  std::size_t end = 0;
  for (std::size_t i = 0; i < lines && end < text.size(); ++i)
    end = std::min(text.find('\n', end), text.size() - 1) + 1;
  return std::string(text.substr(0, end)) + (end < text.size() ? "...\n" : "");
}

/// Without what ninja writes around the messages of the linker, and each line once: every source repeats what the
/// compiler says about its options.
std::string without_commands(std::string_view output) {
  std::string kept;
  std::set<std::string_view> seen;
  for (std::size_t start = 0; start < output.size();) {
    const std::size_t end = std::min(output.find('\n', start), output.size());
    const std::string_view line = output.substr(start, end - start);
    start = end + 1;
    const bool is_command = line.starts_with("[") || line.starts_with("FAILED:") ||
                            line.starts_with("ninja: build") || line.starts_with("ninja: Entering") ||
                            line.starts_with("-- ") || line.find("/c++ ") != std::string_view::npos ||
                            line.find("/g++ ") != std::string_view::npos;
    if (!is_command && seen.insert(line).second) kept += std::string(line) + "\n";
  }
  return kept;
}

std::string whole_output(const fs::path& log) {
  return fmt::format("the whole output of the compiler: {}\n", log.string());
}

}  // namespace

std::string explain_build(std::string_view output, const BuildContext& context) {
  Explanation explanation(context);
  for (const CompilerError& error : read_compiler_errors(output)) explanation.add(error);
  std::string text = explanation.text();
  if (explanation.count() > 0)
    text += misplaced_functions(context.functions);
  else
    text = beginning(explain_build_errors(without_commands(output), context.functions), 20);
  return text + whole_output(context.log);
}

std::string explain_configuration(std::string_view output, const fs::path& log) {
  std::string text;
  std::size_t lines = 0;
  bool inside = false;
  for (std::size_t start = 0; start < output.size();) {
    const std::size_t end = std::min(output.find('\n', start), output.size());
    const std::string_view line = output.substr(start, end - start);
    start = end + 1;
    if (line.starts_with("CMake Error")) {
      inside = true;
      continue;
    }
    if (line.starts_with("-- ") || line.starts_with("Call Stack") || line.starts_with("CMake Warning"))
      inside = false;
    if (inside && !line.empty() && ++lines <= 8) text += std::string(line) + "\n";
  }
  std::string hint;
  if (output.find("CMAKE_CXX_COMPILER") != std::string_view::npos)
    hint = "hint: install a compiler of C++20: apt install g++\n";
  else if (output.find("CMAKE_MAKE_PROGRAM") != std::string_view::npos)
    hint = "hint: install ninja: apt install ninja-build\n";
  if (text.empty()) text = beginning(output, 12);
  return fmt::format("error {}: CMake could not prepare the build\n{}{}the whole output of CMake: {}\n",
                     "E510", text, hint, log.string());
}

}  // namespace tessera::project
