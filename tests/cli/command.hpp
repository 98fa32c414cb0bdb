#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "project/files/files.hpp"
#include "project/process/process.hpp"

namespace tessera::cli_test {

namespace fs = std::filesystem;

using project::content_of;

inline void write(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

inline void replace(const fs::path& file, const std::string& from, const std::string& to) {
  std::string text = content_of(file);
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << file << " has no '" << from << "'";
  write(file, text.replace(at, from.size(), to));
}

/// Runs the built command in a folder of its own that goes with the test.
class Command : public testing::Test {
 protected:
  Command() : folder_(fs::temp_directory_path() / fs::path("tessera_cli_" + std::to_string(getpid()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    // A test has nothing to do with what Tessera keeps for the user who runs it.
    setenv("XDG_STATE_HOME", user_.c_str(), 1);
  }
  ~Command() override {
    fs::remove_all(folder_);
    fs::remove_all(user_);
  }

  /// The output of the command, on both streams, and its exit code.
  project::Exit tessera(const std::string& arguments) const {
    return shell(std::string(TESSERA_BINARY_DIR) + "/tessera " + arguments);
  }
  project::Exit shell(const std::string& line) const {
    return project::capture({"sh", "-c", "cd \"$0\" && " + line, folder_.string()});
  }
  /// Runs it with `--json FILE`, expects success and gives the JSON.
  nlohmann::json json(const std::string& arguments) const {
    const project::Exit done = tessera(arguments + " --json out.json");
    EXPECT_EQ(done.code, 0) << arguments << "\n" << done.text;
    return nlohmann::json::parse(content_of(folder_ / "out.json"), nullptr, false);
  }
  /// A copy of an example, since building in the source tree would disturb it.
  fs::path example(const std::string& name) const {
    fs::copy(fs::path(TESSERA_SOURCE_DIR) / "examples" / name, folder_ / name, fs::copy_options::recursive);
    fs::remove_all(folder_ / name / ".tessera");
    return folder_ / name;
  }

  fs::path folder_;
  fs::path user_ = folder_.string() + "_user";
};

}  // namespace tessera::cli_test
