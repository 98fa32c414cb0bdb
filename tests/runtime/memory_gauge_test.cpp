#include "subsystem/memory_gauge.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <string>
#include <string_view>
#include <thread>

#include "tessera/bounded_string.hpp"

namespace tessera::testing {
namespace {

struct Remembered {
  std::uint32_t count = 3;
  std::array<double, 500> map{};  // 4000 bytes
  std::array<double, 500> another{};
  BoundedString<8> word;

  [[nodiscard]] Bindings bindings() {
    Bindings all;
    all.remember("count", count);
    all.remember("map", map);
    all.remember("another", another);
    all.remember("word", word);
    return all;
  }
};

[[nodiscard]] std::string text_of(const MemoryGauge& gauge) {
  std::string text;
  for (const auto& [name, value] : gauge.read()) text += name + " " + value.substr(0, 20) + "\n";
  return text;
}

TEST(MemoryGauge, ShowsWhatFitsFromTheBeginningOn) {
  Remembered memory;
  MemoryGauge gauge(memory.bindings());
  EXPECT_EQ(text_of(gauge), "count 3\nmap {[0]: 0, [1]: 0, [2]\nword \"\"\n");
  memory.count = 4;
  memory.word = "found";
  EXPECT_EQ(text_of(gauge), "count 3\nmap {[0]: 0, [1]: 0, [2]\nword \"\"\n")
      << "it shows ends of iterations";
  gauge.show();
  EXPECT_EQ(text_of(gauge), "count 4\nmap {[0]: 0, [1]: 0, [2]\nword \"found\"\n");
  memory.word = "a";
  gauge.show();
  EXPECT_EQ(text_of(gauge), "count 4\nmap {[0]: 0, [1]: 0, [2]\nword \"a\"\n");
}

TEST(MemoryGauge, WithoutMemoryShowsNothing) {
  MemoryGauge gauge(Bindings{});
  gauge.show();
  EXPECT_TRUE(gauge.read().empty());
}

TEST(MemoryGauge, EveryReadingIsOfOneMoment) {
  std::array<std::uint32_t, 4> numbers{};
  BoundedString<24> word;
  const std::string letters(24, 'x');
  Bindings bindings;
  bindings.remember("word", word);
  bindings.remember("numbers", numbers);
  MemoryGauge gauge(bindings);
  std::atomic<bool> over{false};
  std::thread writer([&] {
    for (std::uint32_t number = 1; !over; ++number) {
      numbers.fill(number);
      word = std::string_view(letters).substr(0, number % 24);
      gauge.show();
    }
  });
  int seen = 0;
  for (int reading = 0; reading < 20'000; ++reading) {
    const auto fields = gauge.read();
    if (fields.empty()) continue;  // it changed too fast
    ++seen;
    const std::string& all = fields[1].value;  // "{[0]: 7, [1]: 7, [2]: 7, [3]: 7}"
    const std::string number = all.substr(6, all.find(',') - 6);
    ASSERT_EQ(all, "{[0]: " + number + ", [1]: " + number + ", [2]: " + number + ", [3]: " + number + "}");
    ASSERT_EQ(fields[0].value.size(), 2 + std::stoul(number) % 24);
  }
  over = true;
  writer.join();
  EXPECT_GT(seen, 0);
}

}  // namespace
}  // namespace tessera::testing
