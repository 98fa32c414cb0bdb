#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <new>

#include "network/dds/carrier.hpp"
#include "tests/dds/crossing.hpp"
#include "tests/eventually.hpp"

namespace {

thread_local std::size_t allocations = 0;

}  // namespace

// g++ inlines one of the two without the other, and then warns of the pair.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
// The middleware is C and allocates elsewhere: only our allocations are counted.
void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace tessera::test {
namespace {

struct Counting final : network::Carrier::Listener {
  void heard(network::ChannelNumber, const network::Data&, const network::Value&) override { ++values; }
  void heard(network::ChannelNumber, const network::State&) override { ++states; }
  void reachable(network::ProcessNumber, bool is_there) override { meets = is_there; }
  void complaint(std::string_view) override { ++complaints; }
  bool meets = false;
  int values = 0, states = 0, complaints = 0;
};

TEST(CarrierAllocation, AMessageAllocatesNothingOfOurs) {
  const Crossing crossing;
  dds::DdsCarrier office(crossing.setup(Crossing::office, 10)), cart(crossing.setup(Crossing::cart, 20));
  Counting office_heard, cart_heard;
  const auto receive = [&] {
    office.receive(office_heard, std::chrono::milliseconds(2));
    cart.receive(cart_heard, std::chrono::milliseconds(2));
  };
  ASSERT_TRUE(eventually([&] {
    receive();
    return office_heard.meets && cart_heard.meets;
  }));
  const std::array<std::byte, Crossing::small> value{};
  const std::size_t before = allocations;
  for (std::uint64_t number = 1; number <= 500; ++number) {
    office.send(Crossing::goal, {{10}, {20}, {number}, false}, {std::chrono::nanoseconds(1), true, value});
    cart.send(Crossing::goal, network::State{{20}, {10}, {number}});
    receive();
  }
  EXPECT_EQ(allocations, before);
  EXPECT_GT(cart_heard.values, 100);
  EXPECT_GT(office_heard.states, 100);
  EXPECT_EQ(office_heard.complaints + cart_heard.complaints, 0);
}

}  // namespace
}  // namespace tessera::test
