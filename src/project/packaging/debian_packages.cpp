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

/// The package of the files that match; empty: none has them.
std::string owner_of(const std::string& pattern) {
  const Exit found = capture({"env", "LC_ALL=C", "dpkg-query", "-S", pattern});
  std::string package;
  for (const std::string& line : found.code == 0 ? lines_of(found.text) : std::vector<std::string>()) {
    const fs::path file = line.substr(std::min(line.rfind(' ') + 1, line.size()));
    // Not those of other processors: /lib32, and what a cross compiler brings with it.
    const bool is_usual = file.parent_path().filename().string().ends_with("-linux-gnu") &&
                          file.parent_path().parent_path().filename() == "lib";
    if (pattern.starts_with('/') || is_usual) package = line.substr(0, line.find_first_of(":,"));
  }
  return package;
}

/// /lib is /usr/lib on a merged system, and dpkg knows only one of the two names.
bool has_owner(const fs::path& file) {
  const fs::path real = fs::canonical(file);
  const std::string text = real.string();
  for (const std::string& name : {file.string(), text, "/usr" + file.string(), "/usr" + text,
                                  text.starts_with("/usr/") ? text.substr(4) : text})
    if (!owner_of(name).empty()) return true;
  return false;
}

/// "libfmt9 (>= 9.1.0+ds1)": the version of this machine.
std::string entry_of(const std::string& package) {
  std::string version = output_of({"dpkg-query", "-W", "-f=${Version}", package});
  version = version.substr(0, version.find('\n'));
  if (const std::size_t revision = version.rfind('-'); revision != std::string::npos)
    version.resize(revision);
  return fmt::format("{} (>= {})", package, version);
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

/// The packages and the oldest versions that will do for the libraries of these files.
std::vector<std::string> from_shlibdeps(const std::vector<fs::path>& files) {
  const ScratchFolder scratch;
  write_file(scratch.path() / "debian/control", "Source: robot\n\nPackage: robot\nArchitecture: any\n");
  Command command{"sh", "-c", "cd \"$0\" && LC_ALL=C exec dpkg-shlibdeps -O --ignore-missing-info \"$@\"",
                  scratch.path().string()};
  for (const fs::path& file : files) {
    command.push_back("-l" + fs::absolute(file).parent_path().string());
    command.push_back("-e" + fs::absolute(file).string());
  }
  const Exit done = capture(command);
  constexpr std::string_view begin = "shlibs:Depends=";
  for (const std::string& said : done.code == 0 ? lines_of(done.text) : std::vector<std::string>())
    if (said.starts_with(begin)) return split_list(said.substr(begin.size()));
  throw std::runtime_error(
      "dpkg-shlibdeps, which names the packages of libraries, failed (apt install "
      "dpkg-dev):\n" +
      done.text);
}

/// The packages of these libraries, by their names: of another kind of processor.
std::vector<std::string> from_names(const std::vector<fs::path>& files) {
  std::set<std::string> packages;
  for (const fs::path& file : files)
    for (const std::string& name : needed_by(file)) {
      if (name.starts_with("ld-linux")) continue;  // of libc6
      const std::string package = owner_of("*/" + name);
      if (package.empty())
        throw std::runtime_error(
            fmt::format("{} needs {}, and no Debian package of this machine has it", file.string(), name));
      packages.insert(package);
    }
  std::vector<std::string> entries;
  for (const std::string& package : packages) entries.push_back(entry_of(package));
  return entries;
}

}  // namespace

std::string architecture_of_this_machine() {
  const std::string text = output_of({"dpkg", "--print-architecture"});
  return text.substr(0, text.find('\n'));
}

LibraryNeeds libraries_of(const std::vector<fs::path>& files, bool is_for_this_machine) {
  if (!is_for_this_machine) return {from_names(files), {}};
  std::vector<fs::path> all = files;  // the libraries without a package at the end, with their own needs
  for (std::size_t at = 0; at < all.size(); ++at) {
    const auto found = found_by_loader(all[at]);
    for (const std::string& name : needed_by(all[at])) {
      if (name.starts_with("ld-linux")) continue;  // of libc6
      const auto place = found.find(name);
      if (place == found.end())
        throw std::runtime_error(
            fmt::format("{} needs {}, which is not on this machine", all[at].string(), name));
      if (std::ranges::find(all, place->second) == all.end() && !has_owner(place->second))
        all.push_back(place->second);
    }
  }
  return {from_shlibdeps(all), {all.begin() + static_cast<std::ptrdiff_t>(files.size()), all.end()}};
}

}  // namespace tessera::project
