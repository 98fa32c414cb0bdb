#include <fcntl.h>
#include <fmt/core.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <regex>
#include <stdexcept>

#include "cli/commands/commands.hpp"
#include "cli/terminal.hpp"
#include "diagnostics/diagnostics.hpp"
#include "project/files/file_names.hpp"
#include "project/files/installation.hpp"
#include "spec/document/names.hpp"

namespace tessera::cli {

using namespace project;

namespace fs = std::filesystem;

namespace {

// The example is the template, so tests run what a new project starts from.
constexpr const char* template_name = "line_follower";

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
}

void copy_renamed(const fs::path& from, const fs::path& to, const std::string& name) {
  std::ifstream in(from, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in) throw std::runtime_error("cannot read " + from.string());
  replace_all(text, template_name, name);
  fs::create_directories(to.parent_path());
  std::ofstream out(to, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw std::runtime_error("cannot write " + to.string());
}

void copy_tree(const fs::path& from, const fs::path& to, const std::string& name) {
  for (const auto& entry : fs::recursive_directory_iterator(from))
    if (entry.is_regular_file()) copy_renamed(entry.path(), to / fs::relative(entry.path(), from), name);
}

/// A folder beside that of the project, where the project is made. Nobody sees an incomplete project. A
/// failure leaves no files behind and changes no existing ones.
class Workshop {
 public:
  explicit Workshop(const fs::path& project) {
    const fs::path parent = fs::absolute(project).parent_path();
    fs::create_directories(parent);
    std::string pattern = parent / ".tessera-new-XXXXXX";
    if (mkdtemp(pattern.data()) == nullptr)
      throw std::runtime_error(fmt::format("cannot write to {}: {}", parent.string(), std::strerror(errno)));
    folder_ = pattern;
    fs::create_directory(folder_ / "project");  // with the usual mode
  }
  ~Workshop() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  Workshop(const Workshop&) = delete;
  Workshop& operator=(const Workshop&) = delete;
  [[nodiscard]] fs::path folder() const { return folder_ / "project"; }
  /// false: something with that name exists by now.
  [[nodiscard]] bool move_to(const fs::path& project) const {
    if (renameat2(AT_FDCWD, folder().c_str(), AT_FDCWD, project.c_str(), RENAME_NOREPLACE) == 0) return true;
    if (errno == EEXIST) return false;
    // The file system does not support this kind of renaming.
    if (errno == EINVAL && !fs::exists(fs::symlink_status(project)) &&
        rename(folder().c_str(), project.c_str()) == 0)
      return true;
    throw std::runtime_error(fmt::format("cannot make {}: {}", project.string(), std::strerror(errno)));
  }

 private:
  fs::path folder_;
};

/// Reports a bad name like `check`, which would reject the new specification.
bool may_name_a_system(const std::string& name) {
  diagnostics::Diagnostics found("", "");
  if (spec::check_system_name(name, {}, found)) return true;
  for (const diagnostics::Diagnostic& one : found.sorted())
    complain(fmt::format("{}; {}", one.message, one.hint));
  return false;
}

int new_command(const std::string& given) {
  const fs::path folder(given);
  const std::string name = folder.filename().string();
  if (!std::regex_match(name, std::regex("[a-z][a-z0-9_]*")))
    return complain(fmt::format("'{}' cannot name a system: use lower-case letters, digits and _", name)),
           usage;
  if (!may_name_a_system(name)) return usage;
  if (fs::exists(fs::symlink_status(folder)))
    return complain(fmt::format("{} exists already", folder.string()));

  const Installation installation = Installation::find();
  const fs::path example = installation.share / "examples/01_line_follower";
  const Workshop workshop(folder);
  const fs::path made = workshop.folder();
  copy_renamed(example / file_names::specification, made / file_names::specification, name);
  copy_tree(example / "src", made / "src", name);
  copy_tree(example / "test", made / "test", name);
  copy_tree(installation.share / "project", made, name);
  fs::rename(made / "gitignore", made / ".gitignore");
  fs::copy_file(installation.share / "worlds/line_world.xml", made / "line_world.xml");
  fs::copy_file(installation.share / "tracks/oval.png", made / "oval.png");
  if (!workshop.move_to(folder)) return complain(fmt::format("{} exists already", folder.string()));
  fmt::print(
      "{0} is ready: a robot that follows a line.\n\n"
      "  cd {0}\n"
      "  tessera simulate --for 60s --report report   build it, let it drive, see report/index.html\n"
      "  tessera show --svg net.svg                    its Petri net\n"
      "  tessera test                                  the tests of its transition functions\n\n"
      "Then change src/control.cpp and simulate again.\n",
      folder.string());
  return ok;
}

}  // namespace

void add_new(CommandLine& app, int& exit_code) {
  Subcommand command = app.add("new", "Make a project with a simulated robot that runs at once");
  auto name = std::make_shared<std::string>();
  command.option("name", *name, "Folder to make; its last part names the system").required();
  command.footer("Example: tessera new rover && cd rover && tessera simulate --for 60s");
  command.callback([name, &exit_code] { exit_code = new_command(*name); });
}

}  // namespace tessera::cli
