#pragma once

#include <fmt/core.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "assembly/assembly.hpp"
#include "assembly/network_assembly.hpp"
#include "assembly/planted_faults.hpp"
#include "assembly/recording_setup.hpp"
#include "assembly/shared_processors.hpp"
#include "drivers/recorded_inputs.hpp"
#include "drivers/substitutes.hpp"
#include "parameters/parameters.hpp"
#include "tessera/subsystem.hpp"

namespace tessera {

/// Builds the parts in the order of their dependencies; stops at the first step that fails.
class Assembler {
 public:
  /// waker: nullptr: no thread is woken.
  Assembler(Assembly& assembly, const Clock& clock, Waker* waker, std::string& error)
      : assembly_(assembly),
        part_(assembly.part),
        system_(assembly.system),
        clock_(clock),
        waker_(waker),
        error_(error) {}

  bool run() {
    return check_version() && plan_faults() && bind() && link_ports() && compile_plans() && check_hash() &&
           read_script() && set_values() && make_devices() && make_channels() &&
           open_network(assembly_, clock_, error_) &&
           open_recording(assembly_, clock_, net_, parts_, channels_of_transitions(), error_) &&
           make_executors();
  }

  bool run(LooseParts& loose) {
    if (!check_version() || !plan_faults() || !bind() || !link_ports() || !compile_plans() || !check_hash() ||
        !set_values())
      return false;
    for (std::uint32_t index = 0; index < parts_.size(); ++index)
      for (std::uint32_t port = 0; port < parts_[index].ports.size(); ++port)
        if (!make_loose_channel(index, port, loose)) return false;
    for (std::uint32_t index = 0; index < parts_.size(); ++index)
      loose.parts.push_back({std::move(parts_[index]), plans_[index], first_transition(index)});
    return true;
  }

 protected:
  [[nodiscard]] static std::string path_of(const Instance& instance) {
    return fmt::format("{}.{}", instance.agent, instance.name);
  }

  bool fail(std::string text) {
    error_ = std::move(text);
    return false;
  }

  bool check_version() {
    if (system_.tables_version == tables_version) return true;
    return fail(
        fmt::format("this controller was generated for version {} of the tables, this runtime has version {}",
                    system_.tables_version, tables_version));
  }

  bool bind() {
    for (std::uint32_t at = 0; at < system_.instances.size(); ++at) bind(parts_.emplace_back(), at);
    if (!clock_.simulated()) find_shared_processors(parts_);
    return true;
  }

  void bind(SubsystemParts& parts, std::uint32_t index) {
    const Instance& instance = system_.instances[index];
    parts.path = path_of(instance);
    parts.instance = &instance, parts.index = index, parts.latency = system_.latency;
    parts.times = CallTimes(assembly_.options.seed, parts.path);
    parts.subsystem = instance.make();
    if (Substitutes* const of_test = assembly_.options.substitutes; of_test != nullptr)
      parts.subsystem = of_test->subsystem(index, std::move(parts.subsystem), parts.scripted);
    plant_subsystem_faults(parts, assembly_.faults, clock_);
    parts.subsystem->bind(parts.bindings);
    parts.ports.resize(instance.net->ports.size());
  }

  bool plan_faults() {
    if (!read_faults(assembly_.options, part_, assembly_.faults, error_) ||
        !outages_of(assembly_.faults, *part_.whole, assembly_.outages, error_))
      return false;
    assembly_.signals = InjectedSignals(assembly_.faults);
    return true;
  }

  /// Finds the channel behind each port.
  bool link_ports() {
    channel_of_.resize(parts_.size());
    for (std::size_t index = 0; index < parts_.size(); ++index)
      channel_of_[index].assign(parts_[index].ports.size(), nullptr);
    for (std::uint32_t index = 0; index < system_.channels.size(); ++index) {
      const Channel& channel = system_.channels[index];
      if (!link(channel, channel.from, channel.to, Side::send) ||
          !link(channel, channel.to, channel.from, Side::receive))
        return false;
      if (!part_.is_networked(index)) continue;
      link_remote(channel.from, part_.original(index).to);
      link_remote(channel.to, part_.original(index).from);
    }
    return true;
  }

  bool link(const Channel& channel, const End& end, const End& other, Side side) {
    if (!end.is_used()) return true;
    if (end.instance >= parts_.size()) return fail(fmt::format("channel {} ends nowhere", channel.name));
    SubsystemParts& parts = parts_[end.instance];
    const std::span<const Port> ports = parts.instance->net->ports;
    if (end.port >= ports.size() || ports[end.port].side != side)
      return fail(fmt::format("{} has no port {} for channel {}", parts.path, end.port, channel.name));
    PortLink& link = parts.ports[end.port];
    channel_of_[end.instance][end.port] = &channel;
    link.side = side;
    link.timeout = side == Side::send ? channel.send_timeout : channel.receive_timeout;
    if (other.is_used()) link.peer = {other.instance};
    return find_buffer(parts, ports[end.port], link);
  }

  /// The other end is in another process, of which this one knows only the name.
  void link_remote(const End& end, const End& other) {
    if (!end.is_used()) return;
    PortLink& link = port_of(end);
    link.peer = {};
    link.remote = part_.whole->processes[part_.whole->process_of[other.instance]].name;
  }

  [[nodiscard]] PortLink& port_of(const End& end) { return parts_[end.instance].ports[end.port]; }

  bool find_buffer(const SubsystemParts& parts, const Port& port, PortLink& link) {
    const auto find = [&](const auto& buffers) {
      const auto found = std::find_if(buffers.begin(), buffers.end(),
                                      [&](const auto& buffer) { return buffer.name == port.buffer; });
      link.buffer = static_cast<std::uint32_t>(found - buffers.begin());
      return found != buffers.end();
    };
    if (port.side == Side::send ? find(parts.bindings.outputs) : find(parts.bindings.inputs)) return true;
    return fail(fmt::format("{} has no buffer '{}'", parts.path, port.buffer));
  }

  /// Compiles one plan per net and kinds of channels behind its ports: a fleet shares one plan.
  bool compile_plans() {
    std::map<std::pair<const SubsystemNet*, std::vector<const FusedPlace*>>, std::shared_ptr<const Plan>>
        known;
    for (std::size_t index = 0; index < parts_.size(); ++index) {
      const SubsystemNet& net = *parts_[index].instance->net;
      std::vector<std::span<const FusedPlace>> fused;
      std::vector<const FusedPlace*> kinds;
      for (const Channel* channel : channel_of_[index]) {
        fused.push_back(channel == nullptr ? std::span<const FusedPlace>{} : channel->places);
        kinds.push_back(fused.back().data());
      }
      std::shared_ptr<const Plan>& plan = known[{&net, kinds}];
      if (plan == nullptr) {
        std::string wrong;
        std::optional<Plan> compiled = compile(net, fused, wrong);
        if (!compiled) return fail(fmt::format("the net of {}: {}", parts_[index].path, wrong));
        plan = std::make_shared<const Plan>(std::move(*compiled));
      }
      plans_.push_back(plan);
    }
    return true;
  }

  bool check_hash() {
    net_ = net_of(*part_.whole);
    const std::string hash = net_.hash();
    if (hash == system_.net_hash) return true;
    return fail(
        fmt::format("this controller's tables are not the net that was verified (tables {}, verified {})",
                    hash, system_.net_hash));
  }

  bool read_script() {
    if (assembly_.options.scenario.empty()) return true;
    if (!clock_.simulated()) return fail("a scenario needs the simulated clock");
    assembly_.scenario = read_scenario(assembly_.options.scenario, system_, net_, error_);
    return assembly_.scenario.has_value();
  }

  [[nodiscard]] std::uint32_t first_transition(std::uint32_t instance) const {
    return net_.first_of_instance[part_.instances[instance]];
  }

  [[nodiscard]] std::vector<ParameterOwner> owners() const {
    std::vector<ParameterOwner> all;
    for (const SubsystemParts& parts : parts_) all.push_back({parts.path, parts.bindings.parameters});
    return all;
  }

  /// All processes of a system may be given the same parameters: those of the others are checked, too.
  bool set_values() {
    std::vector<ParameterOwner> all = owners();
    std::vector<std::pair<std::unique_ptr<Subsystem>, Bindings>> elsewhere;
    if (!assembly_.options.parameters.empty())
      for (std::uint32_t instance = 0; instance < part_.whole->instances.size(); ++instance)
        if (!part_.has(instance)) {
          elsewhere.emplace_back(part_.whole->instances[instance].make(), Bindings{});
          elsewhere.back().first->bind(elsewhere.back().second);
          all.push_back({path_of(part_.whole->instances[instance]), elsewhere.back().second.parameters});
        }
    return set_parameters(all, assembly_.options.parameters, error_);
  }

  /// Makes the drivers; they are opened when no other step can fail any more.
  bool make_devices() {
    error_.clear();
    if (!check_hardware()) return false;
    assembly_.world = open_world(assembly_.options, error_);
    if (assembly_.world == nullptr && assembly_.options.world) return false;
    DeviceFinder finder(system_, assembly_.options, assembly_.world.get());
    for (SubsystemParts& parts : parts_) find_devices(finder, parts);
    const std::optional<Problem> wrong = finder.complaints();
    if (wrong) error_ = wrong->text;
    return !wrong;
  }

  void find_devices(DeviceFinder& finder, SubsystemParts& parts) {
    SubsystemDevices devices = finder.find(parts.path, parts.bindings);
    for (const DriverInUse& driver : devices.drivers)
      if (auto* const panel = dynamic_cast<PanelReceptor*>(driver.device)) {
        panel->follow(clock_);
        assembly_.panels.add(panel->panel());
      } else if (auto* const recorded = dynamic_cast<RecordedReceptor*>(driver.device)) {
        if (const auto wrong =
                recorded->follow(clock_, driver.path, parts.bindings.real_inputs[driver.first].encoding))
          finder.complain(*wrong);
      }
    parts.receptors = std::move(devices.receptors);
    parts.effectors = std::move(devices.effectors);
    parts.drivers = std::move(devices.drivers);
    plant_device_faults(parts, assembly_.faults, clock_);
  }

  /// Refuses hardware if simulated time could stand still or leap while it moves real devices.
  bool check_hardware() {
    const RunOptions& options = assembly_.options;
    if (options.hardware.empty()) return true;
    if (!simulates_devices(options))
      return fail("hardware in the loop is for simulated runs; this one has all");
    if (clock_.simulated() && options.monitor)
      return fail("a run with hardware in the loop cannot be paused or sped up, so it cannot be controlled");
    if (!options.scenario.empty()) return fail("a scenario cannot be followed with hardware in the loop");
    return true;
  }

  /// Makes one word for each end in this process; the links are the other side of it.
  bool make_networked(std::uint32_t index, Side side, network::Incarnation incarnation) {
    const Channel& channel = system_.channels[index];
    const End& end = side == Side::send ? channel.from : channel.to;
    if (!end.is_used()) return true;
    const CarriedValue value{value_size(end, side), encoding_of(end, side), value_type(end, side)};
    if (value.encoding == nullptr)
      return fail(fmt::format("channel {} crosses processes, and values of its type have no fixed size",
                              channel.name));
    const MadeEnd made = make_end(assembly_, clock_, index, side, value, incarnation);
    port_of(end).end = made.end;
    if (connect(end, side, *made.word)) return true;
    return fail(fmt::format("channel {}: an end uses a slot that it does not have", channel.name));
  }

  bool make_channels() {
    make_links(assembly_, clock_);
    assembly_.channels.resize(system_.channels.size());
    for (std::uint32_t index = 0; index < system_.channels.size(); ++index) {
      const bool made = part_.is_networked(index)
                            ? make_networked(index, Side::send, assembly_.incarnation) &&
                                  make_networked(index, Side::receive, assembly_.incarnation)
                            : make_local(index);
      if (!made) return false;
    }
    return true;
  }

  bool make_local(std::uint32_t index) {
    const Channel& channel = system_.channels[index];
    const std::size_t sent = value_size(channel.from, Side::send),
                      received = value_size(channel.to, Side::receive);
    if (sent != 0 && received != 0 && sent != received)
      return fail(fmt::format("channel {}: its ends have values of different sizes", channel.name));
    std::unique_ptr<SharedChannel>& word = assembly_.channels[index].of_sender;
    const ValueType* const type = !channel.from.is_used() ? value_type(channel.to, Side::receive)
                                                          : value_type(channel.from, Side::send);
    word = std::make_unique<SharedChannel>(initial_marking(channel.places), std::max(sent, received),
                                           std::max<std::size_t>(channel.slots, 1), type);
    if (!connect(channel.from, Side::send, *word) || !connect(channel.to, Side::receive, *word))
      return fail(fmt::format("channel {}: an end uses a slot that it does not have", channel.name));
    const bool to_itself = channel.from.instance == channel.to.instance;
    if (clock_.simulated() || to_itself) word->set_single_threaded();
    return true;
  }

  bool make_loose_channel(std::uint32_t instance, std::uint32_t port, LooseParts& loose) {
    const Channel& channel = *channel_of_[instance][port];
    const bool sends = parts_[instance].ports[port].side == Side::send;
    loose.channels.push_back(std::make_unique<SharedChannel>(
        0, value_size(sends ? channel.from : channel.to, parts_[instance].ports[port].side),
        std::max<std::size_t>(channel.slots, 1),
        value_type(sends ? channel.from : channel.to, parts_[instance].ports[port].side)));
    parts_[instance].ports[port].channel = loose.channels.back().get();
    return has_its_slots(instance, port) ||
           fail(fmt::format("channel {}: an end uses a slot that it does not have", channel.name));
  }

  /// 0: that end is not used.
  [[nodiscard]] std::size_t value_size(const End& end, Side side) const {
    if (!end.is_used()) return 0;
    const SubsystemParts& parts = parts_[end.instance];
    const std::uint32_t buffer = parts.ports[end.port].buffer;
    return side == Side::send ? parts.bindings.outputs[buffer].size : parts.bindings.inputs[buffer].size;
  }

  /// nullptr: values of that type have no fixed size. Precondition: the end is used.
  [[nodiscard]] const ValueEncoding* encoding_of(const End& end, Side side) const {
    const SubsystemParts& parts = parts_[end.instance];
    const std::uint32_t buffer = parts.ports[end.port].buffer;
    return side == Side::send ? parts.bindings.outputs[buffer].encoding
                              : parts.bindings.inputs[buffer].encoding;
  }

  /// nullptr: bytes, or the end is not used.
  [[nodiscard]] const ValueType* value_type(const End& end, Side side) const {
    if (!end.is_used()) return nullptr;
    const SubsystemParts& parts = parts_[end.instance];
    const std::uint32_t buffer = parts.ports[end.port].buffer;
    return side == Side::send ? parts.bindings.outputs[buffer].type : parts.bindings.inputs[buffer].type;
  }

  /// false: an operation of that end uses a slot that the channel does not have.
  bool connect(const End& end, Side side, SharedChannel& word) {
    if (!end.is_used()) return true;
    const std::uint32_t port = end.port;
    parts_[end.instance].ports[port].channel = &word;
    word.connect(side, waker_, end.instance, plans_[end.instance]->ports[port].needs);
    return has_its_slots(end.instance, port);
  }

  [[nodiscard]] bool has_its_slots(std::uint32_t instance, std::uint32_t port) const {
    const PortLink& link = parts_[instance].ports[port];
    const Does::Kind kind = link.side == Side::send ? Does::Kind::write : Does::Kind::read;
    return std::none_of(
        plans_[instance]->places.begin(), plans_[instance]->places.end(), [&](const Plan::PlaceEntry& place) {
          return place.does == kind && place.subject == port && place.slot >= link.channel->slots();
        });
  }

  /// In the form of MarkingTrack.
  [[nodiscard]] std::vector<ChannelId> channels_of_transitions() const {
    std::vector<ChannelId> channels(net_.transitions.size());
    for (std::uint32_t index = 0; index < parts_.size(); ++index)
      for (const Plan::TransitionEntry& transition : plans_[index]->transitions)
        if (transition.port.valid())
          channels[first_transition(index) + transition.index] = {static_cast<std::uint32_t>(
              channel_of_[index][transition.port.value] - system_.channels.data())};
    return channels;
  }

  bool make_executors() {
    assembly_.changes = std::make_unique<ParameterChanges>(owners());
    for (std::uint32_t index = 0; index < parts_.size(); ++index) {
      parts_[index].changes = assembly_.changes.get();
      assembly_.executors.push_back(make_executor(index));
      if (assembly_.scenario) assembly_.executors.back()->set_scenario(*assembly_.scenario);
    }
    return true;
  }

  std::unique_ptr<SubsystemExecutor> make_executor(std::uint32_t index) {
    RecordingLane* lane = assembly_.recorder == nullptr ? nullptr : assembly_.recorder->lane(index);
    return std::make_unique<SubsystemExecutor>(
        index, std::move(parts_[index]), plans_[index], first_transition(index),
        SubsystemExecutor::Shared{assembly_.control, clock_, *waker_, assembly_.options.monitor}, lane);
  }

  Assembly& assembly_;
  const ProcessPart& part_;
  const System& system_;  // of the part
  const Clock& clock_;
  Waker* waker_;
  std::string& error_;
  std::vector<SubsystemParts> parts_;                    // per instance
  std::vector<std::vector<const Channel*>> channel_of_;  // per instance and port
  std::vector<std::shared_ptr<const Plan>> plans_;       // per instance
  FlatNet net_;
};

}  // namespace tessera
