#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "../scratch.hpp"
#include "project/files/files.hpp"
#include "project/process/listener.hpp"

namespace tessera::project_test {

namespace fs = std::filesystem;
using project::content_of;

/// The messages.
class Said final : public project::Listener {
 public:
  void say(std::string_view text) override { all += text; }
  void progress(std::string_view /*what*/) override {}
  std::string all;
};

/// A folder of its own for each test.
class Folder : public testing::Test {
 protected:
  Folder()
      : folder_(fs::canonical(fs::temp_directory_path()) / ("tessera_project_" + std::to_string(getpid()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~Folder() override { remove_scratch(folder_); }
  void write(const fs::path& file, const std::string& text) const {
    fs::create_directories((folder_ / file).parent_path());
    std::ofstream(folder_ / file, std::ios::binary) << text;
  }
  [[nodiscard]] std::set<std::string> files() const {
    std::set<std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(folder_))
      if (!entry.is_directory() || entry.is_symlink())
        all.insert(entry.path().lexically_relative(folder_).string());
    return all;
  }

  fs::path folder_;
};

}  // namespace tessera::project_test
