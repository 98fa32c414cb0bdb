#include "tessera/ids.hpp"

#include <gtest/gtest.h>

#include <concepts>
#include <vector>

#include "spec/model/model.hpp"

namespace tessera::spec {
namespace {

template <class List, class Number>
concept Indexes = requires(const List& list, Number number) {
  list[number];
};

// A mix-up of kinds does not compile.
static_assert(Indexes<decltype(Model::agents), AgentId>);
static_assert(!Indexes<decltype(Model::agents), InstanceId>);
static_assert(!Indexes<decltype(Model::instances), AgentId>);
static_assert(!Indexes<decltype(Model::channels), InstanceId>);
static_assert(!Indexes<decltype(Model::definitions), AgentId>);
static_assert(!Indexes<decltype(Model::models), ChannelId>);
static_assert(!Indexes<decltype(Model::structures), DefinitionId>);
static_assert(!Indexes<decltype(Definition::subsystems), InstanceId>);
static_assert(!Indexes<decltype(Deployment::processes), AgentId>);
static_assert(!Indexes<decltype(Subsystem::behaviours), NextId>);
static_assert(!Indexes<decltype(Subsystem::real), BufferId>);
static_assert(!Indexes<decltype(Subsystem::inputs), RealId>);
static_assert(!Indexes<decltype(Behaviour::next), BehaviourId>);
static_assert(!Indexes<decltype(Condition::expressions), NextId>);
static_assert(!std::convertible_to<AgentId, InstanceId>);
static_assert(!std::convertible_to<AgentId, std::uint32_t>);
static_assert(!std::convertible_to<std::uint32_t, AgentId>);

TEST(Ids, CountTheElementsOfTheirList) {
  Numbered<AgentId, char> list{'a', 'b'};
  const AgentId third = list.next_id();
  EXPECT_FALSE(list.has(third));
  list.push_back('c');
  ASSERT_TRUE(list.has(third));
  EXPECT_EQ(list[third], 'c');
  std::vector<std::uint32_t> numbers;
  for (const AgentId id : list.ids()) numbers.push_back(id.value);
  EXPECT_EQ(numbers, (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST(Ids, OfNoElementAreNone) {
  const AgentId none;
  EXPECT_FALSE(none.valid());
  EXPECT_FALSE((Numbered<AgentId, char>{'a'}).has(none));
  EXPECT_TRUE((AgentId{0}).valid());
}

}  // namespace
}  // namespace tessera::spec
