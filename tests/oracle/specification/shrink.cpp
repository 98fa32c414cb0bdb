#include "shrink.hpp"

#include <algorithm>

namespace oracle {
namespace {

using Candidates = std::vector<Specification>;

void drop_channel(Specification& in, std::size_t c) {
  in.channels.erase(in.channels.begin() + static_cast<std::ptrdiff_t>(c));
}

/// Buffers that no channel names any more go, and so do they from the lists of behaviours.
void tidy(Specification& in) {
  const auto unused = [&](const std::string& buffer) {
    return std::none_of(in.channels.begin(), in.channels.end(), [&](const Channel& c) {
      return c.from.buffer == buffer || c.to.buffer == buffer ||
             (buffer.ends_with("]") && (c.from.buffer.starts_with(buffer.substr(0, buffer.find('[') + 1)) ||
                                        c.to.buffer.starts_with(buffer.substr(0, buffer.find('[') + 1))));
    });
  };
  for (auto* agents : {&in.templates, &in.agents})
    for (Agent& agent : *agents)
      for (Subsystem& subsystem : agent.subsystems) {
        std::erase_if(subsystem.inputs, unused);
        std::erase_if(subsystem.outputs, unused);
        for (Behaviour& behaviour : subsystem.behaviours) {
          if (behaviour.send) std::erase_if(*behaviour.send, unused);
          if (behaviour.receive) std::erase_if(*behaviour.receive, unused);
        }
      }
}

template <class Change>
void every_subsystem(const Specification& from, Candidates& into, Change change) {
  for (const bool templates : {true, false}) {
    const auto& agents = templates ? from.templates : from.agents;
    for (std::size_t a = 0; a < agents.size(); ++a)
      for (std::size_t s = 0; s < agents[a].subsystems.size(); ++s)
        change(
            [&](auto edit) {
              Specification candidate = from;
              auto& changed = templates ? candidate.templates : candidate.agents;
              edit(candidate, changed[a], s);
              into.push_back(std::move(candidate));
            },
            agents[a].subsystems[s]);
  }
}

void leave_out(const Specification& from, Candidates& into) {
  for (std::size_t p = 0; p < from.properties.size(); ++p) {
    into.push_back(from);
    into.back().properties.erase(into.back().properties.begin() + static_cast<std::ptrdiff_t>(p));
  }
  for (std::size_t a = 0; a < from.agents.size() && from.agents.size() > 1; ++a) {
    into.push_back(from);
    const std::string name = from.agents[a].name;
    std::erase_if(into.back().channels,
                  [&](const Channel& c) { return c.from.agent == name || c.to.agent == name; });
    into.back().agents.erase(into.back().agents.begin() + static_cast<std::ptrdiff_t>(a));
  }
  for (std::size_t c = 0; c < from.channels.size(); ++c) {
    into.push_back(from);
    drop_channel(into.back(), c);
  }
  for (std::size_t m = 0; m < from.models.size(); ++m) {
    into.push_back(from);
    into.back().models.erase(into.back().models.begin() + static_cast<std::ptrdiff_t>(m));
  }
  every_subsystem(from, into, [](auto add, const Subsystem& of) {
    if (of.kind == Subsystem::Kind::control) return;
    add([](Specification& candidate, Agent& agent, std::size_t s) {
      const std::string name = agent.subsystems[s].name;
      std::erase_if(candidate.channels,
                    [&](const Channel& c) { return c.from.subsystem == name || c.to.subsystem == name; });
      agent.subsystems.erase(agent.subsystems.begin() + static_cast<std::ptrdiff_t>(s));
    });
  });
  every_subsystem(from, into, [](auto add, const Subsystem& of) {
    for (std::size_t b = 0; b < of.behaviours.size() && of.behaviours.size() > 1; ++b)
      add([b](Specification&, Agent& agent, std::size_t s) {
        Subsystem& subsystem = agent.subsystems[s];
        const std::string name = subsystem.behaviours[b].name;
        subsystem.behaviours.erase(subsystem.behaviours.begin() + static_cast<std::ptrdiff_t>(b));
        std::erase_if(subsystem.behaviours, [&](const Behaviour& one) { return one.group == name; });
        if (subsystem.start == name) subsystem.start.clear();
        if (subsystem.on_error == name) subsystem.on_error.clear();
        for (Behaviour& other : subsystem.behaviours)
          for (std::string* of : {&other.start, &other.on_error})
            if (*of == name) of->clear();
        for (Behaviour& other : subsystem.behaviours)
          std::erase_if(other.next, [&](const Entry& e) { return e.to == name; });
      });
  });
}

void simplify_fleets(const Specification& from, Candidates& into) {
  for (std::size_t a = 0; a < from.agents.size(); ++a) {
    if (from.agents[a].count > 1) {
      into.push_back(from);
      --into.back().agents[a].count;
    }
    if (from.agents[a].ring) {
      into.push_back(from);
      into.back().agents[a].ring = false;
    }
    if (from.agents[a].use.empty()) continue;
    into.push_back(from);  // an agent of its own, in place of the fleet or of the template
    Agent& agent = into.back().agents[a];
    agent.subsystems = subsystems_of(from, from.agents[a]);
    agent.use.clear();
    agent.count = 0;
    agent.ring = false;
    for (Channel& c : into.back().channels)
      for (End* end : {&c.from, &c.to})
        if (end->agent == agent.name) end->index.clear();
    std::erase_if(into.back().templates, [&](const Agent& one) {
      return std::none_of(into.back().agents.begin(), into.back().agents.end(),
                          [&](const Agent& user) { return user.use == one.name; });
    });
  }
}

void simplify_channels(const Specification& from, Candidates& into) {
  for (std::size_t c = 0; c < from.channels.size(); ++c)
    for (bool Channel::*flag : {&Channel::send_timeout, &Channel::receive_timeout, &Channel::send_blocking,
                                &Channel::receive_blocking}) {
      if (!(from.channels[c].*flag)) continue;
      into.push_back(from);
      into.back().channels[c].*flag = false;
    }
}

template <class Edit>
void behaviour_candidate(const Specification& from, Candidates& into, Edit edit) {
  every_subsystem(from, into, [&](auto add, const Subsystem& of) {
    for (std::size_t b = 0; b < of.behaviours.size(); ++b) {
      Behaviour changed = of.behaviours[b];
      if (edit(changed))
        add([&, b](Specification&, Agent& agent, std::size_t s) {
          agent.subsystems[s].behaviours[b] = changed;
        });
    }
  });
}

void simplify_behaviours(const Specification& from, Candidates& into) {
  const auto set = [](auto& member, auto value, bool changes) {
    member = value;
    return changes;
  };
  behaviour_candidate(from, into, [&](Behaviour& b) {
    std::erase_if(b.next, [](const Entry& entry) { return entry.when == Entry::When::until; });
    return set(b.has_until, false, b.has_until);
  });
  for (std::string Behaviour::*name : {&Behaviour::on_error, &Behaviour::start})
    behaviour_candidate(from, into,
                        [&](Behaviour& b) { return set(b.*name, std::string(), !(b.*name).empty()); });
  behaviour_candidate(from, into, [&](Behaviour& b) { return set(b.parallel, false, b.parallel); });
  behaviour_candidate(from, into, [&](Behaviour& b) { return set(b.takes, false, b.takes); });
  behaviour_candidate(from, into,
                      [&](Behaviour& b) { return set(b.skips, std::vector<Skip>{}, !b.skips.empty()); });
  behaviour_candidate(from, into, [&](Behaviour& b) {
    return set(b.send, std::nullopt, b.send.has_value() && b.skips.empty());
  });
  behaviour_candidate(from, into,
                      [&](Behaviour& b) { return set(b.receive, std::nullopt, b.receive.has_value()); });
  for (Condition Behaviour::*which : {&Behaviour::terminal, &Behaviour::error}) {
    behaviour_candidate(from, into, [&](Behaviour& b) {
      return set((b.*which), Condition{}, (b.*which).form != Condition::Form::absent);
    });
    behaviour_candidate(from, into, [&](Behaviour& b) {
      if ((b.*which).named.size() < 2) return false;
      (b.*which).named.pop_back();
      return true;
    });
    behaviour_candidate(from, into, [&](Behaviour& b) {
      if ((b.*which).form != Condition::Form::named) return false;
      b.*which = {Condition::Form::single, (b.*which).named[0].second, {}, (b.*which).asked};
      return true;
    });
  }
  behaviour_candidate(from, into,
                      [&](Behaviour& b) { return set(b.sets, std::vector<Change>(), !b.sets.empty()); });
  for (std::size_t k = 0; k < 5; ++k) {
    behaviour_candidate(from, into, [&](Behaviour& b) {
      return b.next.size() > k && set(b.next[k].sets, std::vector<Change>(), !b.next[k].sets.empty());
    });
    behaviour_candidate(from, into, [&](Behaviour& b) {
      if (b.next.size() <= k) return false;
      b.next.erase(b.next.begin() + static_cast<std::ptrdiff_t>(k));
      return true;
    });
    behaviour_candidate(from, into, [&](Behaviour& b) {
      if (b.next.size() <= k || b.next[k].when == Entry::When::always) return false;
      b.next[k].when = Entry::When::always;
      return true;
    });
  }
  every_subsystem(from, into, [](auto add, const Subsystem& of) {
    if (!of.rate) add([](Specification&, Agent& agent, std::size_t s) { agent.subsystems[s].rate = true; });
    if (!of.on_error.empty())
      add([](Specification&, Agent& agent, std::size_t s) { agent.subsystems[s].on_error.clear(); });
    if (!of.start.empty())
      add([](Specification&, Agent& agent, std::size_t s) { agent.subsystems[s].start.clear(); });
  });
  for (std::size_t p = 0; p < from.properties.size(); ++p)
    for (Formula Property::*which : {&Property::first, &Property::second})
      for (const Formula& part : (from.properties[p].*which).parts) {
        into.push_back(from);
        into.back().properties[p].*which = Formula(part);
      }
}

}  // namespace

Specification shrink(Specification specification,
                     const std::function<bool(const Specification&)>& still_shows, int tries) {
  for (bool smaller = true; smaller;) {
    smaller = false;
    Candidates candidates;
    leave_out(specification, candidates);
    simplify_fleets(specification, candidates);
    simplify_channels(specification, candidates);
    simplify_behaviours(specification, candidates);
    for (Specification& candidate : candidates) {
      if (--tries < 0) return specification;
      tidy(candidate);
      if (!still_shows(candidate)) continue;
      specification = std::move(candidate);
      smaller = true;
      break;
    }
  }
  return specification;
}

}  // namespace oracle
