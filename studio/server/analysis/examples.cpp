#include "server/analysis/examples.hpp"

#include <algorithm>
#include <fstream>
#include <map>
#include <system_error>

#include "project/files/file_names.hpp"
#include "project/files/files.hpp"

namespace tessera::server {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

/// The text of the comment that a file begins with, up to the end of its first sentence.
std::string first_comment(const fs::path& file) {
  std::ifstream stream(file);
  std::string line, text;
  while (std::getline(stream, line) && line.starts_with("#")) {
    const std::size_t from = line.find_first_not_of("# ");
    if (from == std::string::npos) break;
    text += (text.empty() ? "" : " ") + line.substr(from);
    if (const std::size_t end = text.find(". "); end != std::string::npos) return text.substr(0, end + 1);
  }
  return text;
}

std::map<std::string, fs::path> by_name(const fs::path& folder) {
  std::map<std::string, fs::path> found;
  std::error_code ignored;
  for (fs::directory_iterator entry(folder, ignored), end; !ignored && entry != end; entry.increment(ignored))
    if (fs::is_regular_file(entry->path() / project::file_names::specification, ignored))
      found.emplace(entry->path().filename().string(), entry->path());
  return found;
}

bool is_for_projects(const fs::path& relative) {
  const std::string first = relative.begin()->string();
  return !first.starts_with('.') && relative.extension() != ".md";
}

}  // namespace

json examples_in(const fs::path& folder) {
  json all = json::array();
  for (const auto& [name, path] : by_name(folder))
    all.push_back({{"name", name}, {"title", first_comment(path / project::file_names::specification)}});
  return all;
}

Begun begin_with(const fs::path& examples, const std::string& name, const fs::path& specification) {
  Begun begun;
  const auto found = by_name(examples);
  const auto example = found.find(name);
  if (example == found.end()) return {{}, {}, Problem{"there is no example " + name}};
  std::error_code problem;
  if (const auto size = fs::file_size(specification, problem); !problem && size > 0)
    return {{}, {}, Problem{specification.filename().string() + " is not empty"}};
  // The specification comes last: without it, the project has not begun.
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(example->second))
    if (entry.is_regular_file()) files.push_back(entry.path().lexically_relative(example->second));
  std::stable_partition(files.begin(), files.end(),
                        [](const fs::path& file) { return file != project::file_names::specification; });
  for (const fs::path& file : files) {
    if (!is_for_projects(file)) continue;
    const bool is_specification = file == project::file_names::specification;
    const fs::path to = is_specification ? specification : specification.parent_path() / file;
    if (!is_specification && fs::exists(fs::symlink_status(to, problem))) {
      begun.kept.push_back(file.generic_string());
      continue;
    }
    if (fs::is_symlink(fs::symlink_status(to, problem))) {
      begun.problem = Problem{to.string() + " is a symbolic link, which is not followed"};
      return begun;
    }
    fs::create_directories(to.parent_path(), problem);
    if (problem) {
      begun.problem = Problem{to.string() + ": " + problem.message()};
      return begun;
    }
    try {
      project::copy_whole(example->second / file, to);
    } catch (const std::runtime_error& failure) {
      begun.problem = Problem{failure.what()};
      return begun;
    }
    begun.files.push_back(file.generic_string());
  }
  return begun;
}

}  // namespace tessera::server
