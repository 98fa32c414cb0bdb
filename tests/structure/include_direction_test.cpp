#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>

namespace {

namespace fs = std::filesystem;
using Rooms = std::set<std::string>;

// The table of docs/architecture.md; a room may always include itself.
const std::map<std::string, Rooms> allowed{
    {"diagnostics", {}},
    {"spec", {"diagnostics"}},
    {"net", {"diagnostics"}},
    {"explore", {"net", "diagnostics", "tessera"}},
    {"siphons", {"net", "explore"}},
    {"reduce", {"net"}},
    {"layers", {"spec", "net", "diagnostics"}},
    {"verify", {"net", "explore", "siphons", "reduce", "diagnostics", "tessera"}},
    {"drawing", {"net", "spec", "layers", "diagnostics"}},
    {"codegen", {"spec", "verify", "net"}},
    {"runtime", {"tessera"}},
    {"sim", {"tessera"}},
    {"replay", {"net", "tessera"}},
    {"report", {"sim", "replay", "tessera"}},
    {"project", {"diagnostics", "spec", "net", "layers", "explore", "verify", "codegen", "sim", "tessera"}},
    {"server",
     {"diagnostics", "spec", "net", "layers", "explore", "verify", "drawing", "replay", "sim", "project",
      "tessera"}},
    {"cli",
     {"diagnostics", "spec", "net", "layers", "explore", "verify", "drawing", "codegen", "sim", "replay",
      "report", "project", "server", "tessera"}},
};

// "tessera/..." are the runtime's public headers. Those that the checker shares with the runtime:
bool only_shared_definition(const std::string& room, const std::string& include) {
  if (room == "verify") return include == "tessera/net_hash.hpp";
  if (room == "project") return include == "tessera/signals.hpp" || include == "tessera/net_hash.hpp";
  return room != "explore" || include == "tessera/firing.hpp";
}

std::string room_of(const fs::path& relative) {
  auto part = relative.begin();
  if (*part == "src" || *part == "studio") ++part;
  return part->string();
}

TEST(Structure, RoomsIncludeOnlyRoomsBeforeThem) {
  const fs::path root = TESSERA_SOURCE_DIR;
  const std::regex include_line("^\\s*#include \"([^\"]+)\"");
  std::size_t files = 0;
  for (const char* folder : {"src", "runtime", "sim", "replay", "report", "project", "studio/server", "cli"})
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const fs::path extension = entry.path().extension();
      if (extension != ".cpp" && extension != ".hpp") continue;
      ++files;
      const fs::path relative = fs::relative(entry.path(), root);
      const std::string room = room_of(relative);
      ASSERT_TRUE(allowed.contains(room)) << "a room that docs/architecture.md does not know: " << room;
      std::ifstream stream(entry.path());
      std::smatch match;
      for (std::string line; std::getline(stream, line);) {
        if (!std::regex_search(line, match, include_line)) continue;
        const std::string include = match[1];
        if (include.find('/') == std::string::npos) continue;  // of the same folder
        const std::string target = include.substr(0, include.find('/'));
        EXPECT_TRUE(target == room || allowed.at(room).contains(target))
            << relative << " includes " << include;
        if (target == "tessera") {
          EXPECT_TRUE(only_shared_definition(room, include)) << relative << " includes " << include;
        }
      }
    }
  EXPECT_GT(files, 50U);
}

}  // namespace
