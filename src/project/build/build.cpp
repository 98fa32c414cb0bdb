#include <fmt/core.h>

#include <stdexcept>

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

// Removes ninja's own lines around those of the compiler, because they do not help the user.
std::string compiler_output(const std::string& text) {
  std::string kept;
  std::size_t start = 0;
  while (start < text.size()) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    const std::string line = text.substr(start, end - start);
    start = end + 1;
    const bool noise = line.starts_with("[") || line.starts_with("FAILED:") || line.starts_with("ninja:") ||
                       line.starts_with("-- ") || line.find("/c++ ") != std::string::npos ||
                       line.find("/g++ ") != std::string::npos;
    if (!noise) kept += line + "\n";
  }
  return kept;
}

Exit build_step(const Command& command, const BuildOptions& options,
                const std::function<void(std::string_view)>& each_line) {
  return options.stop == nullptr ? capture(command, each_line)
                                 : capture_apart(command, *options.stop, each_line);
}

constexpr const char* note_name = "made_for.txt";

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

// A build folder contains absolute paths. A folder that was copied with its project, or that another
// installation has made, would build other sources than these.
bool configure(const Specification& specification, const Generated& generated, const fs::path& build,
               const BuildOptions& options, Listener& listener) {
  const fs::path note = build / note_name;
  const std::string package = Installation::find().cmake_package.string();
  const std::string made_for =
      fmt::format("{}\n{}\n{}\n", specification.project.string(), generated.folder.string(), package);
  if (fs::exists(build / "build.ninja") && content_of(note) == made_for) return true;
  remove_build(build);
  write_file(note, "nothing yet\n");
  Step step(listener, "configuring");
  const Exit done = build_step({"cmake", "-S", generated.folder.string(), "-B", build.string(), "-G", "Ninja",
                                fmt::format("-DCMAKE_BUILD_TYPE={}", options.debug ? "Debug" : "Release"),
                                fmt::format("-Dtessera_DIR:PATH={}", package),
                                fmt::format("-DTESSERA_PROJECT_DIR:PATH={}", specification.project.string())},
                               options, [&](std::string_view line) { step.progress(line); });
  if (done.code != 0) listener.say(done.text);
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
  const std::string kind = options.debug ? "debug" : "release";
  const fs::path state = state_folder(specification.project);
  const fs::path build = state / "build" / kind;
  for (const fs::path& path :
       {specification.project, generated.folder, build, Installation::find().cmake_package})
    check_path_for_cmake(path);
  if (!configure(specification, generated, build, options, listener)) return {};
  Step step(listener, "compiling");
  const Exit done = build_step({"cmake", "--build", build.string(), "--target", options.target}, options,
                               [&](std::string_view line) {
                                 if (const std::string count = ninja_progress(line); !count.empty())
                                   step.progress(count);
                               });
  if (done.code != 0) {
    listener.say(explain_build_errors(compiler_output(done.text), *generated.functions));
    return {};
  }
  link_compile_commands(specification.project, build);
  return keep_program(state, build / options.target, fmt::format("{}-{}", options.target, kind));
}

}  // namespace tessera::project
