#include "project/build/transition_functions.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <iterator>
#include <set>
#include <utility>

#include "project/files/files.hpp"
#include "tessera/nearest.hpp"

namespace tessera::project {

namespace fs = std::filesystem;

namespace {

/// Whether the generated CMakeLists.txt compiles the file, or sources may include it.
bool is_source(const fs::path& file) {
  static const std::set<std::string> endings{".cpp", ".cc",  ".cxx", ".hpp", ".hh",  ".hxx",
                                             ".h",   ".inl", ".ipp", ".tpp", ".inc", ".def"};
  return endings.contains(file.extension().string()) && !file.filename().string().starts_with('.');
}

bool is_compiled(const fs::path& file) {
  const std::string ending = file.extension().string();
  return ending == ".cpp" || ending == ".cc" || ending == ".cxx";
}

std::string whole_file(const codegen::Stub& stub) {
  return stub.preamble + "\n" + stub.body + "\n" + stub.closing;
}

}  // namespace

TransitionFunctions::TransitionFunctions(fs::path project, std::vector<codegen::Stub> wanted,
                                         const std::vector<fs::path>& sources)
    : project_(std::move(project)), wanted_(std::move(wanted)) {
  for (const fs::path& source : sources) read(source);
  if (!sources.empty()) return;
  const fs::path folder = project_ / "src";
  if (!fs::is_directory(folder)) return;
  for (const auto& entry :
       fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied))
    if (entry.is_regular_file() && is_source(entry.path())) read(entry.path());
}

void TransitionFunctions::read(const fs::path& file) {
  std::error_code problem;
  const fs::path known = fs::canonical(file, problem);
  if (problem || scans_.contains(known)) return;
  const std::string text = content_of(known);
  hashes_[known] = hash_of(text);
  const SourceScan& scan = scans_[known] = scan_source(text);
  for (const std::string& include : scan.includes)
    for (const fs::path& folder : {known.parent_path(), project_ / "src"})
      if (fs::is_regular_file(folder / include, problem)) read(folder / include);
}

fs::path TransitionFunctions::shown(const fs::path& file) const {
  std::error_code ignored;
  const fs::path relative = file.lexically_relative(fs::canonical(project_, ignored));
  return relative.empty() || *relative.begin() == ".." ? file : relative;
}

TransitionFunctions::Presence TransitionFunctions::presence(const codegen::Stub& stub) const {
  if (!definitions(stub).empty()) return Presence::defined;
  const bool possible = std::ranges::any_of(scans_, [&](const auto& one) {
    const SourceScan& scan = one.second;
    const auto word = scan.words.find(stub.function);
    if (word == scan.words.end()) return scan.makes_names;
    // Other subsystems may have functions with that name, and so may agents that had other names before.
    const std::string system = stub.space.substr(0, stub.space.find(':')) + "::";
    const auto others = std::ranges::count_if(scan.functions, [&](const ScannedFunction& function) {
      return function.name == stub.function && (is_wanted(function) || function.space.starts_with(system));
    });
    return scan.makes_names || word->second > static_cast<std::size_t>(others);
  });
  return possible ? Presence::unclear : Presence::missing;
}

bool TransitionFunctions::is_wanted(const ScannedFunction& function) const {
  return std::ranges::any_of(wanted_, [&](const codegen::Stub& stub) {
    return stub.function == function.name && stub.space == function.space;
  });
}

template <class Predicate>
std::vector<TransitionFunctions::Definition> TransitionFunctions::those(
    std::vector<ScannedFunction> SourceScan::*list, Predicate is_one) const {
  std::vector<Definition> found;
  for (const auto& [file, scan] : scans_)
    for (const ScannedFunction& function : scan.*list)
      if (is_one(function))
        found.push_back({shown(file), function.line, function.space, function.name, function.heading});
  return found;
}

std::vector<TransitionFunctions::Definition> TransitionFunctions::definitions(
    const codegen::Stub& stub) const {
  return those(&SourceScan::functions, [&](const ScannedFunction& one) {
    return one.name == stub.function && one.space == stub.space;
  });
}

std::vector<TransitionFunctions::Definition> TransitionFunctions::definitions_elsewhere(
    const codegen::Stub& stub) const {
  return those(&SourceScan::functions,
               [&](const ScannedFunction& one) { return one.name == stub.function && !is_wanted(one); });
}

std::vector<std::string> TransitionFunctions::leftovers(const codegen::Stub& stub) const {
  std::set<std::string> names;
  for (const Definition& one : those(&SourceScan::functions, [&](const ScannedFunction& function) {
         return function.space == stub.space && !is_wanted(function);
       }))
    names.insert(one.name);
  return {names.begin(), names.end()};
}

std::vector<TransitionFunctions::Definition> TransitionFunctions::definitions_with_other_arguments(
    const codegen::Stub& stub) const {
  return those(&SourceScan::others, [&](const ScannedFunction& one) {
    return one.name == stub.function && one.space == stub.space;
  });
}

std::optional<TransitionFunctions::Definition> TransitionFunctions::nearly(const codegen::Stub& stub) const {
  std::vector<Definition> candidates;
  for (const auto list : {&SourceScan::functions, &SourceScan::others})
    std::ranges::move(
        those(list, [&](const ScannedFunction& one) { return one.space == stub.space && !is_wanted(one); }),
        std::back_inserter(candidates));
  std::vector<std::string> names;
  for (const Definition& one : candidates) names.push_back(one.name);
  const auto found = std::ranges::find(candidates, nearest(stub.function, names), &Definition::name);
  return found == candidates.end() ? std::nullopt : std::optional(*found);
}

fs::path TransitionFunctions::file_for(const codegen::Stub& stub) const {
  for (const auto& [file, scan] : scans_) {
    if (!is_compiled(file)) continue;
    for (const ScannedFunction& function : scan.functions)
      if (function.space == stub.space) return shown(file);
  }
  return stub.file;
}

bool TransitionFunctions::knows(const fs::path& file) const {
  return std::ranges::any_of(scans_, [&](const auto& one) { return shown(one.first) == file; });
}

std::string TransitionFunctions::identity() const {
  std::string all;
  for (const auto& [file, hash] : hashes_) all += file.string() + " " + hash + "\n";
  return hash_of(all);
}

std::string with_function(std::string text, const codegen::Stub& stub) {
  const SourceScan before = scan_source(text);
  const auto end = before.ends.find(stub.space);
  if (text.empty()) return whole_file(stub);
  if (end == before.ends.end()) return text + (text.ends_with('\n') ? "\n" : "\n\n") + whole_file(stub);
  return text.insert(end->second, stub.body + "\n");
}

fs::path TransitionFunctions::add(const codegen::Stub& stub) {
  const fs::path file = project_ / file_for(stub);
  const std::string text = with_function(content_of(file), stub);
  write_file(file, text);
  scans_[fs::canonical(file)] = scan_source(text);
  hashes_[fs::canonical(file)] = hash_of(text);
  return file;
}

namespace {

std::string notes_of(const std::vector<TransitionFunctions::Definition>& definitions,
                     const codegen::Stub& stub) {
  std::string text;
  for (const auto& definition : definitions)
    text +=
        fmt::format("{}:{}: note: a function '{}' is here in {}; that of {} belongs in the namespace {}\n",
                    definition.file.string(), definition.line, stub.function,
                    definition.space.empty() ? "no namespace" : "the namespace " + definition.space,
                    stub.subsystem, stub.space);
  return text;
}

/// Whether a line of a linker contains the symbol as a whole word.
bool names(std::string_view line, const std::string& symbol) {
  for (std::size_t at = line.find(symbol); at != std::string_view::npos; at = line.find(symbol, at + 1)) {
    const char before = at == 0 ? ' ' : line[at - 1];
    if (std::isalnum(static_cast<unsigned char>(before)) == 0 && before != '_' && before != ':') return true;
  }
  return false;
}

bool has_any(std::string_view line, std::initializer_list<std::string_view> parts) {
  return std::ranges::any_of(parts, [&](std::string_view part) { return line.find(part) != line.npos; });
}

/// The messages of GNU ld and gold, lld and mold.
bool is_missing(std::string_view line) {
  return has_any(line, {"undefined reference to", "undefined symbol"});
}
bool is_double(std::string_view line) {
  return has_any(line, {"multiple definition of", "duplicate symbol"});
}

std::string twice_text(const codegen::Stub& stub, const TransitionFunctions& functions) {
  std::string text;
  for (const auto& definition : functions.definitions(stub)) {
    if (text.empty())
      text = fmt::format("{}:{}: error: the function '{}' of {} is defined more than once\n",
                         definition.file.string(), definition.line, stub.function, stub.subsystem);
    else
      text += fmt::format("{}:{}: note: here too\n", definition.file.string(), definition.line);
  }
  if (text.empty())
    text = fmt::format("error: the function '{}' of {} is defined more than once\n", stub.function,
                       stub.subsystem);
  return text + "hint: keep one of them; every source in src/ is part of the controller\n";
}

/// The message about an existing function of that name that the linker does not take; empty: there is none.
std::string other_parameters_text(const codegen::Stub& stub, const TransitionFunctions& functions) {
  std::vector<TransitionFunctions::Definition> all = functions.definitions(stub);
  std::ranges::move(functions.definitions_with_other_arguments(stub), std::back_inserter(all));
  std::string text;
  for (const auto& definition : all)
    text += fmt::format("{}:{}: error E507: the function '{}' of {} has other parameters\nfound:  {}\n",
                        definition.file.string(), definition.line, stub.function, stub.subsystem,
                        definition.heading);
  return text.empty() ? text : text + fmt::format("wanted: {}\n", stub.signature);
}

}  // namespace

std::string missing_text(const codegen::Stub& stub, const TransitionFunctions& functions) {
  const fs::path home = functions.file_for(stub);
  const bool is_new = !functions.knows(home);
  std::string place = home.string(), hint = "add it (or run `tessera generate --stubs`)";
  if (const auto near = functions.nearly(stub)) {
    place = fmt::format("{}:{}", near->file.string(), near->line);
    hint = fmt::format("did you mean '{}' at {}? Then call it '{}'; else {}", near->name, place,
                       stub.function, hint);
  }
  return fmt::format("{}: error: {} has no function '{}'\n{}hint: {}:\n\n{}\n", place, stub.subsystem,
                     stub.function, notes_of(functions.definitions_elsewhere(stub), stub), hint,
                     is_new ? whole_file(stub) : stub.body);
}

std::string misplaced_functions(const TransitionFunctions& functions) {
  std::string text;
  for (const codegen::Stub& stub : functions.wanted())
    if (functions.definitions(stub).empty()) text += notes_of(functions.definitions_elsewhere(stub), stub);
  return text;
}

std::string explain_build_errors(const std::string& text, const TransitionFunctions& functions) {
  const std::vector<codegen::Stub>& all = functions.wanted();
  std::set<std::size_t> missing, twice;
  std::string rest;
  bool more = false;
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    const std::string_view line = std::string_view(text).substr(start, end - start);
    start = end + 1;
    bool explained = false;
    for (std::size_t stub = 0; stub < all.size(); ++stub) {
      if (!names(line, all[stub].space + "::" + all[stub].function + "(")) continue;
      if (is_missing(line)) missing.insert(stub);
      if (is_double(line)) twice.insert(stub);
      explained = explained || is_missing(line) || is_double(line) || line.find("in function") != line.npos;
    }
    if (explained) continue;
    rest += std::string(line) + "\n";
    more = more || is_missing(line) || is_double(line) ||
           (line.find("error:") != line.npos && line.find("ld returned") == line.npos);
  }
  if (missing.empty() && twice.empty()) return text + misplaced_functions(functions);
  std::string explanation;
  for (const std::size_t stub : missing) {
    const std::string other = other_parameters_text(all[stub], functions);
    explanation += other.empty() ? missing_text(all[stub], functions) : other;
  }
  for (const std::size_t stub : twice) explanation += twice_text(all[stub], functions);
  return explanation + (more ? rest : "");
}

}  // namespace tessera::project
