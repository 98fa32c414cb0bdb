#include "server/values.hpp"

#include <gtest/gtest.h>

#include <array>

#include "diagnostics/diagnostics.hpp"
#include "spec/parser.hpp"
#include "tessera/bounded_string.hpp"

namespace tessera::server_test {

namespace {

// As generated code declares them.
struct Inner {
  bool on = true;
  double x = -1.5;
};
struct Mixed {
  std::int8_t small = -3;
  BoundedString<5> name = "abc";
  std::array<Inner, 2> inner{};
  std::uint16_t last = 65535;
};

constexpr const char* text = R"(tessera: 1
system: s
types:
  Inner: { on: bool, x: float64 }
  Mixed: { small: int8, name: string<=5, inner: "Inner[2]", last: uint16 }
agents:
  r:
    control:
      rate: 1 Hz
      outputs: { mixed: Mixed, list: "float32[3]" }
      behaviours: { a: {} }
)";

template <class T>
std::string hex(const T& value) {
  std::string digits;
  const auto* bytes = reinterpret_cast<const unsigned char*>(&value);
  for (std::size_t at = 0; at < sizeof value; ++at) {
    digits += "0123456789abcdef"[bytes[at] >> 4U];
    digits += "0123456789abcdef"[bytes[at] & 15U];
  }
  return digits;
}

}  // namespace

TEST(ValueReader, ReadsWhatACompilerHasLaidOut) {
  diagnostics::Diagnostics out("spec.yaml", text);
  const std::optional<spec::Model> model = spec::parse_what_is_known(out);
  ASSERT_TRUE(model && !out.has_errors()) << diagnostics::render(out);
  const server::ValueReader reader(*model);
  EXPECT_EQ(reader.read("r.control.mixed", hex(Mixed{})), nlohmann::json::parse(R"({"small":-3,"name":"abc",
      "inner":[{"on":true,"x":-1.5},{"on":true,"x":-1.5}],"last":65535})"));
  EXPECT_EQ(reader.read("r.control.list", hex(std::array{1.0F, 2.5F, 3.0F})), nlohmann::json({1, 2.5, 3}));
}

TEST(ValueReader, BytesThatDoNotFitAreNoValue) {
  diagnostics::Diagnostics out("spec.yaml", text);
  const std::optional<spec::Model> model = spec::parse_what_is_known(out);
  ASSERT_TRUE(model);
  const server::ValueReader reader(*model);
  EXPECT_TRUE(reader.read("r.control.list", "00").is_null());
  EXPECT_TRUE(reader.read("r.control.list", std::string(24, 'z')).is_null());
  EXPECT_TRUE(reader.read("r.control.nothing", std::string(24, '0')).is_null());
}

}  // namespace tessera::server_test
