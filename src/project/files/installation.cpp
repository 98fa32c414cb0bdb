#include "project/files/installation.hpp"

#include <stdexcept>

namespace tessera::project {

namespace fs = std::filesystem;

Installation Installation::find() {
  const fs::path folder = fs::read_symlink("/proc/self/exe").parent_path();
  for (const fs::path& prefix : {folder, folder.parent_path()}) {
    if (!fs::exists(prefix / "share/tessera")) continue;
    const fs::path libraries = prefix / "lib/tessera";
    return {prefix / "share/tessera", prefix / "lib/cmake/tessera", libraries / "libtessera_world.so",
            libraries / "libtessera_coppelia.so", libraries / "libtessera_dds.so"};
  }
  throw std::runtime_error("this installation is incomplete: no share/tessera beside " + folder.string());
}

std::optional<fs::path> find_asset(const std::string& name, const fs::path& project,
                                   const std::string& folder) {
  const fs::path given(name);
  if (given.is_absolute()) return fs::exists(given) ? std::optional(given) : std::nullopt;
  for (const fs::path& candidate : {project / given, Installation::find().share / folder / given})
    if (fs::exists(candidate)) return fs::absolute(candidate);
  return std::nullopt;
}

}  // namespace tessera::project
