#include <unistd.h>

#include "command.hpp"

namespace tessera::cli_test {

using Install = Command;

TEST_F(Install, PrefixWorksWhereverItIsMoved) {
  const project::Exit installed =
      shell("cmake --install '" TESSERA_BINARY_DIR "' --prefix '" + folder_.string() + "/here'");
  ASSERT_EQ(installed.code, 0) << installed.text;
  fs::rename(folder_ / "here", folder_ / "there");
  for (const char* file : {"LICENSE", "THIRD_PARTY.md"})
    EXPECT_TRUE(fs::exists(folder_ / "there/share/doc/tessera" / file)) << file;
  const project::Exit made = shell("there/bin/tessera new rover");
  ASSERT_EQ(made.code, 0) << made.text;
  const project::Exit run = shell("there/bin/tessera simulate rover --for 5s --json run.json");
  ASSERT_EQ(run.code, 0) << run.text;
  EXPECT_GT(nlohmann::json::parse(content_of(folder_ / "run.json")).at("laps"), 0.02);
  const std::string cache = content_of(folder_ / "rover/.tessera/build/release/CMakeCache.txt");
  EXPECT_NE(cache.find((folder_ / "there/lib/cmake/tessera").string()), std::string::npos);
}

}  // namespace tessera::cli_test
