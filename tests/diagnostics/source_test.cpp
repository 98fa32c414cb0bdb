#include "diagnostics/source.hpp"

#include <gtest/gtest.h>
#include <sys/fsuid.h>

#include <fstream>

namespace tessera::diagnostics {
namespace {

namespace fs = std::filesystem;

/// A folder of its own for every test.
class Load : public testing::Test {
 protected:
  Load() {
    folder_ = fs::path(TESSERA_BINARY_DIR) / "load_test" /
              testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~Load() override { fs::remove_all(folder_); }

  [[nodiscard]] fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  static std::string only_message(const Diagnostics& diagnostics) {
    const auto all = diagnostics.sorted();
    return all.size() == 1 && all[0].code == "E001" ? all[0].message + "|" + all[0].hint : "";
  }

  fs::path folder_;
};

TEST_F(Load, KeepsEveryByte) {
  const std::string text("a\r\n\0b\xff", 6);
  const Diagnostics loaded = load(write("a.yaml", text));
  EXPECT_FALSE(loaded.has_errors());
  EXPECT_EQ(loaded.text(), text);
  EXPECT_EQ(loaded.file(), (folder_ / "a.yaml").string());
}

TEST_F(Load, AMissingFileIsNamedWithItsNeighbour) {
  static_cast<void>(write("spec.yaml", "x"));
  EXPECT_EQ(only_message(load(folder_ / "sepc.yaml")), "no such file|did you mean 'spec.yaml'?");
  EXPECT_EQ(only_message(load(folder_ / "no" / "such" / "folder.yaml")), "no such file|");
}

TEST_F(Load, AFolderWithoutASpecificationSaysWhatItHas) {
  EXPECT_EQ(only_message(load(folder_)),
            "this is a folder without a spec.yaml|`tessera new NAME` makes a project");
  const std::string arm = write("arm.yaml", "x").string(), rover = write("rover.yml", "x").string();
  EXPECT_EQ(only_message(load(folder_)),
            "this is a folder without a spec.yaml|name the file: " + arm + ", " + rover);
}

TEST_F(Load, AFileAboveTheLimitIsRefused) {
  const fs::path path = write("large.yaml", "");
  fs::resize_file(path, largest_source + 1);
  EXPECT_EQ(only_message(load(path)), "the file is larger than 64 MB|");
}

TEST_F(Load, AnEndlessDeviceIsRefused) {
  EXPECT_EQ(only_message(load("/dev/zero")), "the file is larger than 64 MB|");
}

TEST_F(Load, AnUnreadableFileIsRefused) {
  const fs::path path = write("secret.yaml", "x");
  fs::permissions(path, fs::perms::none);
  const uid_t nobody = 65534;  // root may read everything
  const int before = setfsuid(nobody);
  EXPECT_EQ(only_message(load(path)), "the file cannot be opened (Permission denied)|");
  setfsuid(static_cast<uid_t>(before));
}

}  // namespace
}  // namespace tessera::diagnostics
