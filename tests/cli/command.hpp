#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "../scratch.hpp"
#include "project/files/files.hpp"
#include "project/files/state_folder.hpp"
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

/// One process at a time makes the projects in this folder.
class BuildOnce {
 public:
  explicit BuildOnce(const fs::path& folder) {
    fs::create_directories(folder);
    descriptor_ = open((folder / "lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600);
    while (flock(descriptor_, LOCK_EX) != 0 && errno == EINTR) continue;
  }
  ~BuildOnce() { close(descriptor_); }
  BuildOnce(const BuildOnce&) = delete;
  BuildOnce& operator=(const BuildOnce&) = delete;

 private:
  int descriptor_ = -1;
};

/// Copies the files that differ and removes those that are gone, so that no file is compiled twice.
inline void update(const fs::path& from, const fs::path& to) {
  fs::create_directories(to);
  for (const auto& entry : fs::directory_iterator(to)) {
    const std::string name = entry.path().filename().string();
    if (name != ".tessera" && name != "compile_commands.json" && !fs::exists(from / name))
      fs::remove_all(entry.path());
  }
  for (const auto& entry : fs::directory_iterator(from)) {
    const fs::path copy = to / entry.path().filename();
    if (copy.filename() == ".tessera") continue;
    if (entry.is_directory())
      update(entry.path(), copy);
    else if (!fs::exists(copy) || content_of(copy) != content_of(entry.path()))
      fs::copy_file(entry.path(), copy, fs::copy_options::overwrite_existing);
  }
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
    unsetenv("TESSERA_STATE_DIR");  // built_example
    remove_scratch(folder_);
    fs::remove_all(user_);
  }

  /// The output of the command, on both streams, and its exit code.
  project::Exit tessera(const std::string& arguments) const {
    return shell(std::string(TESSERA_BINARY_DIR) + "/tessera " + arguments);
  }
  project::Exit shell(const std::string& line) const {
    return project::capture({"sh", "-c", "cd \"$0\" && " + line, folder_.string()});
  }
  /// Runs it with `--json FILE`, expects this exit code and gives the JSON.
  nlohmann::json json(const std::string& arguments, int code = 0) const {
    const project::Exit done = tessera(arguments + " --json out.json");
    EXPECT_EQ(done.code, code) << arguments << "\n" << done.text;
    return nlohmann::json::parse(content_of(folder_ / "out.json"), nullptr, false);
  }
  /// A copy of an example, since building in the source tree would disturb it.
  fs::path example(const std::string& name) const {
    fs::copy(fs::path(TESSERA_SOURCE_DIR) / "examples" / name, folder_ / name, fs::copy_options::recursive);
    fs::remove_all(folder_ / name / ".tessera");
    return folder_ / name;
  }

  /// The same with its controller, which is built once for all tests, in the build tree. Its runs are in `.tessera` as
  /// usual. For tests that do not change `src`, since it is a link; a changed specification is built here.
  fs::path built_example(const std::string& name) const {
    const fs::path shared = fs::path(TESSERA_BINARY_DIR) / "tests/examples" / name;
    const fs::path project = example(name), own = project / ".tessera";
    fs::create_directories(own / "programs");
    {
      const BuildOnce lock(shared.parent_path());
      update(project, shared);
      // Without a change, this compiles nothing.
      const project::Exit built = project::capture(
          {std::string(TESSERA_BINARY_DIR) + "/tessera", "generate", shared.string(), "--build"});
      EXPECT_EQ(built.code, 0) << built.text;
      for (const auto& program : fs::directory_iterator(shared / ".tessera/programs"))
        fs::copy(program.path(), own / "programs" / program.path().filename());
    }
    // Tessera uses a program that was built of the same sources, if it keeps its state elsewhere.
    fs::remove_all(project / "src");
    fs::create_directory_symlink(shared / "src", project / "src");
    setenv("TESSERA_STATE_DIR", (folder_ / "state").c_str(), 1);
    fs::create_directories(folder_ / "state");
    fs::create_directory_symlink(own, project::state_folder(project));
    return project;
  }

  fs::path folder_;
  fs::path user_ = folder_.string() + "_user";
};

}  // namespace tessera::cli_test
