#include "project/files/state_folder.hpp"

#include <array>
#include <cstdlib>

#include "folder.hpp"
#include "project/files/cmake_path_check.hpp"

namespace tessera::project_test {
namespace {

/// Root can write everywhere, but no user can make a path below a file.
class StateFolder : public Folder {
 protected:
  StateFolder() {
    for (const char* name : names) unsetenv(name);
  }
  ~StateFolder() override {
    for (const char* name : names) unsetenv(name);
    if (!home_.empty()) setenv("HOME", home_.c_str(), 1);
  }
  static constexpr std::array names{"TESSERA_STATE_DIR", "STATE_DIRECTORY", "XDG_STATE_HOME"};
  std::string home_ = std::getenv("HOME") == nullptr ? "" : std::getenv("HOME");
};

TEST_F(StateFolder, IsInTheProjectUnlessThatCannotBeWrittenTo) {
  EXPECT_EQ(project::state_folder(folder_), folder_ / ".tessera");
  fs::create_directory(folder_ / ".tessera");
  EXPECT_EQ(project::state_folder(folder_), folder_ / ".tessera");
  const fs::path nowhere = "/proc/rover";  // nothing can be made there
  setenv("HOME", "/home/me", 1);
  const fs::path at_home = project::state_folder(nowhere);
  EXPECT_EQ(at_home.parent_path(), "/home/me/.local/state/tessera");
  EXPECT_TRUE(at_home.filename().string().starts_with("rover-")) << at_home;
  setenv("XDG_STATE_HOME", "/x", 1);
  EXPECT_EQ(project::state_folder(nowhere), "/x/tessera" / at_home.filename());
  setenv("STATE_DIRECTORY", "/var/lib/rover:/var/lib/other", 1);
  EXPECT_EQ(project::state_folder(nowhere), "/var/lib/rover" / at_home.filename());
  setenv("TESSERA_STATE_DIR", "/s", 1);
  EXPECT_EQ(project::state_folder(nowhere), "/s" / at_home.filename());
  EXPECT_EQ(project::state_folder(folder_).parent_path(), "/s");
  EXPECT_NE(project::state_folder("/one/rover"), project::state_folder("/two/rover"));
}

TEST_F(StateFolder, ThatOfTheUserIsInNoProject) {
  setenv("HOME", "/home/me", 1);
  EXPECT_EQ(project::user_folder(), "/home/me/.local/state/tessera");
  setenv("XDG_STATE_HOME", "/x", 1);
  EXPECT_EQ(project::user_folder(), "/x/tessera");
  setenv("STATE_DIRECTORY", "/var/lib/rover:/var/lib/other", 1);
  EXPECT_EQ(project::user_folder(), "/var/lib/rover");
  setenv("TESSERA_STATE_DIR", "/s", 1);
  EXPECT_EQ(project::user_folder(), "/s");
  for (const char* name : names) unsetenv(name);
  unsetenv("HOME");
  EXPECT_FALSE(project::user_folder());
}

TEST_F(StateFolder, ThatThereIsNoPlaceIsSaid) {
  unsetenv("HOME");
  try {
    static_cast<void>(project::state_folder("/proc/rover"));
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/proc/rover cannot be written to"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("TESSERA_STATE_DIR"), std::string::npos);
  }
}

TEST_F(StateFolder, PathsThatCMakeCannotHandleAreNamed) {
  for (const char* good : {"/a b", "/ążź", "/a'b&c#d%e~f(g)h", "/a*b?c", "/a$b", "/a=b:c,d@e!f{g}h+i^j<k>l"})
    EXPECT_NO_THROW(project::check_path_for_cmake(good)) << good;
  for (const char* bad :
       {"/a;b", "/a\"b", "/a\\b", "/a[b", "/a]b", "/a|b", "/a`b", "/a${b}", "/$<a>", "/a\nb"})
    EXPECT_THROW(project::check_path_for_cmake(bad), std::runtime_error) << bad;
}

}  // namespace
}  // namespace tessera::project_test
