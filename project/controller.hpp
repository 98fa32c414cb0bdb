#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "codegen/codegen.hpp"
#include "project/walk.hpp"

/// The folder of a user's project: specification, src/, test/, and .tessera/ with what is generated and
/// built.
namespace tessera::project {

struct GenerateOptions {
  bool stubs = false;            ///< append stubs of missing functions to files that exist
  std::filesystem::path output;  ///< instead of .tessera/generated; empty: there
};

/// What generate did.
struct Generated {
  std::filesystem::path folder;
  std::size_t files = 0, written = 0, lines = 0;
  std::vector<std::filesystem::path> created;  ///< the user's files written for the first time or appended to
  std::vector<codegen::Stub> missing;          ///< functions the user has yet to write
};

/// Generates the controller of a verified net: changed files only, so that little is compiled again; the
/// user's files once. Throws std::runtime_error when a file cannot be written.
[[nodiscard]] Generated generate(const Verified& verified, const GenerateOptions& options = {});

/// Says what generate did to the user's files and what is missing. false: something is missing.
bool report_missing(const Generated& generated, Listener& listener);

struct BuildOptions {
  bool debug = false;  ///< for gdb: -O0 -g in a build folder of its own
  std::string target = "controller";
  Gate gate = {};
  const std::atomic<bool>* stop = nullptr;  ///< true: give up. nullptr: Ctrl-C ends what is compiling
};

/// Builds with CMake. Tells the compiler's complaints, which name the user's files and, for conditions, the
/// lines of the specification. Returns the program, or an empty path.
[[nodiscard]] std::filesystem::path compile(const Specification& specification, const Generated& generated,
                                            const BuildOptions& options, Listener& listener);

/// walk, generate and compile in one; an empty program when anything failed and was said.
struct Controller {
  std::filesystem::path program;
  Specification specification;
  verify::Report report;
};
[[nodiscard]] std::optional<Controller> make_controller(const std::filesystem::path& given,
                                                        const BuildOptions& options, Listener& listener);

}  // namespace tessera::project
