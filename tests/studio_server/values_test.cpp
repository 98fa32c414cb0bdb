#include <gtest/gtest.h>

#include <array>
#include <span>

#include "server/recordings/value_json.hpp"
#include "tessera/bounded_string.hpp"
#include "tessera/fields.hpp"
#include "tessera/value_encoding.hpp"

namespace tessera::server_test {

// As generated code declares them.
struct Inner {
  bool on = true;
  double x = -1.5;
  TESSERA_FIELDS(Inner, on, x)
};
struct Mixed {
  std::int8_t small = -3;
  BoundedString<5> name = "abc";
  std::array<Inner, 2> inner{};
  std::uint64_t last = UINT64_MAX;
  TESSERA_FIELDS(Mixed, small, name, inner, last)
};

namespace {

template <class T>
std::string bytes_of(const T& value) {
  ValueSink sink(4096);
  value_encoding_of<T>()->put(&value, sink);
  const std::span<const std::byte> bytes = sink.bytes();
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

template <class T>
ValueLayout layout_of() {
  return ValueLayout::parse(value_encoding_of<T>()->type()).value();
}

TEST(ValueJson, IsWhatARecordingHolds) {
  EXPECT_EQ(server::json_of(layout_of<Mixed>(), bytes_of(Mixed{})),
            nlohmann::json::parse(R"({"small":-3,"name":"abc",
      "inner":[{"on":true,"x":-1.5},{"on":true,"x":-1.5}],"last":18446744073709551615})"));
  using Matrix = std::array<std::array<float, 2>, 2>;
  EXPECT_EQ(server::json_of(layout_of<Matrix>(), bytes_of(Matrix{{{1, 2.5}, {3, 4}}})),
            nlohmann::json::parse("[[1.0,2.5],[3.0,4.0]]"));
  EXPECT_EQ(server::json_of(layout_of<double>(), bytes_of(0.25)), 0.25);
}

TEST(ValueJson, BytesThatDoNotFitAreNoValue) {
  EXPECT_TRUE(server::json_of(layout_of<Mixed>(), "").is_null());
  EXPECT_TRUE(server::json_of(layout_of<Mixed>(), bytes_of(Mixed{}) + "x").is_null());
  EXPECT_TRUE(server::json_of(layout_of<double>(), "1234").is_null());
}

}  // namespace
}  // namespace tessera::server_test
