#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "made_file.hpp"

/// Files that were cut off, or whose bits were changed.
namespace tessera::mcap::test {
namespace {

constexpr std::uint64_t chunks = 3;

/// The first byte behind each chunk of the file.
std::vector<std::size_t> ends_of_chunks() {
  std::vector<std::size_t> ends;
  const std::string file = made_file(chunks);
  for (std::size_t size = 0; size <= file.size(); ++size)
    if (contents_of(std::string_view(file).substr(0, size)).condition.chunks > ends.size())
      ends.push_back(size);
  return ends;
}

/// Whether the messages of this chunk were read, all of them and in their order.
bool has_chunk(const Contents& contents, std::uint64_t chunk) {
  const auto first = std::ranges::find(contents.messages, message(3 * chunk));
  for (std::uint64_t number = 0; number < 3; ++number) {
    if (contents.messages.end() - first <= static_cast<std::ptrdiff_t>(number)) return false;
    if (*(first + static_cast<std::ptrdiff_t>(number)) != message(3 * chunk + number)) return false;
  }
  return true;
}

TEST(McapDamage, FileThatIsCutAnywhereHasAllItsWholeChunks) {
  const std::string file = made_file(chunks);
  const std::vector<std::size_t> ends = ends_of_chunks();
  ASSERT_EQ(ends.size(), chunks);
  for (std::size_t size = 0; size < file.size(); ++size) {
    const Contents contents = contents_of(std::string_view(file).substr(0, size));
    const auto whole = std::ranges::count_if(ends, [&](std::size_t end) { return end <= size; });
    ASSERT_EQ(contents.messages.size(), 3 * static_cast<std::size_t>(whole)) << size;
    EXPECT_FALSE(contents.condition.is_whole()) << size;
    EXPECT_EQ(contents.condition.damaged, 0U) << size;
  }
}

TEST(McapDamage, OneChangedBitCostsOneChunkAtMostAndIsNoticed) {
  const std::string sound = made_file(chunks);
  for (std::size_t at = 8; at < sound.size(); ++at) {
    std::string file = sound;
    file[at] = static_cast<char>(file[at] ^ (1 << (at % 8)));
    const Contents contents = contents_of(file);
    std::uint64_t missing = 0;
    for (std::uint64_t chunk = 0; chunk < chunks; ++chunk) missing += has_chunk(contents, chunk) ? 0 : 1;
    ASSERT_LE(missing, 1U) << at;
    EXPECT_FALSE(contents.condition.is_whole()) << at;
  }
}

TEST(McapDamage, AnyDamageLeavesOnlyMessagesThatWereWritten) {
  const std::string sound = made_file(chunks);
  std::mt19937 random(1);
  const auto below = [&](std::size_t limit) { return random() % limit; };
  for (int turn = 0; turn < 1000; ++turn) {
    std::string file = sound.substr(0, below(sound.size()) + 1);
    for (std::size_t flips = below(8); flips > 0; --flips) {
      char& byte = file[below(file.size())];
      byte = static_cast<char>(byte ^ (1 << below(8)));
    }
    for (const std::string& one : contents_of(file).messages) {
      const std::size_t text = one.find("message");
      ASSERT_NE(text, std::string::npos) << turn;
      const std::uint64_t number = std::stoull(one.substr(text + 8));
      ASSERT_EQ(one.substr(text), text_of(number)) << turn;
    }
  }
}

}  // namespace
}  // namespace tessera::mcap::test
