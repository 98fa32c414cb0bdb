#pragma once

#include <cstdlib>
#include <string>

#include "command.hpp"

namespace tessera::cli_test {

/// A number from the environment, for runs longer than the usual ones.
[[nodiscard]] inline int given_or(const char* variable, int usual) {
  const char* const given = std::getenv(variable);
  return given == nullptr ? usual : std::atoi(given);
}

/// Three machines in network namespaces (tests/namespaces/machines). Only root may make them.
class Machines : public Command {
 protected:
  /// A copy of a project, named "project", which goes with the test.
  void copy(const fs::path& from) const {
    fs::copy(from, project(), fs::copy_options::recursive);
    fs::remove_all(project() / ".tessera");
  }
  [[nodiscard]] bool build() const {
    const project::Exit built = tessera("generate project --build");
    EXPECT_EQ(built.code, 0) << built.text;
    return built.code == 0;
  }
  /// processes: their names, with commas between them. how: "run MS", "scenarios COUNT SEED".
  [[nodiscard]] project::Exit run_apart(const std::string& processes, const std::string& how) const {
    return shell("'" TESSERA_SOURCE_DIR "/tests/namespaces/machines' project '" + runs().string() + "' '" +
                 processes + "' " + how);
  }
  /// TESSERA_SCENARIO_RUNS names a folder for runs that shall be kept.
  [[nodiscard]] fs::path runs() const {
    const char* const given = std::getenv("TESSERA_SCENARIO_RUNS");
    return given == nullptr ? folder_ / "runs" : fs::path(given);
  }
  [[nodiscard]] fs::path project() const { return folder_ / "project"; }
};

}  // namespace tessera::cli_test
