// A specification as the oracle holds it: what docs/reference/specification.md lets a user write, no more.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace oracle {

/// The static facts about an expression.
enum class Truth { no, yes, open };

/// An expression that asks how the last communication of a buffer ended, or for a memory cell, or a formula of such
/// questions. An open part is an expression that asks for something else.
struct Asked {
  enum class Kind { open, fresh, late_input, late_output, memory, negation, both, either };
  Kind kind = Kind::open;
  std::string buffer{};        // of fresh, late_input, late_output; "memory.c0"
  std::vector<Asked> parts{};  // of negation, both, either
  std::string text{};  // of memory: "memory.c0 == v1"; of a formula over all members: "any(in.x.fresh)"
  std::vector<bool> holds{};  // of memory: per value of the cell
};

/// A memory cell with few values; the first is there at the start.
struct Cell {
  std::string name;
  std::vector<std::string> values;
  int least = -1;   // of a counter; otherwise the values are names
  int initial = 0;  // position; the first is not written
  std::string goal{},
      progress{};  // of a goal: an output and an input; `values` are then its states, by their numbers
};

/// The states of a goal, by their numbers.
const std::vector<std::string>& goal_states();

/// A change of a cell: by one step, or to a value.
struct Change {
  int cell = 0, step = 0, value = 0;
};

/// `terminal` or `error`: absent, a constant, an expression, or a map of named ones.
struct Condition {
  enum class Form { absent, single, named };
  Form form = Form::absent;
  Truth single = Truth::open;
  std::vector<std::pair<std::string, Truth>> named;
  std::vector<std::optional<Asked>> asked{};  // per expression; what is absent asks nothing

  const Asked* asks(std::size_t expression) const {
    return expression < asked.size() && asked[expression] ? &*asked[expression] : nullptr;
  }
};

/// An entry of `next`.
struct Entry {
  enum class When { always, error, name, expression, until };
  std::string to;  // a behaviour or "end"
  When when = When::always;
  std::string name;           // of a terminal or error expression
  Truth truth = Truth::open;  // of the expression
  std::optional<Asked> asked{};
  std::vector<Change> sets{};
  bool leaves = false;  // not written: an error that nothing names leaves the group
};

/// An output that an iteration may skip: the transition function decides, or an expression whose truth is open.
struct Skip {
  std::string output;
  bool by_function = false;
  std::optional<Asked> asked{};
};

struct Behaviour {
  std::string name;
  Condition terminal, error;
  std::vector<Entry> next;  // empty: not written
  std::optional<std::vector<std::string>> send, receive;
  bool parallel = false;
  bool takes = false;
  std::vector<Change> sets{};  // when it begins; that of a goal is written as `orders`
  bool cancels = false;        // the goal that it orders, when it is left
  std::vector<Skip> skips{};   // of outputs in `send`, which is then written
  std::string group{};         // the name of the group in which it stands
  // The keys of a group, which has `next` and `sets` besides. An empty name is not written.
  bool is_group = false, has_until = false;
  std::optional<Asked> until{};  // what is absent asks nothing
  std::string on_error{}, start{};
  std::string each{};    // the fleet, of "v[0]", which is written once for all members as `v`
  bool may_fail = true;  // not written: of a group, whether a failure of something in it may leave it
};

struct Subsystem {
  enum class Kind { control, receptor, effector };
  std::string name;
  Kind kind = Kind::control;
  bool rate = true;
  std::vector<std::string> inputs, outputs;
  std::vector<Behaviour> behaviours;  // also those in groups; no two have one name
  std::string start;                  // empty: not written
  std::vector<Cell> memory{};
  std::string on_error{};  // empty: not written
  std::string each{};  // the fleet for whose members there are buffers: "x[0]", "x[1]", written once as `x`
};

/// An agent, a template, or a fleet: either `subsystems` or `use`.
struct Agent {
  std::string name;
  std::string use;
  int count = 0;  // 0: not a fleet
  bool ring = false;
  std::vector<Subsystem> subsystems;
};

/// One end of a channel. `index` is "", a number, "*", "i" or "i+1"; `buffer` may end with "[i]".
struct End {
  std::string agent, index, subsystem, buffer;
};

struct Channel {
  End from, to;
  bool send_blocking = false, receive_blocking = false;
  bool send_timeout = false, receive_timeout = false;
  std::string model;
};

/// One side of a communication model of the author's own.
struct ModelSide {
  struct Place {
    std::string name;
    int slot = 0;  // 0: no value is read or written here
  };
  struct Transition {
    std::string name;
    std::vector<std::string> from, to;
    bool elapsed = false;
  };
  std::vector<Place> places;
  std::vector<Transition> transitions;
};

struct Model {
  std::string name;
  int slots = 1;
  std::vector<std::pair<std::string, int>> shared;
  ModelSide send, receive;
};

/// A formula over paths. A path holds its index as written: "f[i+1].control.b"; one of a memory cell also the
/// comparison: "f[i].control.memory.c0 == v1".
struct Formula {
  enum class Kind { path, all_of, any_of, negation, any, all };
  Kind kind = Kind::path;
  std::string path;            // of path, any, all
  std::vector<Formula> parts;  // of all_of (and), any_of (or), negation
};

struct Property {
  enum class Kind { never, always, reachable, always_reachable, leads_to };
  Kind kind = Kind::never;
  std::string name;  // empty: not written
  Formula first, second;
  bool arrow = false;  // leads_to as "F => G"
};

struct Specification {
  std::vector<Model> models;
  std::vector<Agent> templates;
  std::vector<Agent> agents;
  std::vector<Channel> channels;
  std::vector<Property> properties;
};

/// The subsystems of an agent, its template looked up.
const std::vector<Subsystem>& subsystems_of(const Specification& specification, const Agent& agent);

/// "<=" of two numbers, and so on.
bool compares(const std::string& comparison, int left, int right);

/// A path without spaces: `AGENT[INDEX].SUBSYSTEM.BUFFER`.
std::string written(const End& end);
std::string written(const Formula& formula);
std::string kind_name(Property::Kind kind);

/// The whole file, as `tessera` reads it.
std::string to_yaml(const Specification& specification);

}  // namespace oracle
