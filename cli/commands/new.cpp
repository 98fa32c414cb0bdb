#include <fcntl.h>
#include <fmt/core.h>

#include <algorithm>
#include <array>
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
#include <string>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/terminal.hpp"
#include "diagnostics/diagnostics.hpp"
#include "project/files/file_names.hpp"
#include "project/files/files.hpp"
#include "project/files/installation.hpp"
#include "project/files/trust.hpp"
#include "spec/document/names.hpp"

namespace tessera::cli {

using namespace project;

namespace fs = std::filesystem;

namespace {

/// A robot to start from. An example is the template, so the tests run what a new project starts from. Only `empty`
/// has a template of its own.
struct Robot {
  const char* name;      ///< as --robot has it
  const char* folder;    ///< of the installation
  const char* system;    ///< the name of its system, which becomes that of the project
  const char* what;      ///< description
  const char* simulate;  ///< what to expect of the first run
  const char* hint;      ///< what to do next
};

constexpr auto drives =
    "tessera simulate --for 60s --report report   build it, let it drive, see report/index.html";

constexpr std::array robots{
    Robot{"line_follower", "examples/01_line_follower", "line_follower", "a robot that follows a line",
          drives, "Then change src/control.cpp and simulate again."},
    Robot{"rover", "examples/08_rover", "scout", "a rover with a laser that drives about in a room", drives,
          "Then change src/robot/control.cpp and simulate again."},
    Robot{"arm", "examples/09_arm", "arm_bench", "an arm that brings its hand over a wall", drives,
          "Then change src/arm/control.cpp and simulate again."},
    Robot{"depot", "examples/05_depot", "depot", "carriers that share a dock, and an office", drives,
          "Then change src/carrier/control.cpp and simulate again."},
    Robot{"fleet", "examples/07_fleet", "fleet", "fifty rovers with lasers, and their supervisor", drives,
          "Then change src/rover/control.cpp and simulate again."},
    Robot{"empty", "empty", "empty_system", "one agent that does nothing yet",
          "tessera simulate --for 60s                    build it, prove it, run it",
          "Then add an agent: spec.yaml has one in comments. `tessera generate --stubs` adds its functions."},
};

/// Whole words only: the name of a system may be a part of other words.
std::string renamed(const std::string& text, const std::string& from, const std::string& to) {
  return std::regex_replace(text, std::regex("\\b" + from + "\\b"), to);
}

void copy_renamed(const fs::path& from, const fs::path& to, const std::string& old_name,
                  const std::string& name) {
  std::ifstream in(from, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in) throw std::runtime_error("cannot read " + from.string());
  fs::create_directories(to.parent_path());
  std::ofstream out(to, std::ios::binary);
  out << renamed(text, old_name, name);
  out.close();
  if (!out) throw std::runtime_error("cannot write " + to.string());
}

void copy_tree(const fs::path& from, const fs::path& to, const std::string& old_name,
               const std::string& name) {
  for (const auto& entry : fs::recursive_directory_iterator(from))
    if (entry.is_regular_file())
      copy_renamed(entry.path(), to / fs::relative(entry.path(), from), old_name, name);
}

/// A folder beside that of the project, in which the project is made. So no program sees an incomplete
/// project. A failure leaves no files behind and changes no existing ones.
class Workshop {
 public:
  explicit Workshop(const fs::path& project) {
    const fs::path parent = fs::absolute(project).parent_path();
    fs::create_directories(parent);
    std::string pattern = parent / ".tessera-new-XXXXXX";
    if (mkdtemp(pattern.data()) == nullptr)
      throw std::runtime_error(fmt::format("cannot write to {}: {}", parent.string(), std::strerror(errno)));
    folder_ = pattern;
    fs::create_directory(folder_ / "project");  // with the default mode
  }
  ~Workshop() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  Workshop(const Workshop&) = delete;
  Workshop& operator=(const Workshop&) = delete;
  [[nodiscard]] fs::path folder() const { return folder_ / "project"; }
  /// false: a file with that name exists meanwhile.
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

/// Copies specification, code, tests and models. The rest of the example, such as its README, is not for a
/// project.
void copy_example(const fs::path& example, const fs::path& made, const std::string& system,
                  const std::string& name) {
  for (const auto& entry : fs::directory_iterator(example)) {
    const std::string part = entry.path().filename();
    if (part == "src" || part == "test")
      copy_tree(entry.path(), made / part, system, name);
    else if (part == file_names::specification || entry.path().extension() == ".xml")
      copy_renamed(entry.path(), made / part, system, name);
  }
}

/// Copies the world and the floor that come with Tessera into the project.
void copy_shared_world(const fs::path& share, const fs::path& made) {
  project::copy_whole(share / "worlds/line_world.xml", made / "line_world.xml");
  project::copy_whole(share / "tracks/oval.png", made / "oval.png");
}

int new_command(const std::string& given, const std::string& wanted) {
  const fs::path folder(given);
  const std::string name = folder.filename().string();
  if (!std::regex_match(name, std::regex("[a-z][a-z0-9_]*")))
    return complain(fmt::format("'{}' cannot name a system: use lower-case letters, digits and _", name)),
           usage;
  if (!may_name_a_system(name)) return usage;
  if (fs::exists(fs::symlink_status(folder)))
    return complain(fmt::format("{} exists already", folder.string()));

  const Installation installation = Installation::find();
  const Robot& robot = *std::ranges::find(robots, wanted, &Robot::name);
  const Workshop workshop(folder);
  const fs::path made = workshop.folder();
  copy_example(installation.share / robot.folder, made, robot.system, name);
  copy_tree(installation.share / "project", made, robots.front().system, name);
  fs::rename(made / "gitignore", made / ".gitignore");
  if (&robot == &robots.front()) copy_shared_world(installation.share, made);
  if (!workshop.move_to(folder)) return complain(fmt::format("{} exists already", folder.string()));
  static_cast<void>(trust(fs::absolute(folder)));
  fmt::print(
      "{0} is ready: {1}.\n\n"
      "  cd {0}\n"
      "  {4}\n"
      "  tessera show --svg net.svg                    its Petri net\n"
      "{2}"
      "\n{3}\n",
      folder.string(), robot.what,
      fs::exists(folder / "test")
          ? "  tessera test                                  the tests of its transition functions\n"
          : "",
      robot.hint, robot.simulate);
  return ok;
}

}  // namespace

void add_new(CommandLine& app) {
  Subcommand command = app.add("new", "Make a project with a simulated robot that runs at once");
  auto name = std::make_shared<std::string>();
  auto robot = std::make_shared<std::string>(robots.front().name);
  std::vector<std::string> names;
  for (const Robot& one : robots) names.emplace_back(one.name);
  command.option("name", *name, "Folder to make; its last part names the system").required();
  command
      .option("--robot", *robot,
              "The robot to begin with: one that follows a line, a rover with a laser, an arm over a wall, "
              "two rovers that share a crossing, fifty rovers with a supervisor, or an empty system")
      .one_of(names)
      .shows_default();
  command.footer(
      "Examples:\n"
      "  tessera new rover && cd rover && tessera simulate --for 60s\n"
      "  tessera new depot --robot fleet");
  command.runs([name, robot] { return new_command(*name, *robot); });
}

}  // namespace tessera::cli
