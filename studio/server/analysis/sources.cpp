#include "server/analysis/sources.hpp"

#include <algorithm>
#include <array>

#include "codegen/codegen.hpp"
#include "diagnostics/utf8.hpp"
#include "language/language.hpp"
#include "project/build/transition_functions.hpp"
#include "project/build/user_sources.hpp"
#include "project/files/file_names.hpp"
#include "project/files/files.hpp"

namespace tessera::server {

namespace fs = std::filesystem;
using nlohmann::json;
using project::TransitionFunctions;

namespace {

const char* name_of(TransitionFunctions::Presence presence) {
  constexpr std::array<const char*, 3> names{"defined", "unclear", "missing"};
  return names[static_cast<std::size_t>(presence)];
}

}  // namespace

json Sources::functions(const spec::Model& model) const {
  const TransitionFunctions known(project_, codegen::stubs(model));
  json all = json::array();
  for (const codegen::Stub& stub : known.wanted()) {
    const auto definitions = known.definitions(stub);
    const fs::path file = definitions.empty() ? known.file_for(stub) : definitions.front().file;
    all.push_back({{"subsystem", stub.subsystem},
                   {"function", stub.function},
                   {"state", name_of(known.presence(stub))},
                   {"file", file.generic_string()},
                   {"line", definitions.empty() ? json(nullptr) : json(definitions.front().line)},
                   {"stub", stub.body},
                   {"leftovers", known.leftovers(stub)}});
  }
  return all;
}

Sources::Added Sources::add(const spec::Model& model, const std::string& subsystem,
                            const std::string& function) const {
  TransitionFunctions known(project_, codegen::stubs(model));
  const auto stub = std::ranges::find_if(known.wanted(), [&](const codegen::Stub& one) {
    return one.subsystem == subsystem && one.function == function;
  });
  if (stub == known.wanted().end())
    return {{}, Problem{"there is no behaviour " + subsystem + "." + function}};
  const std::string file = known.file_for(*stub).generic_string();
  if (known.presence(*stub) != TransitionFunctions::Presence::missing) return {file, {}};
  if (!path_of(file)) return {file, Problem{file + " is not in src/, or a symbolic link leads there"}};
  static_cast<void>(known.add(codegen::Stub(*stub)));
  return {file, {}};
}

namespace {

/// The position of a behaviour's name; nullopt: there is no such behaviour.
std::optional<language::Position> name_of_behaviour(const language::Document& document,
                                                    const std::string& subsystem, const std::string& name) {
  const language::Index& index = document.index();
  for (const language::DefinitionNames& definition : index.definitions())
    for (const language::UnitNames& unit : definition.units)
      if (const auto found = unit.functions.find(name);
          definition.name + "." + unit.name == subsystem && found != unit.functions.end())
        return document.lines().position(index[found->second.back()].definition.begin);
  return std::nullopt;
}

}  // namespace

std::vector<language::Source> Sources::all() const {
  std::vector<language::Source> all;
  for (const fs::path& file : project::user_sources(project_))
    all.push_back({file.lexically_relative(project_).generic_string(), project::content_of(file)});
  return all;
}

Sources::Renamed Sources::rename(const std::string& text, const language::Grammar& grammar,
                                 const std::string& subsystem, const std::string& from,
                                 const std::string& function) const {
  // The specification with the old name of the function. Only then is the function known as that of a
  // behaviour.
  const language::Document now(text, grammar);
  const auto here = name_of_behaviour(now, subsystem, function);
  if (!here) return {{}, Problem{"there is no behaviour " + subsystem + "." + function}};
  // "charge_ask" in the group `charge`: only the last part is the name of the behaviour itself.
  const std::size_t around =
      function.size() - now.index()[now.index().at(now.lines().offset(*here))->symbol].name.size();
  if (from.size() <= around || from.compare(0, around, function, 0, around) != 0)
    return {{}, Problem{"there is no function " + from}};
  const language::Renaming back = language::rename(now, nullptr, *here, {}, from.substr(around));
  if (back.problem) return {{}, Problem{*back.problem}};
  const language::Document before(language::edited(now, back.edits), grammar);
  const auto there = name_of_behaviour(before, subsystem, from);
  if (!there) return {{}, Problem{"there is no function " + from}};
  const std::vector<language::Source> sources = all();
  const language::Renaming renaming =
      language::rename(before, nullptr, *there, sources, function.substr(around));
  if (renaming.problem) return {{}, Problem{*renaming.problem}};
  Renamed renamed;
  std::vector<project::Replacement> files;
  for (const language::Source& source : sources) {
    std::string changed = language::edited(source, renaming.edits);
    const bool differs = changed != source.text;
    files.push_back({project_ / source.path, source.text, std::move(changed)});
    if (differs) renamed.files.push_back(source.path);
  }
  if (renamed.files.empty()) return {{}, Problem{"there is no function " + from}};
  if (const auto problem = project::replace_together(project_, files)) return {{}, Problem{*problem}};
  return renamed;
}

std::optional<std::string> Sources::write_together(const std::vector<Written>& files) const {
  std::vector<project::Replacement> all;
  for (const Written& one : files) {
    const std::optional<fs::path> path = path_of_any(one.file);
    if (!path) return one.file + " is no file of this project that names parts of its specification";
    const SpecFile::Content now = SpecFile(*path).read();
    if (now.revision.empty()) return one.file + " cannot be read: " + now.error;
    if (now.revision != one.revision) return one.file + " was changed by another program";
    if (diagnostics::first_invalid_byte(now.text))
      return one.file + " has bytes that are not UTF-8, which would be lost";
    all.push_back({*path, now.text, one.text});
  }
  return project::replace_together(project_, all);
}

std::optional<fs::path> Sources::path_of(const std::string& file) const {
  const fs::path name(file);
  if (name.begin() == name.end() || *name.begin() != "src" || !project::is_code(name)) return std::nullopt;
  return path_without_links(name);
}

std::optional<fs::path> Sources::path_of_any(const std::string& file) const {
  const fs::path name(file);
  if (file == specification_ || file == project::file_names::parameters) return path_without_links(name);
  if (name.begin() == name.end() || (*name.begin() != "src" && *name.begin() != "test") ||
      !project::is_code(name))
    return std::nullopt;
  const std::optional<fs::path> path = path_without_links(name);
  std::error_code missing;
  return path && fs::is_directory(path->parent_path(), missing) ? path : std::nullopt;
}

std::optional<fs::path> Sources::path_without_links(const fs::path& name) const {
  if (name.is_absolute()) return std::nullopt;
  fs::path path = project_;
  for (const fs::path& part : name) {
    const std::string text = part.string();
    if (text.empty() || text.front() == '.') return std::nullopt;
    path /= part;
    std::error_code missing;
    if (fs::is_symlink(fs::symlink_status(path, missing))) return std::nullopt;
  }
  return path;
}

std::optional<SpecFile::Content> Sources::read(const std::string& file) const {
  const std::optional<fs::path> path = path_of_any(file);
  if (!path || file == specification_) return std::nullopt;
  return SpecFile(*path).read();
}

std::optional<SpecFile::Outcome> Sources::write(const std::string& file, const std::string& text,
                                                const std::string& revision) const {
  const std::optional<fs::path> path = path_of(file);
  std::error_code missing;
  if (!path || !fs::is_directory(path->parent_path(), missing)) return std::nullopt;
  return SpecFile(*path).write_shown(text, revision);
}

}  // namespace tessera::server
