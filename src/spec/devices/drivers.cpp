#include "spec/devices/drivers.hpp"

#include <algorithm>
#include <map>

#include "diagnostics/utf8.hpp"
#include "spec/agents/paths.hpp"
#include "spec/agents/subsystems.hpp"
#include "spec/devices/driver_kinds.hpp"
#include "spec/devices/driver_options.hpp"
#include "spec/devices/panels.hpp"
#include "spec/devices/topics.hpp"
#include "spec/document/names.hpp"
#include "spec/document/section.hpp"
#include "spec/values/quantities.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

constexpr const char* driver_hint = "for example { reflectance: eye_left, noise: 0.01 }";

/// A::B::C
bool is_class_name(std::string_view text) {
  for (;;) {
    const std::size_t colons = text.find("::");
    if (!is_identifier(text.substr(0, colons))) return false;
    if (colons == std::string_view::npos) return true;
    text.remove_prefix(colons + 2);
  }
}

class DriverReader {
 public:
  DriverReader(Devices devices, const Model& model, const AgentGroups& groups, Diagnostics& out)
      : devices_(devices), lookup_(model, groups), out_(out) {}

  std::vector<Driver> read(const Entry& section) {
    for (const Entry& entry : entries_of(*section.value, section.span, "drivers", out_)) read_one(entry);
    return std::move(drivers_);
  }

 private:
  void read_one(const Entry& entry) {
    Driver driver;
    driver.span = entry.span;
    const DriverKind* kind = read_body(entry, driver);
    Node key;
    key.kind = Node::Kind::scalar;
    key.span = entry.span;
    key.text = entry.key;
    key.verbatim = entry.span.length == entry.key.size();
    const auto path = split_device_path(key, out_);
    PathTarget target;
    KnownUpTo known = KnownUpTo::nothing;
    if (!path || !lookup_.find(*path, target, known, out_)) return;
    if (!find_real(*path, target, driver) || kind == nullptr || !fits(*kind, target, driver)) return;
    if (kind->is_panel())
      driver.panel =
          read_panel(entry, lookup_.subsystem(target).real[driver.real].type, lookup_.model(), out_);
    add(*path, target, driver);
  }

  /// Which buffer, or all of them.
  bool find_real(const BufferPath& path, const PathTarget& target, Driver& driver) {
    const Subsystem& subsystem = lookup_.subsystem(target);
    if (!path.buffer.empty()) {
      driver.real = lookup_.find_buffer(path, target, subsystem.real, "real buffer", out_);
      return driver.real.valid();
    }
    driver.real = {};
    if (!subsystem.real.empty()) return true;
    out_.error("E210", driver.span,
               in_quotes(path.subsystem) + " has no real buffers that a driver could serve");
    return false;
  }

  const DriverKind* read_body(const Entry& entry, Driver& driver) {
    if (!entry.value->is_map()) {
      out_.error("E104", entry.span, "a driver must be a map", driver_hint);
      return nullptr;
    }
    const Entry* const chosen = choose_kind(entry, driver);
    if (chosen == nullptr) {
      complain_of_kind(entry);
      return nullptr;
    }
    const DriverKind* const kind = find_kind(chosen->key);
    if (kind->is_topic()) {
      read_topic(entry, driver, out_);
      return kind;
    }
    if (kind->is_panel()) return kind;  // its controls depend on the type of the real buffer
    read_target(*chosen, *kind, driver);
    for (const Entry& key : entry.value->entries) {
      if (&key == chosen || (kind->simulated_only && find_kind(key.key) != nullptr)) continue;
      driver.option_spans.emplace(key.key, key.value->is_scalar() ? key.value->span : key.span);
      if (const auto option =
              kind->simulated_only ? read_world_option(key, out_) : read_class_option(key, out_))
        driver.options.emplace(key.key, *option);
    }
    return kind;
  }

  /// A class may have options with the names of other kinds.
  const Entry* choose_kind(const Entry& entry, Driver& driver) {
    const Entry* chosen = nullptr;
    for (const Entry& key : entry.value->entries) {
      if (find_kind(key.key) == nullptr) continue;
      if (key.key == "cpp") chosen = &key;
      if (chosen == nullptr) chosen = &key;
    }
    if (chosen == nullptr) return nullptr;
    driver.kind = chosen->key;
    if (chosen->key == "cpp") return chosen;
    for (const Entry& key : entry.value->entries)
      if (&key != chosen && find_kind(key.key) != nullptr)
        out_.error("E107", key.span, "a driver has one kind", "keep one of " + chosen->key + ", " + key.key);
    return chosen;
  }

  /// A value that is no number was probably meant to be the kind.
  void complain_of_kind(const Entry& entry) {
    const auto& entries = entry.value->entries;
    const auto stranger = std::find_if(entries.begin(), entries.end(), [](const Entry& key) {
      return !key.value->is_scalar() || !split_quantity(key.value->text);
    });
    if (stranger == entries.end()) {
      out_.error("E103", entry.span, "a driver needs a kind", driver_hint);
      return;
    }
    const std::vector<std::string> names = kind_names();
    const Hint guess = did_you_mean(stranger->key, names);
    std::string list = "there are ";
    for (const std::string& name : names) list += (&name == &names.front() ? "" : ", ") + name;
    out_.error("E101", stranger->span, "unknown driver " + in_quotes(stranger->key),
               guess.empty() ? list : guess);
  }

  void read_target(const Entry& key, const DriverKind& kind, Driver& driver) {
    if (kind.lists && key.value->is_sequence()) {
      for (const Node* item : key.value->items) add_target(*item, key, kind, driver);
      if (key.value->items.empty())
        out_.error("E104", key.span, in_quotes(key.key) + " needs a name",
                   "name " + std::string(kind.target));
      return;
    }
    add_target(*key.value, key, kind, driver);
    if (kind.name == "cpp" && !driver.targets.empty() && !is_class_name(driver.target())) {
      out_.error("E105", driver.targets[0].span, in_quotes(driver.target()) + " does not name a C++ class",
                 "for example LightSensor or robot::LightSensor");
    }
  }

  void add_target(const Node& node, const Entry& key, const DriverKind& kind, Driver& driver) {
    if (const Node* text =
            text_of(node, key.span, in_quotes(key.key), out_, "name " + std::string(kind.target)))
      driver.targets.push_back({text->text, text->span});
  }

  bool fits(const DriverKind& kind, const PathTarget& target, const Driver& driver) {
    const Subsystem& subsystem = lookup_.subsystem(target);
    std::string problem;
    const bool right_side = subsystem.kind == SubsystemKind::effector ? kind.effectors : kind.receptors;
    if (devices_ == Devices::real && kind.simulated_only) {
      problem = "driver " + in_quotes(kind.name) + " is part of the simulated world";
    } else if (!right_side) {
      problem = "driver " + in_quotes(kind.name) + " does not fit " +
                (subsystem.kind == SubsystemKind::effector ? "an effector" : "a receptor");
    } else if (devices_ == Devices::simulated && kind.is_topic()) {
      problem = "driver " + in_quotes(kind.name) + " belongs to the real robot";
    } else if ((kind.simulated_only || kind.is_topic() || kind.is_panel()) && !driver.real.valid()) {
      problem = "driver " + in_quotes(kind.name) + " serves one real buffer, not a whole subsystem";
    } else if (driver.real.valid() &&
               !has_values_of(kind, subsystem.real[driver.real].type, lookup_.model())) {
      problem = "driver " + in_quotes(kind.name) + " needs " + std::string(description_of(kind.values));
    } else {
      return true;
    }
    out_.error("E210", driver.span, problem, hint_for(kind, driver));
    return false;
  }

  [[nodiscard]] const char* hint_for(const DriverKind& kind, const Driver& driver) const {
    if (devices_ == Devices::real && kind.simulated_only)
      return "move it to simulation: drivers:, or write { cpp: CLASS }";
    if (!kind.is_topic()) return "";
    if (devices_ == Devices::simulated)
      return "move it to drivers: beside agents:; `tessera simulate --hardware` opens it in a simulated run";
    return driver.real.valid() ? "" : "name a real buffer, and give it a structure";
  }

  void add(const BufferPath& path, const PathTarget& target, const Driver& driver) {
    using Kind = Selector::Kind;
    if (path.selector.kind == Kind::variable) {
      out_.error("E112", path.index_span, "a driver stands behind one agent or all", "write [3] or [*]");
      return;
    }
    const bool all = path.selector.kind == Kind::all;
    const std::uint32_t first =
        path.selector.kind == Kind::constant ? static_cast<std::uint32_t>(path.selector.number) : 0;
    const std::uint32_t last = all ? target.group->count : first + 1;
    for (std::uint32_t number = first; number < last; ++number) {
      Driver one = driver;
      one.instance = lookup_.instance(target, number);
      if (target.group->fleet) put_number(one, number);
      if (!is_first(one)) return;
      drivers_.push_back(std::move(one));
    }
  }

  static void put_number(Driver& driver, std::uint32_t number) {
    for (Driver::Target& target : driver.targets) target.name = with_agent_number(target.name, number);
    const auto put = [&](DriverOption& option) {
      if (auto* const text = std::get_if<std::string>(&option.value))
        *text = with_agent_number(*text, number);
    };
    for (auto& [name, option] : driver.options) {
      put(option);
      for (DriverOption& value : option.list) put(value);
    }
  }

  /// Each real buffer has one driver: one of its own, or that of the whole subsystem.
  bool is_first(const Driver& driver) {
    const auto& real = lookup_.model().subsystem(driver.instance).real;
    for (const RealId buffer : real.ids()) {
      if (driver.real.valid() && buffer != driver.real) continue;
      const auto [taken, added] = lines_.emplace(std::pair(driver.instance, buffer), driver.span.line);
      if (added) continue;
      out_.error(
          "E308", driver.span,
          "a second driver for " + lookup_.model().instance_path(driver.instance) + "." + real[buffer].name,
          "the first is on " + out_.words(taken->second));
      return false;
    }
    return true;
  }

  Devices devices_;
  PathLookup lookup_;
  Diagnostics& out_;
  std::vector<Driver> drivers_;
  std::map<std::pair<InstanceId, RealId>, std::uint32_t> lines_;  ///< of the driver of a real buffer
};

}  // namespace

std::vector<Driver> read_drivers(const Entry* entry, Devices devices, const Model& model,
                                 const AgentGroups& groups, Diagnostics& out) {
  return entry == nullptr ? std::vector<Driver>() : DriverReader(devices, model, groups, out).read(*entry);
}

}  // namespace tessera::spec
