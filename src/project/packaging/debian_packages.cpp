#include "project/packaging/debian_packages.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>

#include "project/files/files.hpp"
#include "project/packaging/scratch_folder.hpp"
#include "project/process/process.hpp"

namespace tessera::project {

namespace fs = std::filesystem;

namespace {

/// Its output; throws if it fails. In the language of programs, whatever that of the user is.
std::string output_of(Command command) {
  command.insert(command.begin(), {"env", "LC_ALL=C"});
  const Exit done = capture(command);
  if (done.code != 0)
    throw std::runtime_error(fmt::format("`{}` failed:\n{}", shell_line(command), done.text));
  return done.text;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The libraries that a file names itself.
std::set<std::string> needed_by(const fs::path& file) {
  std::set<std::string> names;
  // "0x01 (NEEDED)  Shared library: [libfmt.so.9]", of any kind of processor.
  for (const std::string& line : lines_of(output_of({"readelf", "-d", file.string()}))) {
    const std::size_t begin = line.find('['), end = line.find(']');
    if (line.find("(NEEDED)") != std::string::npos && begin < end && end != std::string::npos)
      names.insert(line.substr(begin + 1, end - begin - 1));
  }
  return names;
}

/// The paths at which the loader of this machine finds the libraries of a file, including their libraries.
std::map<std::string, fs::path> found_by_loader(const fs::path& file) {
  std::map<std::string, fs::path> found;
  for (const std::string& line : lines_of(output_of({"ldd", file.string()}))) {
    std::istringstream words(line);
    std::string name, arrow, path;
    if (words >> name >> arrow >> path && arrow == "=>" && path.starts_with('/')) found.emplace(name, path);
  }
  return found;
}

struct Owner {
  std::string package, version;
};

/// A file of no package: then `package` is empty.
Owner owner_of(const std::string& pattern) {
  const Exit found = capture({"env", "LC_ALL=C", "dpkg-query", "-S", pattern});
  if (found.code != 0) return {};
  Owner owner;
  for (const std::string& line : lines_of(found.text)) {
    const fs::path file = line.substr(std::min(line.rfind(' ') + 1, line.size()));
    // Not those of other processors: /lib32, and what a cross compiler brings with it.
    const bool is_usual = file.parent_path().filename().string().ends_with("-linux-gnu") &&
                          file.parent_path().parent_path().filename() == "lib";
    if (pattern.starts_with('/') || is_usual) owner.package = line.substr(0, line.find_first_of(":,"));
  }
  if (owner.package.empty()) return owner;
  std::string version = output_of({"dpkg-query", "-W", "-f=${Version}", owner.package});
  version = version.substr(0, version.find('\n'));
  if (const std::size_t revision = version.rfind('-'); revision != std::string::npos)
    version.resize(revision);
  owner.version = version;
  return owner;
}

/// /lib is /usr/lib on a merged system, and dpkg knows only one of the two names.
Owner owner_of_file(const fs::path& file) {
  const fs::path real = fs::canonical(file);
  for (const fs::path& name :
       {file, real, fs::path("/usr" + file.string()), fs::path("/usr" + real.string())})
    if (Owner owner = owner_of(name.string()); !owner.package.empty()) return owner;
  const std::string text = real.string();
  return text.starts_with("/usr/") ? owner_of(text.substr(4)) : Owner{};
}

/// "libc6 (>= 2.34), libfmt9 (>= 9.1.0+ds1)"
std::vector<std::string> split_list(const std::string& list) {
  std::vector<std::string> entries;
  for (std::size_t from = 0; from < list.size();) {
    const std::size_t end = std::min(list.find(", ", from), list.size());
    entries.push_back(list.substr(from, end - from));
    from = end + 2;
  }
  return entries;
}

/// Empty: it is not there, or cannot tell.
std::vector<std::string> from_shlibdeps(const std::vector<fs::path>& files) {
  const ScratchFolder scratch;
  write_file(scratch.path() / "debian/control", "Source: robot\n\nPackage: robot\nArchitecture: any\n");
  std::string line = "cd \"$0\" && LC_ALL=C exec dpkg-shlibdeps -O --ignore-missing-info \"$@\" 2>messages";
  Command command{"sh", "-c", line, scratch.path().string()};
  for (const fs::path& file : files) command.push_back("-e" + fs::absolute(file).string());
  const Exit done = capture(command);
  constexpr std::string_view begin = "shlibs:Depends=";
  for (const std::string& said : done.code == 0 ? lines_of(done.text) : std::vector<std::string>())
    if (said.starts_with(begin)) return split_list(said.substr(begin.size()));
  return {};
}

}  // namespace

std::string architecture_of_this_machine() {
  const std::string text = output_of({"dpkg", "--print-architecture"});
  return text.substr(0, text.find('\n'));
}

LibraryNeeds libraries_of(const std::vector<fs::path>& files, bool is_for_this_machine) {
  std::map<std::string, std::string> packages;
  std::set<fs::path> foreign;
  for (const fs::path& file : files) {
    const auto found = is_for_this_machine ? found_by_loader(file) : std::map<std::string, fs::path>();
    std::vector<std::string> open;
    for (const std::string& name : needed_by(file)) open.push_back(name);
    for (std::set<std::string> seen(open.begin(), open.end()); !open.empty();) {
      const std::string name = open.back();
      open.pop_back();
      if (name.starts_with("ld-linux")) continue;  // of libc6
      const auto place = found.find(name);
      if (is_for_this_machine && place == found.end())
        throw std::runtime_error(
            fmt::format("{} needs {}, which is not on this machine", file.string(), name));
      const Owner owner = is_for_this_machine ? owner_of_file(place->second) : owner_of("*/" + name);
      if (!owner.package.empty()) {
        packages[owner.package] = fmt::format("{} (>= {})", owner.package, owner.version);
        continue;
      }
      if (!is_for_this_machine)
        throw std::runtime_error(
            fmt::format("{} needs {}, and no Debian package of this machine has it", file.string(), name));
      // No package names its further needs.
      if (foreign.insert(place->second).second)
        for (const std::string& next : needed_by(place->second))
          if (seen.insert(next).second) open.push_back(next);
    }
  }
  LibraryNeeds needs{{}, {foreign.begin(), foreign.end()}};
  if (is_for_this_machine && foreign.empty()) needs.packages = from_shlibdeps(files);
  if (needs.packages.empty())
    for (const auto& [name, entry] : packages) needs.packages.push_back(entry);
  return needs;
}

}  // namespace tessera::project
