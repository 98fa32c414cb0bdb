#include "tessera/units.hpp"

#include <gtest/gtest.h>

#include <string>

namespace tessera {
namespace {

TEST(Units, OfTheSameQuantityAreConverted) {
  struct Case {
    const char* given;
    const char* unit;
    double number;
  };
  for (const Case& one :
       {Case{"5 cm", "m", 0.05}, Case{"2 km", "m", 2000}, Case{"36 km/h", "m/s", 10},
        Case{"2 km/h", "m/s", 2 / 3.6}, Case{"60 m/min", "cm/s", 100}, Case{"3 Hz", "1/s", 3},
        Case{"3 1/s", "Hz", 3}, Case{"2 kHz", "1/s", 2000}, Case{"180 deg/s", "rad/s", 3.14159265358979312},
        Case{"50 cm/s^2", "m/s/s", 0.5}, Case{"50 cm/s2", "m/s²", 0.5}, Case{"1 m*m", "cm^2", 1e4},
        Case{"2 m^-1", "1/cm", 0.02}, Case{"250 ms", "s", 0.25}, Case{"1 m/s*s", "cm", 100}}) {
    const auto quantity = split_quantity(one.given);
    ASSERT_TRUE(quantity) << one.given;
    const auto number = converted(quantity->number, quantity->unit, one.unit);
    ASSERT_TRUE(number) << one.given << " in " << one.unit;
    EXPECT_DOUBLE_EQ(*number, one.number) << one.given << " in " << one.unit;
  }
}

TEST(Units, OfAnotherQuantityOrUnknownOnesAreNotConverted) {
  for (const auto& [given, unit] : {std::pair{"5 cm", "s"},
                                    {"5 cm/s", "m"},
                                    {"3 Hz", "rad/s"},
                                    {"3 kg", "kg"},
                                    {"3 m/", "m"},
                                    {"3 m^99", "m"},
                                    {"3 /s", "Hz"},
                                    {"3 m s", "m"}}) {
    const auto quantity = split_quantity(given);
    ASSERT_TRUE(quantity) << given;
    EXPECT_FALSE(converted(quantity->number, quantity->unit, unit)) << given << " in " << unit;
  }
}

}  // namespace
}  // namespace tessera
