// The words that the layers write into names are only names: a controller, its runtime, the verification and
// every reader of a recording act the same with other words (CMakeLists.txt).
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "renamed.hpp"
#include "tessera/recording.hpp"

namespace tessera::test {
namespace {

std::string told_by(const std::string& program) {
  const auto recording =
      std::filesystem::temp_directory_path() / ("words" + std::to_string(getpid()) + ".tsr");
  const std::string command = program + " " TESSERA_WORDS_SPEC " " + recording.string() + " 2>&1";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string text;
  std::array<char, 4096> piece;
  while (const std::size_t count = fread(piece.data(), 1, piece.size(), pipe.get()))
    text.append(piece.data(), count);
  return text;
}

TEST(Words, OtherWordsChangeNamesAndNothingElse) {
  const std::string usual = told_by(TESSERA_USUAL_WORDS), other = told_by(TESSERA_OTHER_WORDS);
  // The output must not be empty.
  for (const char* part : {"after 6: follow, failed init\n", "after 41: rest, failed init\n",
                           "robot.control.follow.t1: begin_sending follow \n",
                           "robot.control.follow.snd.note.timeout: timeout follow "
                           "robot.control.note->station.control.note\n",
                           "legal: 0 ", "coverage of the net by 1 run:", "safe 0 place invariants",
                           "\"name\":\"iteration (error)\""})
    EXPECT_NE(usual.find(part), std::string::npos) << part;
  EXPECT_EQ(usual.find(strange), std::string::npos);
  EXPECT_NE(other.find("robot.control.follow.Q_t1: begin_sending follow \n"), std::string::npos);
  EXPECT_EQ(without_strange_words(usual), without_strange_words(other));
}

}  // namespace
}  // namespace tessera::test
