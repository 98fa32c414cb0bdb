#include "server/analysis/arrangement.hpp"

#include <exception>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>

#include "project/files/files.hpp"
#include "project/files/state_folder.hpp"

namespace tessera::server {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

/// The same project has one path, however it is reached. The specification may not be there yet.
fs::path file_for(const fs::path& specification) {
  const std::optional<fs::path> folder = project::user_folder();
  if (!folder) return {};
  std::error_code problem;
  const fs::path real = fs::canonical(specification.parent_path(), problem);
  const fs::path path = (problem ? specification.parent_path() : real) / specification.filename();
  return *folder / "pages" / (project::hash_of(path.string()) + ".json");
}

}  // namespace

Arrangement::Arrangement(const fs::path& specification) : file_(file_for(specification)) {}

Arrangement::Entries Arrangement::read() const {
  const std::lock_guard lock(mutex_);
  return read_unlocked();
}

Arrangement::Entries Arrangement::read_unlocked() const {
  if (file_.empty() || !project::is_kept_by_user(file_)) return {};
  const json given = json::parse(project::content_of(file_), nullptr, false);
  Entries entries;
  if (!given.is_object()) return entries;
  for (const auto& [name, text] : given.items())
    if (text.is_string()) entries[name] = text.get<std::string>();
  return entries;
}

bool Arrangement::keep(const std::string& name, const std::string& text) {
  const std::lock_guard lock(mutex_);
  if (file_.empty()) return false;
  Entries entries = read_unlocked();
  entries[name] = text;
  if (entries.size() > most_names) return false;
  try {
    project::keep_for_user(file_, json(entries).dump(1) + "\n");
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace tessera::server
