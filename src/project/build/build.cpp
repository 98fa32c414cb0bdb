#include <fmt/core.h>

#include <stdexcept>

#include "project/build/build_errors.hpp"
#include "project/build/cmake_errors.hpp"
#include "project/build/controller.hpp"
#include "project/build/programs.hpp"
#include "project/files/cmake_path_check.hpp"
#include "project/files/files.hpp"
#include "project/files/installation.hpp"
#include "project/files/state_folder.hpp"
#include "project/process/listener.hpp"
#include "project/process/process.hpp"

namespace tessera::project {

namespace fs = std::filesystem;

namespace {

// "[3/9] Building ..." of ninja becomes "3/9".
std::string ninja_progress(std::string_view line) {
  const std::size_t end = line.find(']');
  if (line.empty() || line.front() != '[' || end == std::string_view::npos) return {};
  return std::string(line.substr(1, end - 1));
}

/// Collects the whole output, of which the listener gets a part.
struct CollectedOutput {
  std::string text;
  void take(std::string_view line) { text += std::string(line) + "\n"; }
};

/// In English, so that the messages of the compiler can be explained.
Command in_english(Command command) {
  command.insert(command.begin(), {"cmake", "-E", "env", "LC_ALL=C.UTF-8"});
  return command;
}

Exit build_step(const Command& command, const BuildOptions& options,
                const std::function<void(std::string_view)>& each_line) {
  if (options.stop != nullptr) return capture_apart(command, *options.stop, each_line);
  Exit done = capture(command, each_line);
  if (done.signal != 0) throw Interrupted(done.signal, "the build was interrupted; nothing was started");
  return done;
}

constexpr const char* note_name = "made_for.txt";
constexpr const char* log_name = "compiler.log";  // the output of the last build that failed

bool was_stopped(const BuildOptions& options) { return options.stop != nullptr && *options.stop; }

/// Removes a build folder that Tessera has made, which a note in it proves.
void remove_build(const fs::path& build) {
  std::error_code ignored;
  if (!fs::exists(fs::symlink_status(build, ignored))) return;
  const bool is_ours = fs::exists(build / note_name) ||
                       content_of(build / "CMakeCache.txt").find("TESSERA_PROJECT_DIR") != std::string::npos;
  const bool is_folder = fs::symlink_status(build).type() == fs::file_type::directory;
  if (!is_folder || (!is_ours && !fs::is_empty(build)))
    throw std::runtime_error(build.string() +
                             " is in the way: Tessera builds there, and has not made it; move it away");
  fs::remove_all(build);
}

fs::path package_for(const BuildOptions& options) {
  return options.processor ? options.processor->cmake_package() : Installation::find().cmake_package;
}

std::string explain_cmake(const std::string& output, const fs::path& project, const fs::path& log) {
  const std::string of_the_user = explain_cmake_errors(output, project);
  return of_the_user.empty() ? explain_configuration(output, log) : of_the_user;
}

// A build folder contains absolute paths. A folder that was copied with its project, or that another
// installation has made, would build other sources than these.
bool configure(const Specification& specification, const Generated& generated, const fs::path& build,
               const BuildOptions& options, Listener& listener) {
  const fs::path note = build / note_name;
  const fs::path package = package_for(options);
  // CMake follows changes of the user's file, but does not see that there is one now.
  const bool has_user_file = fs::exists(specification.project / user_build_file);
  const std::string made_for =
      fmt::format("{}\n{}\n{}\n{}", specification.project.string(), generated.folder.string(),
                  package.string(), has_user_file ? fmt::format("with {}\n", user_build_file) : "");
  if (fs::exists(build / "build.ninja") && content_of(note) == made_for) return true;
  remove_build(build);
  write_file(note, "nothing yet\n");
  Step step(listener, "configuring");
  Command command{
      "cmake",
      "-S",
      generated.folder.string(),
      "-B",
      build.string(),
      "-G",
      "Ninja",
      fmt::format("-DCMAKE_BUILD_TYPE={}", options.debug || options.coverage ? "Debug" : "Release"),
      fmt::format("-DTESSERA_COVERAGE={}", options.coverage ? "ON" : "OFF"),
      fmt::format("-Dtessera_DIR:PATH={}", package.string()),
      fmt::format("-DTESSERA_PROJECT_DIR:PATH={}", specification.project.string())};
  if (options.processor)
    command.push_back(fmt::format("-DCMAKE_TOOLCHAIN_FILE={}", (package / "toolchain.cmake").string()));
  CollectedOutput output;
  const Exit done = build_step(in_english(std::move(command)), options, [&](std::string_view line) {
    output.take(line);
    step.progress(line);
  });
  if (done.code != 0 && !was_stopped(options)) {
    write_file(build / log_name, output.text);
    listener.say(explain_cmake(output.text, specification.project, build / log_name));
  }
  if (done.code == 0) write_file(note, made_for);
  return done.code == 0;
}

/// Editors look for this file in the root of a project. An existing file, or a link to another
/// place, belongs to the user.
void link_compile_commands(const fs::path& project, const fs::path& build) {
  const fs::path link = project / "compile_commands.json", target = build / "compile_commands.json";
  std::error_code ignored;
  if (build.parent_path().parent_path() != own_folder(project)) return;
  const fs::file_type there = fs::symlink_status(link, ignored).type();
  if (there == fs::file_type::symlink) {
    if (!fs::read_symlink(link, ignored).string().starts_with(".tessera/")) return;
    fs::remove(link, ignored);
  } else if (there != fs::file_type::not_found) {
    return;
  }
  fs::create_symlink(fs::relative(target, project), link, ignored);
}

}  // namespace

fs::path compile(const Specification& specification, const Generated& generated, const BuildOptions& options,
                 Listener& listener) {
  const std::string kind = options.kind();
  const fs::path state = state_folder(specification.project);
  const fs::path build = state / "build" / kind;
  for (const fs::path& path : {specification.project, generated.folder, build, package_for(options)})
    check_path_for_cmake(path);
  if (!configure(specification, generated, build, options, listener)) return {};
  Step step(listener, "compiling");
  CollectedOutput output;
  const Exit done = build_step(in_english({"cmake", "--build", build.string(), "--target", options.target}),
                               options, [&](std::string_view line) {
                                 output.take(line);
                                 if (const std::string count = ninja_progress(line); !count.empty())
                                   step.progress(count);
                               });
  if (done.code != 0) {
    if (was_stopped(options)) return {};
    write_file(build / log_name, output.text);
    // A change of the user's project.cmake makes ninja ask CMake again.
    const bool is_cmake = output.text.find("CMake Error") != std::string::npos;
    listener.say(is_cmake ? explain_cmake(output.text, specification.project, build / log_name)
                          : explain_build(output.text, {specification, *generated.functions,
                                                        generated.source_lines, build / log_name}));
    return {};
  }
  if (!options.processor) link_compile_commands(specification.project, build);
  return keep_program(state, build / options.target, fmt::format("{}-{}", options.target, kind));
}

}  // namespace tessera::project
