#include "server/analysis/sources.hpp"

#include <algorithm>
#include <array>
#include <functional>

#include "codegen/codegen.hpp"
#include "language/language.hpp"
#include "project/build/transition_functions.hpp"
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

bool is_source(const fs::path& file) {
  constexpr std::array<std::string_view, 6> endings{".cpp", ".cc", ".cxx", ".hpp", ".hh", ".h"};
  return std::ranges::count(endings, file.extension().string()) > 0;
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
      if (const auto found = unit.behaviours.find(name);
          definition.name + "." + unit.name == subsystem && found != unit.behaviours.end())
        return document.lines().position(index[found->second].definition.begin);
  return std::nullopt;
}

/// Makes those edits of a file that certainly concern the name. The last one comes first, so that the
/// positions of the others stay valid.
std::string edited(std::string text, std::vector<language::TextEdit> edits, const std::string& path) {
  std::ranges::sort(edits, std::greater{}, [](const language::TextEdit& edit) { return edit.range; });
  for (const language::TextEdit& edit : edits)
    if (edit.path == path && edit.sure) language::replace(text, edit.range, edit.text);
  return text;
}

std::vector<language::Source> code_of(const fs::path& project) {
  std::vector<language::Source> all;
  for (const char* folder : {"src", "test"}) {
    std::error_code missing;
    for (fs::recursive_directory_iterator at(project / folder, missing), end; !missing && at != end;
         at.increment(missing))
      if (is_source(at->path()) && !at->is_symlink(missing) && at->is_regular_file(missing))
        all.push_back(
            {at->path().lexically_relative(project).generic_string(), project::content_of(at->path())});
  }
  return all;
}

}  // namespace

Sources::Renamed Sources::rename(const std::string& text, const language::Grammar& grammar,
                                 const std::string& subsystem, const std::string& from,
                                 const std::string& function) const {
  // The specification with the old name of the function. Only then is the function known as that of a
  // behaviour.
  const language::Document now(text, grammar);
  const auto here = name_of_behaviour(now, subsystem, function);
  if (!here) return {{}, Problem{"there is no behaviour " + subsystem + "." + function}};
  const language::Renaming back = language::rename(now, nullptr, *here, {}, from);
  if (back.problem) return {{}, Problem{*back.problem}};
  const language::Document before(edited(text, back.edits, ""), grammar);
  const auto there = name_of_behaviour(before, subsystem, from);
  if (!there) return {{}, Problem{"there is no function " + from}};
  const std::vector<language::Source> sources = code_of(project_);
  const language::Renaming renaming = language::rename(before, nullptr, *there, sources, function);
  if (renaming.problem) return {{}, Problem{*renaming.problem}};
  Renamed renamed;
  for (const language::Source& source : sources) {
    const std::string changed = edited(source.text, renaming.edits, source.path);
    if (changed == source.text) continue;
    SpecFile file(project_ / source.path);
    const SpecFile::Content known = file.read();
    if (known.text != source.text || file.write(changed, known.revision).written != SpecFile::Written::yes)
      return {renamed.files, Problem{source.path + " cannot be written, or another program changes it"}};
    renamed.files.push_back(source.path);
  }
  if (renamed.files.empty()) return {{}, Problem{"there is no function " + from}};
  return renamed;
}

std::optional<fs::path> Sources::path_of(const std::string& file) const {
  const fs::path name(file);
  if (name.is_absolute() || name.begin() == name.end() || *name.begin() != "src" || !is_source(name))
    return std::nullopt;
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
  const std::optional<fs::path> path = path_of(file);
  std::error_code missing;
  if (!path || !fs::is_directory(path->parent_path(), missing)) return std::nullopt;
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
