#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "codegen/codegen.hpp"
#include "project/build/generated_folder.hpp"
#include "project/build/transition_functions.hpp"
#include "project/verification/pipeline.hpp"

/// The folder of a user's project. The user owns the specification, src/ and test/. A state folder
/// (src/project/files/state_folder.hpp) has the files that are generated, built and recorded.
namespace tessera::project {

struct GenerateOptions {
  bool stubs = false;            ///< adds missing functions to src/
  std::filesystem::path output;  ///< replaces the state folder's `generated`; empty: not replaced
  std::vector<std::filesystem::path> sources = {};  ///< where the functions are; empty: in src/
};

/// The results of generate.
struct Generated {
  std::filesystem::path folder;
  std::size_t files = 0, written = 0, lines = 0;
  std::vector<std::filesystem::path> created;    ///< files of the user that were made or extended
  std::vector<std::filesystem::path> set_aside;  ///< new paths of generated files that were edited
  std::vector<codegen::Stub> missing;            ///< functions that the user has not written yet
  std::vector<codegen::Stub> unclear;            ///< functions that only the linker can judge
  std::shared_ptr<const TransitionFunctions> functions;
  GeneratedLines source_lines;
  std::string identity;  ///< of everything that the controller is made from, including this command
};

/// Generates the controller of a verified net. Only changed files are written, so that little is compiled
/// again. Files in src/ are written only with `stubs`. Throws std::runtime_error if a file cannot be
/// written, or if a file that Tessera did not write is in its place (write_generated).
///
/// Threads: one at a time for a project, over all processes (take_build_lock).
[[nodiscard]] Generated generate(const Verified& verified, const GenerateOptions& options = {});

/// Reports what generate did to the user's files and which functions are missing. false: some are missing.
bool report_missing(const Generated& generated, Listener& listener);

/// Another kind of processor than that of this machine.
struct OtherProcessor {
  std::string architecture;       ///< as Debian calls it: "arm64"
  std::filesystem::path runtime;  ///< where Tessera's runtime for it is installed, with its toolchain
  [[nodiscard]] std::filesystem::path cmake_package() const { return runtime / "lib/cmake/tessera"; }
};

struct BuildOptions {
  bool debug = false;  ///< for gdb: -O0 -g in a separate build folder
  std::string target = "controller";
  VerificationGate gate = {};
  const std::atomic<bool>* stop = nullptr;  ///< true: give up. nullptr: Ctrl-C ends what is compiling
  std::optional<OtherProcessor> processor = std::nullopt;  ///< nullopt: that of this machine
  bool coverage = false;                                   ///< counts which lines of src/ are reached

  /// Builds of different kinds have different folders: "release", "debug", "coverage", "release-arm64".
  [[nodiscard]] std::string kind() const {
    const std::string kind = coverage ? "coverage" : debug ? "debug" : "release";
    return kind + (processor ? "-" + processor->architecture : std::string());
  }
};

/// Builds with CMake. Reports the messages of the compiler, which name the user's files and, for
/// conditions, the lines of the specification. Locates functions that are missing or defined twice. Returns
/// the path of the program, which no other build replaces, or an empty path.
///
/// Errors:  throws std::runtime_error if the path has a character that CMake cannot handle, or if something
///          that Tessera did not make is in the place of the build folder.
/// Threads: as generate.
[[nodiscard]] std::filesystem::path compile(const Specification& specification, const Generated& generated,
                                            const BuildOptions& options, Listener& listener);

/// read_and_verify, generate and compile in one, one at a time for a project; nullopt when a step failed and
/// reported it, or `stop` became true. If the project cannot be written to, a program that was built there
/// from the same files is used as it is. The project is trusted from then on (trust.hpp).
struct Controller {
  std::filesystem::path program;
  Specification specification;
  verify::Report report;
};
[[nodiscard]] std::optional<Controller> make_controller(const std::filesystem::path& given,
                                                        const BuildOptions& options, Listener& listener);

}  // namespace tessera::project
