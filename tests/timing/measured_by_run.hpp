// The times of chains as a drawn run has measured them itself, beside their bounds and its recording.
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "chain_rows.hpp"
#include "drawn_run.hpp"
#include "replay/times/ages.hpp"
#include "tessera/recording.hpp"

namespace tessera::timing_test {

/// The times that the run itself has measured exceed no bound.
inline void hold_measured(const Observed& seen) {
  ASSERT_EQ(seen.measured.size(), seen.drawn.chains.size());
  for (const ChainTimes& chain : seen.measured) {
    EXPECT_EQ(chain.over, 0U) << chain.name;
    if (chain.proved_age && chain.longest_age) {
      EXPECT_LE(*chain.longest_age, *chain.proved_age) << chain.name;
    }
    if (chain.proved_reaction && chain.longest_reaction) {
      EXPECT_LE(*chain.longest_reaction, *chain.proved_reaction) << chain.name;
    }
  }
}

/// The role of a transition of a drawn net, which has no roles in its tables: "a0.control.run.snd.c3.t1o".
inline TransitionRole role_of(const std::string& name) {
  TransitionRole role;
  const std::string last = name.substr(name.rfind('.') + 1);
  const bool communicates =
      name.find(".snd.") != std::string::npos || name.find(".rcv.") != std::string::npos;
  if (!communicates) {
    role.step = last == "t_in" ? Step::start
                : last == "t1" ? Step::begin_sending
                : last == "t4" ? Step::go_on
                               : Step::other;
    return role;
  }
  const std::size_t port = name.find('c', name.find("run.") + 8);
  role.step = Step::page;
  if (name.rfind('.') < port || port == std::string::npos) return role;
  role.channel = static_cast<std::uint32_t>(std::stoul(name.substr(port + 1)));
  role.step = last == "t1o"       ? Step::overwrite
              : last == "skip"    ? Step::skip
              : last == "timeout" ? Step::timeout
                                  : Step::transfer;
  return role;
}

/// The times that the run itself has measured are those that its recording tells.
inline void compare_with_recording(const Observed& seen, const std::string& file) {
  std::vector<replay::MeasuredChain> chains;
  for (std::size_t chain = 0; chain < seen.drawn.chains.size(); ++chain) {
    replay::MeasuredChain& one = chains.emplace_back();
    one.name = one.group = chain_name(chain);
    std::vector<std::string>& way = one.ways.emplace_back();
    const auto name_of = [](int subsystem) { return "a" + std::to_string(subsystem) + ".control"; };
    one.subsystems.push_back(name_of(static_cast<int>(seen.first_of(chain))));
    for (const int channel : seen.drawn.chains[chain]) {
      one.subsystems.push_back(name_of(seen.net().channels[static_cast<std::size_t>(channel)].to));
      way.emplace_back(port_of(static_cast<std::size_t>(channel)));
    }
  }
  std::string error;
  std::optional<Recording> recording = read_recording(file, error);
  ASSERT_TRUE(recording) << error;
  for (Recording::Transition& transition : recording->transitions) transition.role = role_of(transition.name);
  replay::Ages ages(chains);
  ages.add(*recording);
  const std::vector<replay::ChainAges> told = ages.finish();
  ASSERT_EQ(told.size(), seen.measured.size());
  for (std::size_t chain = 0; chain < told.size(); ++chain) {
    const ChainTimes& measured = seen.measured[chain];
    EXPECT_EQ(measured.commands, told[chain].age.count) << measured.name << " " << told[chain].why;
    EXPECT_EQ(measured.longest_age.value_or(Duration(0)).count(), told[chain].age.most) << measured.name;
    EXPECT_EQ(measured.longest_reaction.value_or(Duration(0)).count(), told[chain].reaction.most)
        << measured.name;
  }
}

}  // namespace tessera::timing_test
