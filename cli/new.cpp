#include <fmt/core.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <regex>
#include <stdexcept>

#include "cli/commands.hpp"
#include "cli/terminal.hpp"
#include "diagnostics/diagnostics.hpp"
#include "project/installation.hpp"
#include "spec/names.hpp"

namespace tessera::cli {

using namespace project;

namespace fs = std::filesystem;

namespace {

// The example is the template: what a new project starts from is what the tests run.
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

// Left half written, a project would be in the way of the next try.
struct RemoveUnlessDone {
  fs::path folder;
  bool done = false;
  ~RemoveUnlessDone() {
    std::error_code ignored;
    if (!done) fs::remove_all(folder, ignored);
  }
};

/// In the words of `check`, which would refuse the specification that is to be made.
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
  if (fs::exists(folder)) return complain(fmt::format("{} exists already", folder.string()));

  const Installation installation = Installation::find();
  const fs::path example = installation.share / "examples/01_line_follower";
  RemoveUnlessDone guard{folder};
  copy_renamed(example / "spec.yaml", folder / "spec.yaml", name);
  copy_tree(example / "src", folder / "src", name);
  copy_tree(example / "test", folder / "test", name);
  copy_tree(installation.share / "project", folder, name);
  fs::rename(folder / "gitignore", folder / ".gitignore");
  fs::copy_file(installation.share / "worlds/line_world.xml", folder / "line_world.xml");
  fs::copy_file(installation.share / "tracks/oval.png", folder / "oval.png");
  guard.done = true;
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

void add_new(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("new", "Make a project with a simulated robot that runs at once");
  auto name = std::make_shared<std::string>();
  command->add_option("name", *name, "Folder to make; its last part names the system")->required();
  command->footer("Example: tessera new rover && cd rover && tessera simulate --for 60s");
  command->callback([name, &exit_code] { exit_code = new_command(*name); });
}

}  // namespace tessera::cli
