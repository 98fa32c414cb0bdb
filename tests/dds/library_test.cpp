#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <memory>

#include "tests/dds/crossing.hpp"
#include "tests/dds/heard.hpp"

/// The library as a controller loads it.
namespace tessera::test {
namespace {

using Maker = network::OpenCarrier*;

Maker maker() {
  void* library = dlopen(TESSERA_DDS_LIBRARY, RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    ADD_FAILURE() << dlerror();
    return nullptr;
  }
  return reinterpret_cast<Maker>(dlsym(library, network::open_carrier_function));
}

TEST(Library, MakesCarriersThatMeet) {
  const Maker make = maker();
  ASSERT_NE(make, nullptr);
  const Crossing crossing;
  std::array<char, 200> error{};
  const auto opened = [&](network::ProcessNumber process) {
    return std::unique_ptr<network::Carrier>(make(crossing.setup(process, 10), error.data(), error.size()));
  };
  const auto office_carrier = opened(Crossing::office), cart_carrier = opened(Crossing::cart);
  ASSERT_TRUE(office_carrier && cart_carrier) << error.data();
  Station office(*office_carrier), cart(*cart_carrier);
  EXPECT_TRUE(receive_until(
      [&] { return office.heard.sees(Crossing::cart) && cart.heard.sees(Crossing::office); }, office, cart));
}

TEST(Library, SaysWhyThereIsNoCarrierInTheRoomThatItHas) {
  const Maker make = maker();
  ASSERT_NE(make, nullptr);
  Crossing crossing;
  crossing.interface = "nosuch0";
  std::array<char, 200> error{};
  EXPECT_EQ(make(crossing.setup(Crossing::office, 10), error.data(), error.size()), nullptr);
  EXPECT_THAT(error.data(), testing::StartsWith("there is no interface nosuch0"));
  error.fill('x');
  EXPECT_EQ(make(crossing.setup(Crossing::office, 10), error.data(), 6), nullptr);
  EXPECT_STREQ(error.data(), "there");
  EXPECT_EQ(error[6], 'x');
  EXPECT_EQ(make(crossing.setup(Crossing::office, 10), nullptr, 0), nullptr);
}

}  // namespace
}  // namespace tessera::test
