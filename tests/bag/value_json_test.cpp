#include "bag/value_json.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace tessera::bag::test {
namespace {

using nlohmann::json;

template <class... Numbers>
std::string encoded(Numbers... numbers) {
  std::string bytes;
  (bytes.append(reinterpret_cast<const char*>(&numbers), sizeof numbers), ...);
  return bytes;
}

TEST(ValueJson, EveryKindOfValue) {
  const auto layout = ValueLayout::parse(
      "{on: bool, small: int8, big: uint64, v: float32, w: float64, name: string(8), list: int16[<=3], pair: "
      "float64[2], inner: {x: uint8}, raw: bytes(2)}");
  ASSERT_TRUE(layout);
  const std::string bytes = encoded(true) + encoded(std::int8_t{-3}, ~std::uint64_t{0}, 0.1F, -2.5) +
                            encoded(std::uint32_t{2}) + "a\"" + encoded(std::uint32_t{1}, std::int16_t{-7}) +
                            encoded(1e300, std::numeric_limits<double>::infinity(), std::uint8_t{200}) +
                            "\x01\xff";
  const auto text = json_of(*layout, bytes);
  ASSERT_TRUE(text);
  EXPECT_EQ(*text,
            R"({"on":true,"small":-3,"big":18446744073709551615,"v":0.1,"w":-2.5,"name":"a\"","list":[-7],)"
            R"("pair":[1e+300,null],"inner":{"x":200},"raw":"01ff"})");
  EXPECT_FALSE(json_of(*layout, bytes.substr(1)));
  EXPECT_FALSE(json_of(*layout, bytes + "x"));
}

TEST(ValueJson, SchemaHasTheUnits) {
  const auto layout = ValueLayout::parse("{v: float64, points: {x: float32}[<=4]}");
  ASSERT_TRUE(layout);
  const json schema = json::parse(schema_of(*layout, "robot.v", {{"v", "m/s"}, {"points.x", "m"}}));
  EXPECT_EQ(schema["title"], "robot.v");
  EXPECT_EQ(schema["properties"]["v"]["type"], "number");
  EXPECT_EQ(schema["properties"]["v"]["nullable"], true);
  EXPECT_EQ(schema["properties"]["v"]["description"], "in m/s");
  EXPECT_EQ(schema["properties"]["points"]["items"]["properties"]["x"]["description"], "in m");
}

TEST(ValueJson, ValueThatIsNoStructureIsAMember) {
  const auto layout = ValueLayout::parse("int32[2]");
  ASSERT_TRUE(layout);
  EXPECT_EQ(json_of(*layout, encoded(1, -2)), R"({"value":[1,-2]})");
  const json schema = json::parse(schema_of(*layout, "a", {{"", "m"}}));
  EXPECT_EQ(schema["properties"]["value"]["items"]["description"], "in m");
}

}  // namespace
}  // namespace tessera::bag::test
