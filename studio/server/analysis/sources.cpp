#include "server/analysis/sources.hpp"

#include <algorithm>
#include <array>

#include "codegen/codegen.hpp"
#include "project/build/transition_functions.hpp"

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
                   {"stub", stub.body}});
  }
  return all;
}

Sources::Added Sources::add(const spec::Model& model, const std::string& subsystem,
                            const std::string& function) const {
  TransitionFunctions known(project_, codegen::stubs(model));
  const auto stub = std::ranges::find_if(known.wanted(), [&](const codegen::Stub& one) {
    return one.subsystem == subsystem && one.function == function;
  });
  if (stub == known.wanted().end()) return {{}, "there is no behaviour " + subsystem + "." + function};
  const std::string file = known.file_for(*stub).generic_string();
  if (known.presence(*stub) != TransitionFunctions::Presence::missing) return {file, {}};
  if (!path_of(file)) return {file, file + " is not in src/, or a symbolic link leads there"};
  static_cast<void>(known.add(codegen::Stub(*stub)));
  return {file, {}};
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
  return SpecFile(*path).write(text, revision);
}

}  // namespace tessera::server
