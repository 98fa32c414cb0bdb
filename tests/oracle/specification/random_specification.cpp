#include "random_specification.hpp"

#include <algorithm>

#include "oracle/judge/flat_net.hpp"
#include "oracle/judge/groups.hpp"

namespace oracle {

namespace {
std::uint64_t mixed(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31);
}
}  // namespace

// Mixed, so that the numbers of one seed are not those of the next one, shifted.
RandomNumbers::RandomNumbers(std::uint64_t seed) : state_(mixed(mixed(seed + 0x1234567U) + seed)) {}

int RandomNumbers::below(int bound) {
  state_ += 0x9E3779B97F4A7C15U;
  return static_cast<int>(mixed(state_) % static_cast<std::uint64_t>(bound));
}

namespace {

class Generator {
 public:
  explicit Generator(std::uint64_t seed)
      : random_(seed),
        asks_(~seed),
        remembers_(seed + (1ULL << 63U)),
        skips_(seed ^ 0x5C1B5U),
        groups_(seed * 3 + 0x9209U),
        members_(seed * 5 + 0xFA1BU),
        goals_(seed * 7 + 0x60A1U) {}

  Specification make() {
    if (random_.percent(15)) specification_.models = random_models(random_);
    agents();
    const int channels = random_.below(2) + random_.below(1 + static_cast<int>(bodies_.size()) * 2);
    for (int c = 0; c < channels; ++c) channel();
    for (Agent* body : bodies_)
      for (Subsystem& subsystem : body->subsystems) behaviours(subsystem);
    if (groups_.percent(40)) group();
    if (members_.percent(60)) fan();
    if (skips_.percent(60)) skip();
    time();
    if (remembers_.percent(55)) remember();
    if (goals_.percent(60)) order();
    if (asks_.percent(60)) ask();
    if (members_.percent(60)) ask_members();
    if (random_.percent(60)) specification_.properties = random_properties(random_, specification_);
    for (Property& property : properties_of_memory(remembers_, specification_))
      specification_.properties.push_back(std::move(property));
    return std::move(specification_);
  }

 private:
  /// Small enough to visit every marking: about four subsystems in all.
  Agent body(const std::string& name, int most) {
    Agent agent;
    agent.name = name;
    agent.subsystems.push_back({"control", Subsystem::Kind::control, true, {}, {}, {}, ""});
    const int more = random_.below(most);
    for (int s = 0; s < more; ++s) {
      const bool receptor = random_.percent(50);
      agent.subsystems.push_back({(receptor ? "r" : "e") + std::to_string(s),
                                  receptor ? Subsystem::Kind::receptor : Subsystem::Kind::effector,
                                  true,
                                  {},
                                  {},
                                  {},
                                  ""});
    }
    return agent;
  }

  void agents() {
    const bool templates = random_.percent(45);
    if (templates) specification_.templates.push_back(body("t0", random_.percent(35) ? 2 : 1));
    if (templates && random_.percent(20)) {
      specification_.templates.push_back({});
      specification_.templates.back().name = "t1";
      specification_.templates.back().use = "t0";
    }
    const int number = 1 + random_.below(2) + (templates ? 0 : random_.below(2));
    for (int a = 0; a < number; ++a) {
      const std::string name = "a" + std::to_string(a);
      if (!templates || (a > 0 && random_.percent(50))) {
        specification_.agents.push_back(body(name, number == 1                 ? 4
                                                   : number == 2 && !templates ? 3
                                                   : random_.percent(70)       ? 1
                                                                               : 2));
        continue;
      }
      Agent agent;
      agent.name = name;
      agent.use = random_.of(specification_.templates).name;
      if (random_.percent(75)) agent.count = 1 + random_.below(3);
      if (agent.count > 0) agent.ring = random_.percent(50);
      specification_.agents.push_back(agent);
    }
    for (Agent& one : specification_.templates)
      if (one.use.empty()) bodies_.push_back(&one);
    for (Agent& one : specification_.agents)
      if (one.use.empty()) bodies_.push_back(&one);
  }

  Agent* body_of(const Agent& agent) {
    if (agent.use.empty()) return const_cast<Agent*>(&agent);
    for (Agent& one : specification_.templates)
      if (one.name == agent.use) return body_of(one);
    return nullptr;
  }

  /// A new input of some subsystem, fed in every agent that has it.
  void channel() {
    Agent* target = random_.of(bodies_);
    Subsystem& subsystem = target->subsystems[static_cast<std::size_t>(
        random_.below(static_cast<int>(target->subsystems.size())))];
    const std::string input = "i" + std::to_string(inputs_++);
    subsystem.inputs.push_back(input);
    for (const Agent& agent : specification_.agents)
      if (body_of(agent) == target) feed(agent, subsystem, input);
  }

  void feed(const Agent& agent, const Subsystem& subsystem, const std::string& input) {
    const Agent& from = random_.percent(45) ? agent : random_.of(specification_.agents);
    Agent* source = body_of(from);
    Subsystem& sender = source->subsystems[static_cast<std::size_t>(
        random_.below(static_cast<int>(source->subsystems.size())))];
    if (sender.outputs.empty() || !random_.percent(35))
      sender.outputs.push_back("o" + std::to_string(outputs_++));
    Channel one;
    one.from = {from.name, "", sender.name, random_.of(sender.outputs)};
    one.to = {agent.name, "", subsystem.name, input};
    manner(one);
    for (const auto& [from_index, to_index] : indices(from, agent)) {
      one.from.index = from_index;
      one.to.index = to_index;
      specification_.channels.push_back(one);
    }
  }

  /// How the members of fleets are named so that every input has one source.
  std::vector<std::pair<std::string, std::string>> indices(const Agent& from, const Agent& to) {
    if (to.count == 0) return {{from.count == 0 ? "" : std::to_string(random_.below(from.count)), ""}};
    if (from.count == to.count && random_.percent(80))
      return {{"i", random_.percent(&from == &to ? 70 : 30) ? "i+1" : "i"}};
    if (from.count == 0 && random_.percent(50)) return {{"", "*"}};
    std::vector<std::pair<std::string, std::string>> each;
    for (int i = 0; i < to.count; ++i)
      each.emplace_back(from.count == 0 ? "" : std::to_string(random_.below(from.count)), std::to_string(i));
    return each;
  }

  void manner(Channel& channel) {
    if (!specification_.models.empty() && random_.percent(45)) {
      const Model& model = random_.of(specification_.models);
      const auto waits = [](const ModelSide& side) {
        return std::any_of(side.transitions.begin(), side.transitions.end(),
                           [](const auto& t) { return t.elapsed; });
      };
      channel.model = model.name;
      channel.send_timeout = waits(model.send);
      channel.receive_timeout = waits(model.receive);
      return;
    }
    channel.send_blocking = random_.percent(35);
    channel.receive_blocking = random_.percent(55);
    channel.send_timeout = channel.send_blocking && random_.percent(20);
    channel.receive_timeout = channel.receive_blocking && random_.percent(20);
  }

  Truth truth(int open) {
    if (random_.percent(open)) return Truth::open;
    return random_.percent(50) ? Truth::yes : Truth::no;
  }

  Condition condition(int absent, int always, const char* letter) {
    Condition condition;
    if (random_.percent(absent)) return condition;
    condition.form = Condition::Form::single;
    if (random_.percent(always)) {
      condition.single = Truth::yes;
    } else if (random_.percent(45)) {
      condition.single = truth(88);
    } else {
      condition.form = Condition::Form::named;
      const int names = 1 + random_.below(3);
      for (int n = 0; n < names; ++n) condition.named.emplace_back(letter + std::to_string(n), truth(75));
    }
    return condition;
  }

  Entry entry(const Subsystem& subsystem, const Behaviour& behaviour) {
    Entry entry;
    entry.to = random_.percent(20) ? "end" : random_.of(beside(subsystem, behaviour.group));
    std::vector<std::string> names;
    for (const Condition* of : {&behaviour.terminal, &behaviour.error})
      for (const auto& [name, known] : of->named) names.push_back(name);
    const int kind = random_.below(100);
    if (kind < 40) return entry;
    if (kind < 60) {
      entry.when = Entry::When::error;
    } else if (kind < 85 && !names.empty()) {
      entry.when = Entry::When::name;
      entry.name = random_.of(names);
    } else {
      entry.when = Entry::When::expression;
      entry.truth = truth(80);
    }
    return entry;
  }

  std::optional<std::vector<std::string>> some_of(std::vector<std::string> all) {
    if (all.empty() || !random_.percent(25)) return std::nullopt;
    std::vector<std::string> chosen;
    while (!all.empty()) {
      const int at = random_.below(static_cast<int>(all.size()));
      if (random_.percent(70)) chosen.push_back(all[static_cast<std::size_t>(at)]);
      all.erase(all.begin() + at);
    }
    return chosen;
  }

  Behaviour leaf(const Subsystem& subsystem, const std::string& name, int without_terminal) {
    Behaviour behaviour;
    behaviour.name = name;
    behaviour.terminal = condition(without_terminal, 40, "t");
    behaviour.error = condition(65, 12, "f");
    behaviour.send = some_of(subsystem.outputs);
    behaviour.receive = some_of(subsystem.inputs);
    behaviour.parallel = random_.percent(30);
    behaviour.takes = random_.percent(10);
    return behaviour;
  }

  void behaviours(Subsystem& subsystem) {
    const int number = random_.percent(60) ? 1 : random_.percent(70) ? 2 : 3;
    for (int b = 0; b < number; ++b) {
      subsystem.behaviours.push_back(leaf(subsystem, "b" + std::to_string(b), b + 1 == number ? 45 : 15));
    }
    for (std::size_t b = 0; b < subsystem.behaviours.size(); ++b) {
      Behaviour& behaviour = subsystem.behaviours[b];
      if (random_.percent(12)) continue;
      const int entries = random_.percent(60) ? 0 : 1 + random_.below(3);
      for (int e = 0; e < entries; ++e) behaviour.next.push_back(entry(subsystem, behaviour));
      if (entries > 0 && random_.percent(30)) continue;
      behaviour.next.push_back({subsystem.behaviours[(b + 1) % subsystem.behaviours.size()].name,
                                Entry::When::always, "", Truth::open});
      if (random_.percent(15)) behaviour.next.back().to = "end";
    }
    if (random_.percent(15)) subsystem.start = random_.of(subsystem.behaviours).name;
  }

  /// A single agent with a buffer for each member of a fleet, and a behaviour. It has random numbers of its own.
  void fan() {
    const Agent* fleet = nullptr;
    Agent* hub = nullptr;
    for (Agent& agent : specification_.agents) {
      if (agent.count > 0) fleet = &agent;
      if (agent.count == 0 && agent.use.empty()) hub = &agent;
    }
    if (fleet == nullptr || hub == nullptr) return;
    std::swap(random_, members_);
    Subsystem& control = hub->subsystems[0];
    Subsystem& member = body_of(*fleet)->subsystems[0];
    control.each = fleet->name;
    const auto one = [&](int i) { return "[" + std::to_string(i) + "]"; };
    const bool gives = random_.percent(40);
    const std::string input = "x" + std::to_string(inputs_++), output = "o" + std::to_string(outputs_++);
    (gives ? member.inputs : member.outputs).push_back(gives ? input : output);
    for (int i = 0; i < fleet->count; ++i)
      (gives ? control.outputs : control.inputs).push_back((gives ? output : input) + one(i));
    // The body may be that of another agent, too, which needs the input as well.
    if (gives)
      for (const Agent& other : specification_.agents)
        if (body_of(other) == body_of(*fleet) && &other != fleet) feed(other, member, input);
    Channel channel;
    channel.from = {fleet->name, "i", member.name, output};
    channel.to = {hub->name, "", control.name, input + "[i]"};
    if (gives) {
      channel.from = {hub->name, "", control.name, output + "[i]"};
      channel.to = {fleet->name, "i", member.name, input};
    }
    manner(channel);
    specification_.channels.push_back(channel);
    if (random_.percent(60)) behaviours_of_members(control, *fleet, gives ? "" : input);
    std::swap(random_, members_);
  }

  /// input: of which there is one for each member; empty: none.
  void behaviours_of_members(Subsystem& control, const Agent& fleet, const std::string& input) {
    const std::string back = control.behaviours[0].name;
    const int kind = random_.below(3);
    for (int i = 0; i < fleet.count; ++i) {
      const std::string number = "[" + std::to_string(i) + "]";
      Behaviour made;
      made.name = "v" + number;
      made.each = fleet.name;
      made.send = std::vector<std::string>{};
      made.receive = input.empty() ? std::vector<std::string>{} : std::vector<std::string>{input + number};
      made.takes = true;
      made.terminal.form = Condition::Form::single;
      made.terminal.single = kind == 0 || input.empty() ? Truth::yes : Truth::open;
      if (made.terminal.single == Truth::open)
        made.terminal.asked = {Asked{Asked::Kind::fresh, input + number}};
      if (kind == 2) made.next.push_back({"v" + number, Entry::When::error, "", Truth::open});
      made.next.push_back({back, Entry::When::always, "", Truth::open});
      control.behaviours.push_back(made);
    }
    std::vector<Entry> entries;
    for (int i = 0; i < fleet.count; ++i) {
      const std::string number = "[" + std::to_string(i) + "]";
      Entry entry{"v" + number, Entry::When::expression, "", Truth::open};
      if (input.empty()) return;
      entry.asked = Asked{Asked::Kind::fresh, input + number};
      entries.push_back(entry);
    }
    Behaviour& first = control.behaviours[0];
    first.next.insert(first.next.begin(), entries.begin(), entries.end());
  }

  /// any(...), all(...) and count(...) of the inputs of all members, in place of some questions.
  void ask_members() {
    for (Agent* body : bodies_)
      for (Subsystem& subsystem : body->subsystems) {
        std::vector<Asked> members;
        for (const std::string& input : subsystem.inputs)
          if (input.ends_with("]")) members.push_back({Asked::Kind::fresh, input});
        if (members.empty()) continue;
        for (Behaviour& behaviour : subsystem.behaviours)
          if (behaviour.each.empty() && !behaviour.is_group && members_.percent(50) &&
              behaviour.terminal.form == Condition::Form::single && behaviour.terminal.single == Truth::open)
            behaviour.terminal.asked = {of_all(members)};
      }
  }

  Asked of_all(const std::vector<Asked>& members) {
    const bool any = members_.percent(50);
    Asked made = members.back();
    for (std::size_t m = members.size() - 1; m-- > 0;)
      made = {any ? Asked::Kind::either : Asked::Kind::both, "", {members[m], made}, "", {}};
    if (members.size() == 1) made = {Asked::Kind::both, "", {made, made}, "", {}};
    made.text =
        (any ? "any(in." : "all(in.") + members[0].buffer.substr(0, members[0].buffer.find('[')) + ".fresh)";
    return made;
  }

  /// The names of what stands in a group; "": of the subsystem.
  static std::vector<std::string> beside(const Subsystem& subsystem, const std::string& group) {
    std::vector<std::string> names;
    for (const Behaviour& one : subsystem.behaviours)
      if (one.group == group) names.push_back(one.name);
    return names;
  }

  /// Gives subsystems groups, to which behaviours lead. It has random numbers of its own.
  void group() {
    std::swap(random_, groups_);
    for (Agent* body : bodies_)
      for (Subsystem& subsystem : body->subsystems) {
        if (!random_.percent(55)) continue;
        const std::size_t before = subsystem.behaviours.size();
        add_group(subsystem, "", random_.percent(30) ? 2 : 1);
        const std::string name = subsystem.behaviours[before].name;
        for (std::size_t b = 0; b < before; ++b)
          for (Entry& entry : subsystem.behaviours[b].next)
            if (random_.percent(45)) entry.to = name;
        if (random_.percent(35)) subsystem.start = name;
        if (random_.percent(25)) subsystem.on_error = random_.of(beside(subsystem, ""));
      }
    std::swap(random_, groups_);
  }

  void add_group(Subsystem& subsystem, const std::string& around, int levels) {
    Behaviour group;
    group.name = "g" + std::to_string(subsystem.behaviours.size());
    group.group = around;
    group.is_group = true;
    group.has_until = random_.percent(55);
    const std::string name = group.name;
    const std::size_t at = subsystem.behaviours.size();
    subsystem.behaviours.push_back(group);
    const int number = levels > 1 ? 1 : 1 + random_.below(2);
    if (levels > 1 && random_.percent(50)) add_group(subsystem, name, levels - 1);
    for (int b = 0; b < number; ++b) {
      Behaviour behaviour = leaf(subsystem, "b" + std::to_string(subsystem.behaviours.size()), 30);
      behaviour.group = name;
      subsystem.behaviours.push_back(behaviour);
    }
    if (levels > 1 && subsystem.behaviours.size() == at + 2) add_group(subsystem, name, levels - 1);
    const std::vector<std::string> inside = beside(subsystem, name);
    if (random_.percent(40)) subsystem.behaviours[at].on_error = random_.of(inside);
    if (random_.percent(25)) subsystem.behaviours[at].start = random_.of(inside);
    for (Behaviour& one : subsystem.behaviours)
      if (one.group == name) follow(subsystem, one);
    if (around.empty()) follow(subsystem, subsystem.behaviours[at]);
  }

  /// Entries of `next`, at random.
  void follow(const Subsystem& subsystem, Behaviour& behaviour) {
    const int entries = random_.percent(20) ? 0 : 1 + random_.below(3);
    for (int e = 0; e < entries; ++e) {
      behaviour.next.push_back(entry(subsystem, behaviour));
      Entry& made = behaviour.next.back();
      if (behaviour.has_until && random_.percent(40)) {
        made.when = Entry::When::until;
        made.name.clear();
      }
    }
    if (entries > 0 && random_.percent(70))
      behaviour.next.push_back(
          {random_.of(beside(subsystem, behaviour.group)), Entry::When::always, "", Truth::open});
  }

  /// Every behaviour takes time, by a rate, a blocking channel, or `takes`. Three in a hundred
  /// need not, and are refused.
  void time() {
    for (Agent* body : bodies_)
      for (Subsystem& subsystem : body->subsystems) subsystem.rate = random_.percent(65);
    if (random_.percent(3)) return;
    const FlatNet net = flat_net(specification_);
    for (const auto& behaviour : net.behaviours)
      if (!behaviour.waits && !behaviour.of->is_group)
        const_cast<Behaviour*>(behaviour.of)->takes |=
            !net.subsystems[static_cast<std::size_t>(behaviour.subsystem)].of->rate;
  }

  /// It has random numbers of its own.
  void remember() {
    for (Agent* body : bodies_)
      for (Subsystem& subsystem : body->subsystems)
        if (remembers_.percent(50)) add_memory(remembers_, subsystem);
  }

  /// Lets some subsystems order a goal. It has random numbers of its own.
  void order() {
    for (Agent* body : bodies_)
      for (Subsystem& subsystem : body->subsystems)
        if (goals_.percent(75)) add_goal(goals_, subsystem);
  }

  /// Lets some open expressions ask how the communication ended, and more sides wait with a timeout. It has
  /// random numbers of its own.
  void ask() {
    for (Channel& channel : specification_.channels) {
      if (!channel.model.empty()) continue;
      channel.send_timeout = channel.send_timeout || (channel.send_blocking && asks_.percent(40));
      channel.receive_timeout = channel.receive_timeout || (channel.receive_blocking && asks_.percent(50));
    }
    for (Agent* body : bodies_)
      for (Subsystem& subsystem : body->subsystems)
        for (Behaviour& behaviour : subsystem.behaviours) {
          if (!behaviour.each.empty()) continue;
          for (Condition* condition : {&behaviour.terminal, &behaviour.error}) {
            if (condition->form == Condition::Form::absent) continue;
            condition->asked.resize(std::max<std::size_t>(condition->named.size(), 1));
            for (std::optional<Asked>& asked : condition->asked) asked = some_question(subsystem);
          }
          for (Entry& entry : behaviour.next)
            if (entry.when == Entry::When::expression && !entry.to.ends_with("]"))
              entry.asked = some_question(subsystem);
          for (Skip& skip : behaviour.skips)
            if (!skip.by_function) skip.asked = some_question(subsystem);
          if (behaviour.has_until) behaviour.until = some_question(subsystem);
        }
  }

  /// Lets some behaviours skip outputs. It has random numbers of its own.
  void skip() {
    for (Agent* body : bodies_)
      for (Subsystem& subsystem : body->subsystems)
        for (Behaviour& behaviour : subsystem.behaviours) {
          if (behaviour.is_group || !behaviour.each.empty()) continue;
          std::vector<Skip> skips;
          for (const std::string& output : behaviour.send.value_or(subsystem.outputs))
            if (skips_.percent(60)) skips.push_back({output, skips_.percent(30)});
          if (skips.empty()) continue;
          if (!behaviour.send) behaviour.send = subsystem.outputs;
          behaviour.skips = std::move(skips);
        }
  }

  std::optional<Asked> some_question(const Subsystem& subsystem) {
    if (!asks_.percent(65)) return std::nullopt;
    std::vector<Asked> questions;
    for (const std::string& input : subsystem.inputs) {
      questions.push_back({Asked::Kind::fresh, input});
      questions.push_back({Asked::Kind::late_input, input});
    }
    for (const std::string& output : subsystem.outputs)
      questions.push_back({Asked::Kind::late_output, output});
    for (const Cell& cell : subsystem.memory)
      for (int times = 0; times < 2; ++times) questions.push_back(random_question(asks_, cell));
    return questions.empty() ? std::nullopt : std::optional(formula(questions, 2));
  }

  /// Each question is used once.
  Asked formula(std::vector<Asked>& questions, int depth) {
    const int kind = asks_.below(100);
    if (depth > 0 && kind < 15) return {Asked::Kind::negation, "", {formula(questions, depth - 1)}};
    if (depth > 0 && kind < 55) {
      Asked first = formula(questions, depth - 1);
      Asked second = formula(questions, depth - 1);
      return {kind < 35 ? Asked::Kind::both : Asked::Kind::either, "", {std::move(first), std::move(second)}};
    }
    if (questions.empty() || kind > 92) return {};
    const int at = asks_.below(static_cast<int>(questions.size()));
    Asked question = questions[static_cast<std::size_t>(at)];
    questions.erase(questions.begin() + at);
    return question;
  }

  RandomNumbers random_, asks_, remembers_, skips_, groups_, members_, goals_;
  Specification specification_;
  std::vector<Agent*> bodies_;
  int inputs_ = 0, outputs_ = 0;
};

}  // namespace

Specification random_specification(std::uint64_t seed) { return Generator(seed).make(); }

}  // namespace oracle
