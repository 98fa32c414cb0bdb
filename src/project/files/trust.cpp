#include "project/files/trust.hpp"

#include <exception>
#include <optional>
#include <system_error>

#include "project/files/files.hpp"
#include "project/files/state_folder.hpp"

namespace tessera::project {

namespace fs = std::filesystem;

namespace {

/// The same project has one path, however it is reached.
fs::path real_path(const fs::path& project) {
  std::error_code problem;
  fs::path real = fs::canonical(project, problem);
  return problem ? project.lexically_normal() : real;
}

std::optional<fs::path> note_of_trust(const fs::path& real) {
  const std::optional<fs::path> folder = user_folder();
  if (!folder) return std::nullopt;
  return *folder / "trusted" / hash_of(real.string());
}

}  // namespace

bool is_trusted(const fs::path& project) {
  const fs::path real = real_path(project);
  const std::optional<fs::path> note = note_of_trust(real);
  return note && is_kept_by_user(*note) && content_of(*note) == real.string() + "\n";
}

bool trust(const fs::path& project) try {
  const fs::path real = real_path(project);
  const std::optional<fs::path> note = note_of_trust(real);
  if (!note) return false;
  keep_for_user(*note, real.string() + "\n");
  return true;
} catch (const std::exception&) {
  return false;
}

}  // namespace tessera::project
