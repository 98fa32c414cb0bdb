#include "project/build/controller.hpp"

#include <fmt/core.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "project/build/cmake_errors.hpp"
#include "project/build/generated_folder.hpp"
#include "project/files/cmake_path_check.hpp"
#include "project/files/files.hpp"
#include "project/files/installation.hpp"
#include "project/files/lock_file.hpp"
#include "project/files/state_folder.hpp"
#include "project/files/trust.hpp"
#include "project/process/listener.hpp"

namespace tessera::project {

namespace fs = std::filesystem;

namespace {

void user_files(const Specification& specification, const GenerateOptions& options, Generated& result) {
  TransitionFunctions functions(specification.project, codegen::stubs(specification.model), options.sources);
  for (const codegen::Stub& stub : functions.wanted()) {
    const TransitionFunctions::Presence presence = functions.presence(stub);
    if (presence == TransitionFunctions::Presence::unclear) result.unclear.push_back(stub);
    if (presence != TransitionFunctions::Presence::missing) continue;
    if (!options.stubs) {
      result.missing.push_back(stub);
      continue;
    }
    fs::path file = functions.add(stub);
    if (std::ranges::find(result.created, file) == result.created.end())
      result.created.push_back(std::move(file));
  }
  result.functions = std::make_shared<const TransitionFunctions>(std::move(functions));
}

/// The same for the same text of specification and sources, and the same command.
std::string identity_of(const std::vector<codegen::File>& files, const fs::path& project,
                        const TransitionFunctions& functions) {
  struct stat command {};
  stat("/proc/self/exe", &command);
  std::string all = fmt::format("{} {}\n", command.st_size, command.st_mtim.tv_sec);
  for (const codegen::File& file : files) all += file.path + " " + hash_of(file.text) + "\n";
  all += hash_of(content_of(project / user_build_file)) + "\n";
  return hash_of(all + functions.identity());
}

/// Code for another folder is compiled by other builds, which show the messages of the compiler as they are.
std::vector<codegen::File> files_of(const Verified& verified, codegen::Lines lines) {
  const Specification& specification = verified.specification;
  return codegen::generate(verified.net, specification.model, specification.file.string(), lines);
}

/// The build compiles all sources of these folders: generated ones would be there twice.
void check_output(const fs::path& output, const fs::path& project) {
  for (const char* const folder : {"src", "test"})
    if (contains(project / folder, output))
      throw std::runtime_error(
          fmt::format("{} is in the project's folder {}/, whose sources are yours, so nothing is generated "
                      "there: choose a "
                      "folder elsewhere, such as --output generated",
                      output.string(), folder));
}

}  // namespace

Generated generate(const Verified& verified, const GenerateOptions& options) {
  const Specification& specification = verified.specification;
  const bool is_elsewhere = !options.output.empty();
  if (is_elsewhere) check_output(options.output, specification.project);
  Generated result;
  result.folder = is_elsewhere ? fs::absolute(options.output).lexically_normal()
                               : state_folder(specification.project) / "generated";
  const std::vector<codegen::File> files =
      files_of(verified, is_elsewhere ? codegen::Lines::marked : codegen::Lines::listed);
  GeneratedFiles outcome =
      write_generated(result.folder, files, is_elsewhere ? Unlisted::foreign : Unlisted::by_heading);
  result.files = files.size();
  result.written = outcome.written;
  result.set_aside = std::move(outcome.set_aside);
  for (const codegen::File& file : files) {
    result.lines += static_cast<std::size_t>(std::count(file.text.begin(), file.text.end(), '\n'));
    if (!file.lines.empty()) result.source_lines[result.folder / file.path] = file.lines;
  }
  user_files(specification, options, result);
  result.identity = identity_of(files, specification.project, *result.functions);
  return result;
}

bool report_missing(const Generated& generated, Listener& listener) {
  for (const fs::path& file : generated.set_aside)
    listener.warn(fmt::format("a generated file was edited; the edited one is {} now", file.string()));
  for (const fs::path& file : generated.created) listener.say(fmt::format("wrote {}\n", file.string()));
  for (const codegen::Stub& stub : generated.missing) listener.say(missing_text(stub, *generated.functions));
  return generated.missing.empty();
}

namespace {

/// The file with the identity of the last program of that kind and its name in `programs`.
fs::path note_of(const fs::path& state, const BuildOptions& options) {
  return state / "programs" / fmt::format("{}-{}.built", options.target, options.kind());
}

void note_built(const fs::path& state, const BuildOptions& options, const std::string& identity,
                const fs::path& program) {
  write_file(note_of(state, options), identity + " " + program.filename().string() + "\n");
}

/// The program that was built earlier, for a project that cannot be written to. Empty: there is none, or
/// it was built from other files.
fs::path built_before(const Verified& verified, const BuildOptions& options) {
  const fs::path own = own_folder(verified.specification.project);
  const std::string note = content_of(note_of(own, options));
  const std::size_t space = note.find(' ');
  if (space == std::string::npos || options.target != "controller") return {};
  const fs::path& project = verified.specification.project;
  const TransitionFunctions functions(project, codegen::stubs(verified.specification.model));
  if (note.substr(0, space) != identity_of(files_of(verified, codegen::Lines::listed), project, functions))
    return {};
  fs::path program = own / "programs" / note.substr(space + 1, note.find('\n') - space - 1);
  return fs::is_regular_file(program) ? program : fs::path();
}

fs::path make_program(const Verified& verified, const fs::path& state, const BuildOptions& options,
                      Listener& listener) {
  const std::optional<LockFile> lock = take_build_lock(state, listener, options.stop);
  if (!lock) return {};
  const Generated generated = generate(verified);
  if (!report_missing(generated, listener)) return {};
  fs::path program = compile(verified.specification, generated, options, listener);
  if (program.empty())
    listener.complain(options.target == "tests" ? "the tests were not built"
                                                : "the controller was not built");
  else
    note_built(state, options, generated.identity, program);
  return program;
}

}  // namespace

std::optional<Controller> make_controller(const fs::path& given, const BuildOptions& options,
                                          Listener& listener) {
  std::optional<Verified> verified = run_pipeline(given, options.gate, listener);
  if (!verified) return std::nullopt;
  const fs::path project = verified->specification.project, state = state_folder(project);
  check_path_for_cmake(project);
  // Its code is executed from here on: who has asked for that is not asked again.
  static_cast<void>(trust(project));
  fs::path program;
  if (state != own_folder(project)) program = built_before(*verified, options);
  if (program.empty()) {
    if (state != own_folder(project) && std::getenv("TESSERA_STATE_DIR") == nullptr)
      listener.say(fmt::format("{} cannot be written to; the controller is built in {}\n", project.string(),
                               state.string()));
    program = make_program(*verified, state, options, listener);
  }
  if (program.empty()) return std::nullopt;
  return Controller{program, std::move(verified->specification), verified->net.report()};
}

}  // namespace tessera::project
