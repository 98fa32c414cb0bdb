#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "codegen/codegen.hpp"
#include "project/build/transition_functions.hpp"
#include "project/verification/pipeline.hpp"

/// The folder of a user's project: specification, src/ and test/, which are the user's, and a state folder
/// (src/project/files/state_folder.hpp) with what is generated, built and recorded.
namespace tessera::project {

struct GenerateOptions {
  bool stubs = false;            ///< write functions that are missing into src/
  std::filesystem::path output;  ///< instead of the state folder's `generated`; empty: there
};

/// What generate did.
struct Generated {
  std::filesystem::path folder;
  std::size_t files = 0, written = 0, lines = 0;
  std::vector<std::filesystem::path> created;    ///< the user's files, made or added to
  std::vector<std::filesystem::path> set_aside;  ///< generated files that were edited, where they are now
  std::vector<codegen::Stub> missing;            ///< functions the user has yet to write
  std::vector<codegen::Stub> unclear;            ///< that nobody but the linker can tell
  std::shared_ptr<const TransitionFunctions> functions;
  std::string identity;  ///< of all that the controller is made from, this command included
};

/// Generates the controller of a verified net: changed files only, so that little is compiled again. Writes
/// into src/ only with `stubs`. Throws std::runtime_error when a file cannot be written, and when one that is
/// not Tessera's is in its place (write_generated).
///
/// Threads: one at a time for a project, over all processes (take_build_lock).
[[nodiscard]] Generated generate(const Verified& verified, const GenerateOptions& options = {});

/// Says what generate did to the user's files and what is missing. false: something is missing.
bool report_missing(const Generated& generated, Listener& listener);

struct BuildOptions {
  bool debug = false;  ///< for gdb: -O0 -g in a build folder of its own
  std::string target = "controller";
  VerificationGate gate = {};
  const std::atomic<bool>* stop = nullptr;  ///< true: give up. nullptr: Ctrl-C ends what is compiling
};

/// Builds with CMake. Tells the compiler's complaints, which name the user's files and, for conditions, the
/// lines of the specification; says of functions that are missing or there twice where they are. Returns the
/// program, which no other build replaces, or an empty path.
///
/// Errors:  throws std::runtime_error when the path has a character that CMake cannot handle, or something
///          that is not ours is in the place of the build folder.
/// Threads: as generate.
[[nodiscard]] std::filesystem::path compile(const Specification& specification, const Generated& generated,
                                            const BuildOptions& options, Listener& listener);

/// read_and_verify, generate and compile in one, one at a time for a project; nullopt when anything failed
/// and was said, or `stop` became true. Where nothing can be written in the project, a program that was built there from
/// the same files is taken as it is.
struct Controller {
  std::filesystem::path program;
  Specification specification;
  verify::Report report;
};
[[nodiscard]] std::optional<Controller> make_controller(const std::filesystem::path& given,
                                                        const BuildOptions& options, Listener& listener);

}  // namespace tessera::project
