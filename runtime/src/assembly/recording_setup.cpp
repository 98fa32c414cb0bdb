#include "assembly/recording_setup.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "recorder/pose_recorder.hpp"
#include "recorder/value_recorder.hpp"
#include "system/console.hpp"
#include "tessera/poses.hpp"

namespace tessera {
namespace {

using nlohmann::ordered_json;

void describe_transitions(const System& system, const FlatNet& net, ordered_json& header) {
  header["channels"] = ordered_json::array();
  for (const Channel& channel : system.channels) header["channels"].push_back(channel.name);
  header["transitions"] = ordered_json::array();
  for (const FlatNet::FlatTransition& transition : net.transitions) {
    const TransitionRole& role = transition.role;
    ordered_json& written = header["transitions"].emplace_back(
        ordered_json::array({transition.name, transition.instance, name_of(role.step)}));
    if (!role.behaviour.empty() || role.channel) written.push_back(role.behaviour);
    if (role.channel) written.push_back(*role.channel);
  }
}

void describe_deployment(const ProcessPart& part, network::Incarnation incarnation, ordered_json& header) {
  const System& whole = *part.whole;
  if (whole.processes.empty()) return;
  if (part.process)
    header["process"] = {{"name", whole.processes[*part.process].name},
                         {"number", *part.process},
                         {"incarnation", std::to_string(incarnation.value)}};
  header["processes"] = ordered_json::array();
  for (const Process& process : whole.processes) header["processes"].push_back(process.name);
  header["networked"] = ordered_json::array();
  for (const Channel& channel : whole.channels)
    if (whole.is_networked(channel)) header["networked"].push_back(channel.name);
}

void describe_values(const RunOptions& options, const ProcessPart& part, std::span<const SubsystemParts> all,
                     ordered_json& header) {
  header["parameters"] = options.parameters;
  if (options.duration) header["duration_ns"] = options.duration->count();
  header["behaviours"] = ordered_json::array();
  ordered_json buffers = ordered_json::array();
  for (const Instance& instance : part.whole->instances) {
    ordered_json& behaviours = header["behaviours"].emplace_back(ordered_json::array());
    for (const Behaviour& behaviour : instance.net->behaviours) behaviours.push_back(behaviour.name);
  }
  for (const SubsystemParts& parts : all) {
    for_buffers(parts.bindings, [&](Recording::Direction direction, const auto& buffer) {
      buffers.push_back(ordered_json::array(
          {fmt::format("{}.{}", parts.path, buffer.name), part.instances[parts.index], name_of(direction),
           buffer.encoding == nullptr ? std::string() : buffer.encoding->type()}));
    });
  }
  for (const SubsystemParts& parts : all) {
    for_memory(parts.bindings, value_limit(options), [&](const Bindings::Remembered& field) {
      buffers.push_back(ordered_json::array({fmt::format("{}.memory.{}", parts.path, field.name),
                                             part.instances[parts.index],
                                             name_of(Recording::Direction::memory), field.encoding->type()}));
    });
  }
  header["values"] = {{"limit", value_limit(options)}, {"buffers", std::move(buffers)}};
}

void describe_scene(const WorldScene& scene, ordered_json& header) {
  ordered_json bodies = ordered_json::array();
  for (const WorldScene::Body& body : scene.bodies)
    if (body.parent)
      bodies.push_back(ordered_json::array({body.name, body.agent, *body.parent}));
    else
      bodies.push_back(ordered_json::array({body.name, body.agent}));
  header["scene"] = {{"hash", hash_of(scene)}, {"bodies", std::move(bodies)}};
  if (scene.eyes.empty()) return;
  ordered_json& eyes = header["scene"]["eyes"] = ordered_json::array();
  for (const WorldScene::Eye& eye : scene.eyes)
    eyes.push_back(ordered_json::array({eye.body, eye.at_m[0], eye.at_m[1], eye.at_m[2], eye.footprint_m}));
}

/// The JSON at the beginning: the net, and with values also the fields that `tessera rerun` needs. scene:
/// nullptr: no poses are recorded.
[[nodiscard]] RecordingHeader recording_header(const ProcessPart& part, network::Incarnation incarnation,
                                               const RunOptions& options, const FlatNet& net,
                                               std::span<const SubsystemParts> all, const WorldScene* scene) {
  const System& system = *part.whole;
  ordered_json header{{"system", system.name},
                      {"net_hash", system.net_hash},
                      {"verification_hash", system.verification_hash}};
  header["verdicts"] = ordered_json::array();
  for (const VerifiedProperty& property : system.verdicts)
    header["verdicts"].push_back(
        {{"name", property.name}, {"verdict", property.verdict}, {"method", property.method}});
  header["seed"] = options.seed;
  header["clock"] = options.clock == RunOptions::Clock::simulated ? "simulated" : "steady";
  if (!options.inject.empty()) header["injected"] = options.inject;
  header["instances"] = ordered_json::array();
  for (const Instance& instance : system.instances)
    header["instances"].push_back(fmt::format("{}.{}", instance.agent, instance.name));
  describe_transitions(system, net, header);
  if (options.values != RunOptions::Values::none) describe_values(options, part, all, header);
  describe_deployment(part, incarnation, header);
  if (scene != nullptr) describe_scene(*scene, header);
  return {header.dump(-1, ' ', false, ordered_json::error_handler_t::replace), scene != nullptr};
}

/// The most bytes that a value, or a frame of poses, takes in the recording; 0: none is recorded.
[[nodiscard]] std::size_t longest_recorded_value(const RunOptions& options,
                                                 std::span<const SubsystemParts> all,
                                                 const WorldScene* scene) {
  std::size_t longest = scene == nullptr ? 0 : PoseEncoder::longest_frame(scene->bodies.size());
  if (options.values == RunOptions::Values::none) return longest;
  for (const SubsystemParts& parts : all)
    for_buffers(parts.bindings, [&](Recording::Direction, const auto& buffer) {
      if (buffer.encoding != nullptr)
        longest = std::max(longest, std::min<std::size_t>(buffer.encoding->most, value_limit(options)));
    });
  for (const SubsystemParts& parts : all)
    for_memory(parts.bindings, value_limit(options),
               [&](const Bindings::Remembered& field) { longest = std::max(longest, field.encoding->most); });
  return longest;
}

/// Gives each subsystem its recorder of values, if they are recorded.
void record_values(Assembly& assembly, std::span<SubsystemParts> all) {
  std::uint32_t buffer = 0, memory = 0;
  for (const SubsystemParts& parts : all) memory += count_buffers(parts.bindings);
  for (SubsystemParts& parts : all) {
    record_values_of(assembly, parts, buffer, memory);
    buffer += count_buffers(parts.bindings);
    memory += count_memory(parts.bindings, value_limit(assembly.options));
  }
}

void record_poses(Assembly& assembly, const Clock& clock, const WorldScene& scene) {
  std::string problem;
  assembly.scene_file = keep_scene(scene, assembly.options.recording, problem);
  if (!problem.empty()) console::print(LogLevel::warning, clock.now(), "tessera", problem);
  assembly.poses = std::make_unique<PoseRecorder>(*assembly.recorder->world_lane(), clock, scene);
  assembly.world->show_poses(*assembly.poses);
}

/// The net without the places on which several processes act: the transitions of the network between them change
/// these places as well, and are not recorded. The channels between processes have no versions.
[[nodiscard]] FlatNet without_shared_places(const System& system, FlatNet net,
                                            std::vector<ChannelId>& channels) {
  std::vector<std::optional<std::uint32_t>> owners(net.places.size());
  std::vector<bool> shared(net.places.size(), false);
  for (std::size_t index = 0; index < net.transitions.size(); ++index) {
    const FlatNet::FlatTransition& transition = net.transitions[index];
    if (channels[index].valid() && system.is_networked(system.channels[channels[index].value]))
      channels[index] = {};
    const bool is_of_network = is_of_medium(transition.role.step);
    if (transition.instance == system_instance && !is_of_network) continue;
    for (const auto* places : {&transition.inputs, &transition.outputs})
      for (const std::uint32_t place : *places) {
        std::optional<std::uint32_t>& owner = owners[place];
        const std::uint32_t process = is_of_network ? UINT32_MAX : system.process_of[transition.instance];
        shared[place] = shared[place] || owner.value_or(process) != process;
        owner = process;
      }
  }
  for (FlatNet::FlatTransition& transition : net.transitions)
    for (auto* places : {&transition.inputs, &transition.outputs})
      std::erase_if(*places, [&](std::uint32_t place) { return shared[place]; });
  return net;
}

/// nullptr: the recording has no limit, so it needs no marking.
[[nodiscard]] std::unique_ptr<MarkingTrack> track_of(const Assembly& assembly, const FlatNet& net,
                                                     std::vector<ChannelId> channels) {
  if (assembly.options.record_limit.segment_bytes == 0) return nullptr;
  if (assembly.links == nullptr) return std::make_unique<MarkingTrack>(net, std::move(channels));
  const FlatNet tracked = without_shared_places(*assembly.part.whole, net, channels);
  auto track = std::make_unique<MarkingTrack>(tracked, std::move(channels));
  // One process does not record what the layers above all of them do.
  if (assembly.options.clock != RunOptions::Clock::simulated) track->forget();
  return track;
}

}  // namespace

std::uint64_t value_limit(const RunOptions& options) {
  return options.values == RunOptions::Values::all ? UINT32_MAX : RunOptions::small_value;
}

void record_values_of(Assembly& assembly, SubsystemParts& parts, std::uint32_t first_buffer,
                      std::uint32_t first_memory) {
  const RunOptions& options = assembly.options;
  if (options.recording.empty() || options.values == RunOptions::Values::none) return;
  parts.values = std::make_unique<ValueRecorder>(parts.bindings, first_buffer, first_memory,
                                                 value_limit(options), *assembly.recorder->lane(parts.index));
}

bool open_recording(Assembly& assembly, const Clock& clock, const FlatNet& net,
                    std::span<SubsystemParts> parts, std::vector<ChannelId> channels, std::string& error) {
  const RunOptions& options = assembly.options;
  const auto instances = static_cast<std::uint32_t>(parts.size());
  if (options.recording.empty()) {
    if (assembly.tally != nullptr) assembly.recorder = Recorder::counting(instances, *assembly.tally);
    return true;
  }
  std::optional<WorldScene> scene;
  if (assembly.world != nullptr) scene = assembly.world->scene(options.drivers);
  const WorldScene* const shown = scene ? &*scene : nullptr;
  assembly.recorder = Recorder::open(
      options.recording, recording_header(assembly.part, assembly.incarnation, options, net, parts, shown),
      instances, clock.simulated() ? Recorder::Mode::direct : Recorder::Mode::threaded, error,
      longest_recorded_value(options, parts, shown), options.record_limit,
      track_of(assembly, net, std::move(channels)), assembly.part.instances);
  if (assembly.recorder == nullptr) return false;
  record_values(assembly, parts);
  if (shown != nullptr) record_poses(assembly, clock, *shown);
  return true;
}

}  // namespace tessera
