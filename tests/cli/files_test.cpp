// Files that Tessera writes into, and removes from, the folders of its users: only its own.

#include <sys/wait.h>
#include <unistd.h>

#include <set>
#include <thread>

#include "command.hpp"

namespace tessera::cli_test {

using Files = Command;

/// A subsystem whose functions are quickly written, without a world.
constexpr const char* small =
    "tessera: 1\nsystem: s\ntypes: { V: { v: float64 } }\nagents:\n"
    "  a: { control: { rate: 10 Hz, outputs: { y: V }, behaviours: { go: {} } } }\n"
    "  b: { control: { rate: 10 Hz, inputs: { x: V }, behaviours: { go: {} } } }\n"
    "channels:\n  - a.control.y -> b.control.x\n";

std::set<std::string> files_in(const fs::path& folder) {
  std::set<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (!entry.is_directory()) files.insert(fs::relative(entry.path(), folder).string());
  return files;
}

TEST_F(Files, GenerateElsewhereKeepsWhatIsThere) {
  write(folder_ / "p/spec.yaml", small);
  write(folder_ / "out/letter.txt", "dear");
  write(folder_ / "out/robot/photo.png", "photo");
  ASSERT_EQ(tessera("generate p --output out --stubs").code, 0);
  ASSERT_TRUE(fs::exists(folder_ / "out/b/control.hpp"));
  write(folder_ / "out/b/notes.txt", "mine");
  write(folder_ / "out/a/control.hpp", content_of(folder_ / "out/a/control.hpp") + "// mine\n");

  // Both agents are removed; a generated file of theirs that the user has changed stays under another name.
  std::string other = small;
  for (const std::string from : {"  a: ", "  b: ", "a.control", "b.control"})
    other.replace(other.find(from), from.size(), from.starts_with(" ") ? "  c" + from.substr(2) : "c" + from);
  write(folder_ / "p/spec.yaml", other);
  const project::Exit again = tessera("generate p --output out --stubs");
  ASSERT_EQ(again.code, 0) << again.text;
  EXPECT_EQ(content_of(folder_ / "out/letter.txt"), "dear");
  EXPECT_EQ(content_of(folder_ / "out/robot/photo.png"), "photo");
  EXPECT_EQ(content_of(folder_ / "out/b/notes.txt"), "mine");
  EXPECT_FALSE(fs::exists(folder_ / "out/b/control.hpp"));
  EXPECT_NE(content_of(folder_ / "out/a/control.hpp.edited").find("// mine"), std::string::npos);
  EXPECT_NE(again.text.find("control.hpp.edited"), std::string::npos) << again.text;
  EXPECT_TRUE(fs::exists(folder_ / "out/ca/control.hpp"));
}

/// The build would compile them a second time.
TEST_F(Files, GenerateIntoTheSourcesOfAProjectWritesNothing) {
  write(folder_ / "p/spec.yaml", small);
  write(folder_ / "p/src/mine.cpp", "// mine\n");
  fs::create_directory_symlink("p/src", folder_ / "linked");
  for (const char* folder : {"p/src", "p/src/", "p/src/deep/er", "p/test", "p/../p/src/x", "linked/x"}) {
    const project::Exit done = tessera(std::string("generate p --output ") + folder);
    EXPECT_EQ(done.code, 1) << done.text;
    EXPECT_NE(done.text.find("whose sources are yours"), std::string::npos) << done.text;
  }
  EXPECT_EQ(files_in(folder_ / "p/src").size(), 1U);
  EXPECT_FALSE(fs::exists(folder_ / "p/test"));
  EXPECT_EQ(tessera("generate p --output p/srcs --stubs").code, 0);
}

TEST_F(Files, GenerateIntoAFolderWithOtherFilesOfItsNamesWritesNothing) {
  write(folder_ / "p/spec.yaml", small);
  write(folder_ / "mine/CMakeLists.txt", "project(mine)\n");
  fs::create_directories(folder_ / "elsewhere");
  fs::create_directories(folder_ / "linked");
  fs::create_symlink("../elsewhere", folder_ / "linked/a");
  for (const char* folder : {"mine", "linked"}) {
    const auto before = files_in(folder_ / folder);
    const project::Exit done = tessera(std::string("generate p --output ") + folder);
    EXPECT_EQ(done.code, 1) << done.text;
    EXPECT_NE(done.text.find("has files that Tessera has not written"), std::string::npos) << done.text;
    EXPECT_EQ(files_in(folder_ / folder), before);
  }
  EXPECT_EQ(content_of(folder_ / "mine/CMakeLists.txt"), "project(mine)\n");
  EXPECT_TRUE(fs::is_empty(folder_ / "elsewhere"));

  const std::string spec = content_of(folder_ / "p/spec.yaml");
  EXPECT_EQ(tessera("generate p --output p --stubs").code, 0);
  EXPECT_EQ(tessera("generate p --output p").code, 0);
  EXPECT_EQ(content_of(folder_ / "p/spec.yaml"), spec);
  EXPECT_TRUE(fs::exists(folder_ / "p/src/a/control.cpp"));
}

TEST_F(Files, GeneratedFilesThatSomebodyEditedAreSetAside) {
  write(folder_ / "p/spec.yaml", small);
  ASSERT_EQ(tessera("generate p --stubs").code, 0);
  const fs::path system = folder_ / "p/.tessera/generated/system.cpp";
  const std::string text = content_of(system);
  for (const char* kept : {"system.cpp.edited", "system.cpp.edited2"}) {
    write(system, text + "// for a look\n");
    const project::Exit done = tessera("generate p");
    EXPECT_EQ(done.code, 0) << done.text;
    EXPECT_NE(done.text.find(kept), std::string::npos) << done.text;
    EXPECT_EQ(content_of(system), text);
    EXPECT_EQ(content_of(system.parent_path() / kept), text + "// for a look\n");
  }
  // A folder of a version that kept no list.
  fs::remove(system.parent_path() / ".tessera-files");
  write(system, "// Generated by Tessera from spec.yaml (net 0); do not edit.\n");
  EXPECT_EQ(tessera("generate p").code, 0);
  EXPECT_EQ(content_of(system), text);
}

TEST_F(Files, OutputsReplaceOnlyTheirLike) {
  write(folder_ / "p/spec.yaml", small);
  write(folder_ / "site/index.html", "<!doctype html><title>my page</title>");
  write(folder_ / "pictures/path.png", "my picture");
  write(folder_ / "old.json", "{}");
  struct Case {
    const char *options, *file;
  };
  for (const Case& one :
       {Case{"check p --json p/spec.yaml", "p/spec.yaml"}, Case{"show p --svg p/spec.yaml", "p/spec.yaml"},
        Case{"verify p --json p/spec.yaml", "p/spec.yaml"},
        Case{"generate p --json p/spec.yaml", "p/spec.yaml"},
        Case{"simulate p --json p/spec.yaml", "p/spec.yaml"},
        Case{"simulate p --record p/spec.yaml", "p/spec.yaml"},
        Case{"simulate p --report site", "site/index.html"},
        Case{"simulate p --report pictures", "pictures/path.png"},
        Case{"simulate p --report p/spec.yaml", "p/spec.yaml"}}) {
    const std::string before = content_of(folder_ / one.file);
    const project::Exit done = tessera(one.options);
    EXPECT_EQ(done.code, 1) << one.options << "\n" << done.text;
    EXPECT_NE(done.text.find("is there already and is no"), std::string::npos) << one.options << "\n"
                                                                               << done.text;
    EXPECT_EQ(content_of(folder_ / one.file), before);
  }
  EXPECT_EQ(tessera("check p --json old.json").code, 0);
  EXPECT_NE(content_of(folder_ / "old.json"), "{}");
  EXPECT_EQ(tessera("check p --json /dev/null").code, 0);
}

TEST_F(Files, ASpecificationThatIsALinkBelongsToTheProjectOfTheLink) {
  write(folder_ / "common/spec.yaml", small);
  fs::create_directories(folder_ / "left");
  fs::create_symlink("../common/spec.yaml", folder_ / "left/spec.yaml");
  const project::Exit done = tessera("generate left --stubs");
  ASSERT_EQ(done.code, 0) << done.text;
  EXPECT_TRUE(fs::exists(folder_ / "left/src/a/control.cpp")) << done.text;
  EXPECT_EQ(files_in(folder_ / "common"), std::set<std::string>{"spec.yaml"});
}

TEST_F(Files, NewTakesNobodysPlaceAndLeavesNothingBehind) {
  fs::create_symlink("nowhere", folder_ / "rover");
  EXPECT_EQ(tessera("new rover").code, 1);
  EXPECT_TRUE(fs::is_symlink(folder_ / "rover"));
  fs::remove(folder_ / "rover");
  fs::create_directory(folder_ / "rover");
  EXPECT_EQ(tessera("new rover").code, 1);
  EXPECT_TRUE(fs::is_empty(folder_ / "rover"));
  fs::remove(folder_ / "rover");

  // If several start at once, one of them makes it.
  const project::Exit all = shell("for n in 1 2 3 4; do " TESSERA_BINARY_DIR
                                  "/tessera new rover & done; wait; ls -A | tr '\\n' ' '");
  EXPECT_NE(all.text.find("rover "), std::string::npos) << all.text;
  EXPECT_EQ(all.text.find(".tessera-new"), std::string::npos) << all.text;
  std::size_t ready = 0;
  for (std::size_t at = 0; (at = all.text.find("is ready", at)) != std::string::npos; ++at) ++ready;
  EXPECT_EQ(ready, 1U) << all.text;
  EXPECT_TRUE(fs::exists(folder_ / "rover/spec.yaml"));
}

TEST_F(Files, APathThatCMakeCannotHandleIsNamedAtOnce) {
  struct Case {
    std::string name, told;
  };
  for (const Case& one :
       {Case{"a;b", "the character ;"}, Case{"a\"b", "the character \""}, Case{"a\\b", "the character \\"},
        Case{"a[b", "the character ["}, Case{"a]b", "the character ]"}, Case{"a|b", "the character |"},
        Case{"a`b", "the character `"}, Case{"a${b}", "the character $ before {"},
        Case{"a$(x)b", "the character $ before ("}, Case{"a\nb", "a control character (code 10)"},
        Case{"a\tb", "a control character (code 9)"}}) {
    write(folder_ / one.name / "spec.yaml", small);
    const project::Exit done = project::capture(
        {TESSERA_BINARY_DIR "/tessera", "simulate", (folder_ / one.name).string(), "--for", "1s"});
    EXPECT_EQ(done.code, 1) << done.text;
    EXPECT_NE(done.text.find(one.told + ", which CMake cannot handle"), std::string::npos) << done.text;
    EXPECT_EQ(done.text.find("CMake Error"), std::string::npos) << done.text;
  }
}

TEST_F(Files, OtherPunctuationIsQuoted) {
  const fs::path odd = folder_ / "a'b&c*d?e^f<g>";
  write(odd / "spec.yaml", small);
  const auto in = [&](const std::string& arguments) {
    return project::capture(
        {"sh", "-c", "cd \"$0\" && " TESSERA_BINARY_DIR "/tessera " + arguments, odd.string()});
  };
  ASSERT_EQ(in("generate --stubs").code, 0);
  const project::Exit ran = in("simulate --for 1s");
  EXPECT_EQ(ran.code, 0) << ran.text;
}

TEST_F(Files, AFolderInTheWayOfTheBuildStays) {
  write(folder_ / "p/spec.yaml", small);
  write(folder_ / "thesis/build/release/thesis.tex", "years");
  fs::create_symlink("../thesis", folder_ / "p/.tessera");
  ASSERT_EQ(tessera("generate p --stubs").code, 0);
  const project::Exit done = tessera("simulate p --for 1s");
  EXPECT_EQ(done.code, 1);
  EXPECT_NE(done.text.find("is in the way"), std::string::npos) << done.text;
  EXPECT_EQ(content_of(folder_ / "thesis/build/release/thesis.tex"), "years");
}

/// Every user of the machine can read the arguments of a program.
TEST_F(Files, TheKeyOfTheStudioStandsInNoArgumentOfTheBrowser) {
  write(folder_ / "a b/spec.yaml", small);
  // Its argument, the mode of the file, and the content, as a browser would find them.
  write(folder_ / "bin/xdg-open",
        "#!/bin/sh\necho \"$1\" > \"$SEEN/argument\"\n"
        "file=$(echo \"$1\" | sed 's,^file://,,; s,%20, ,g')\n"
        "stat -c %a \"$file\" > \"$SEEN/mode\"\ncp \"$file\" \"$SEEN/page\"\ntouch \"$SEEN/done\"\n");
  fs::permissions(folder_ / "bin/xdg-open", fs::perms::owner_all);
  const project::Exit done = shell("export SEEN=$PWD PATH=$PWD/bin:$PATH DISPLAY=:9; " TESSERA_BINARY_DIR
                                   "/tessera studio 'a b' --port 0 > printed & for i in $(seq 600); do [ -e "
                                   "done ] && break; sleep 0.1; done; "
                                   "kill -TERM $!; wait $!");
  EXPECT_EQ(done.code, 0) << done.text;
  const std::string printed = content_of(folder_ / "printed");
  const std::string token = printed.substr(printed.find("token=") + 6, 32);
  ASSERT_EQ(token.size(), 32U) << printed;
  const std::string argument = content_of(folder_ / "argument");
  EXPECT_TRUE(argument.starts_with("file://")) << argument;
  EXPECT_EQ(argument.find(token), std::string::npos) << argument;
  EXPECT_EQ(content_of(folder_ / "mode"), "600\n");
  EXPECT_NE(content_of(folder_ / "page").find("token=" + token), std::string::npos);
  EXPECT_EQ(files_in(folder_ / "a b"), std::set<std::string>{"spec.yaml"}) << "it goes with the studio";
}

}  // namespace tessera::cli_test
