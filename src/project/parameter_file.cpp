#include "project/parameter_file.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "diagnostics/source.hpp"
#include "spec/document/document.hpp"

namespace tessera::project {

namespace {

using diagnostics::Diagnostics;
using diagnostics::Span;

/// Collects the values of a file.
class ParameterReader {
 public:
  explicit ParameterReader(Diagnostics& out) : out_(out) {}

  void read(const spec::Node& node, const std::string& path) {
    if (node.is_map()) {
      read_map(node, path);
    } else if (path.empty()) {
      throw std::runtime_error(where(node.span) + "the file is no map: write one parameter per line, v: 0.1");
    } else {
      add(path, node);
    }
  }

  std::vector<GivenParameter> given;

 private:
  void read_map(const spec::Node& node, const std::string& path) {
    for (const spec::Entry& entry : node.entries) {
      const std::string whole = path.empty() ? entry.key : path + "." + entry.key;
      if (entry.value->is_null()) throw std::runtime_error(where(entry.span) + whole + " has no value");
      if (!entry.value->is_map()) refuse_second(whole, entry.span);
      read(*entry.value, whole);
    }
  }

  /// The reader of YAML finds the same key twice in one map, but not `a: { v: 1 }` beside `a.v: 2`.
  void refuse_second(const std::string& path, Span at) {
    const auto [first, added] = lines_.emplace(path, at.line);
    if (!added)
      out_.error("E009", at, fmt::format("a second value of '{}'", path),
                 fmt::format("the first one is on line {}; keep one of them", first->second));
  }

  void add(const std::string& path, const spec::Node& node) {
    given.push_back({path, node.is_scalar() ? node.text : list(node, path), where(node.span)});
  }

  [[nodiscard]] std::string list(const spec::Node& node, const std::string& path) const {
    std::string text;
    for (const spec::Node* item : node.items) {
      if (!item->is_scalar())
        throw std::runtime_error(where(item->span) + path + ": an element is no value: write [1, 2, 3]");
      text += (text.empty() ? "" : ", ") + item->text;
    }
    return "[" + text + "]";
  }

  [[nodiscard]] std::string where(Span at) const {
    return fmt::format("{}:{}:{}: ", out_.file(), at.line, at.column);
  }

  Diagnostics& out_;
  std::map<std::string, std::uint32_t> lines_;  ///< of the values read so far
};

/// Says what an error means in a file of parameters.
[[nodiscard]] Diagnostics about_parameters(const Diagnostics& found) {
  Diagnostics out = found.of_same_source();
  for (const diagnostics::Diagnostic& one : found.sorted())
    out.error(one.code, one.span, one.message,
              one.code == "E006" ? "one file holds one map of parameters" : one.hint);
  return out;
}

void throw_errors(const Diagnostics& found) {
  if (!found.has_errors()) return;
  std::string text = render(about_parameters(found));
  text.pop_back();  // the end of its last line
  throw std::runtime_error("the parameters cannot be read\n" + text);
}

[[nodiscard]] Diagnostics load_file(const std::filesystem::path& file) {
  Diagnostics text = diagnostics::load(file);
  if (!text.has_errors()) return text;
  const diagnostics::Diagnostic problem = text.sorted().front();
  if (std::filesystem::is_directory(file))
    throw std::runtime_error(
        fmt::format("{}: this is a folder; name the file of the parameters", file.string()));
  throw std::runtime_error(fmt::format("{}: {}{}", file.string(), problem.message,
                                       problem.hint.empty() ? "" : "; " + problem.hint));
}

/// A file without any value is no mistake: all its lines may be comments.
[[nodiscard]] bool is_empty(const Diagnostics& found) {
  const std::vector<diagnostics::Diagnostic> all = found.sorted();
  return !all.empty() && std::ranges::all_of(all, [](const auto& one) { return one.code == "E002"; });
}

/// A path with more parts is more specific. With as many parts, that is the one with fewer `[*]`.
[[nodiscard]] std::pair<std::ptrdiff_t, std::ptrdiff_t> specificity(const GivenParameter& one) {
  return {std::ranges::count(one.path, '.'), -std::ranges::count(one.path, '*')};
}

}  // namespace

std::vector<GivenParameter> read_parameter_file(const std::filesystem::path& file) {
  Diagnostics found = load_file(file);
  const std::optional<spec::Document> document = spec::read_document(found);
  if (is_empty(found)) return {};
  throw_errors(found);
  ParameterReader reader(found);
  reader.read(document->root(), "");
  throw_errors(found);
  // A map of YAML has no order. Later values replace earlier ones, so the most specific come last.
  std::ranges::stable_sort(reader.given, {}, specificity);
  return std::move(reader.given);
}

GivenParameter read_assignment(const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0)
    throw std::runtime_error(fmt::format("--set {}: expected PATH=VALUE", assignment));
  return {assignment.substr(0, equals), assignment.substr(equals + 1), ""};
}

}  // namespace tessera::project
