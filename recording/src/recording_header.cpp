#include "recording_header.hpp"

#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace tessera {
namespace {

[[nodiscard]] std::optional<Recording::Direction> direction_of(std::string_view name) {
  using enum Recording::Direction;
  for (const auto direction : {input, output, real_input, real_output, memory})
    if (name_of(direction) == name) return direction;
  return std::nullopt;
}

[[nodiscard]] bool read_buffers(const nlohmann::json& values, Recording& recording) {
  values.at("limit").get_to(recording.value_limit);
  for (const nlohmann::json& buffer : values.at("buffers")) {
    const auto direction = direction_of(buffer.at(2).get<std::string>());
    const auto instance = buffer.at(1).get<std::uint32_t>();
    if (!direction || instance >= recording.instances.size()) return false;
    recording.buffers.push_back(
        {buffer.at(0).get<std::string>(), instance, *direction, buffer.at(3).get<std::string>()});
  }
  return true;
}

/// false: a transition has a channel or a subsystem that does not exist.
[[nodiscard]] bool read_transitions(const nlohmann::json& header, Recording& recording) {
  header.at("channels").get_to(recording.channels);
  for (const nlohmann::json& written : header.at("transitions")) {
    Recording::Transition& read = recording.transitions.emplace_back(
        Recording::Transition{written.at(0).get<std::string>(), written.at(1).get<std::uint32_t>()});
    if (read.instance != system_instance && read.instance >= recording.instances.size()) return false;
    read.role.step = step_named(written.at(2).get_ref<const std::string&>());
    if (written.size() > 3) written.at(3).get_to(read.role.behaviour);
    if (written.size() > 4) read.role.channel = written.at(4).get<std::uint32_t>();
    if (read.role.channel && *read.role.channel >= recording.channels.size()) return false;
  }
  return true;
}

/// Reads the settings with which the run was started.
void read_run(const nlohmann::json& header, Recording& recording) {
  if (header.contains("parameters")) header.at("parameters").get_to(recording.parameters);
  if (header.contains("injected")) header.at("injected").get_to(recording.injected);
  if (header.contains("behaviours")) header.at("behaviours").get_to(recording.behaviours);
  if (header.contains("segment")) recording.segment = header.at("segment").get<std::uint64_t>();
  if (header.contains("duration_ns")) recording.duration_ns = header.at("duration_ns").get<std::int64_t>();
}

/// Reads the fields of a deployed system. false: the incarnation is no number.
[[nodiscard]] bool read_deployment(const nlohmann::json& header, Recording& recording) {
  if (header.contains("processes")) header.at("processes").get_to(recording.processes);
  if (header.contains("networked")) header.at("networked").get_to(recording.networked);
  if (!header.contains("process")) return true;
  const nlohmann::json& process = header.at("process");
  Recording::OneProcess& read =
      recording.process.emplace(Recording::OneProcess{.name = {}, .number = 0, .incarnation = 0});
  process.at("name").get_to(read.name);
  process.at("number").get_to(read.number);
  const auto text = process.at("incarnation").get<std::string>();
  const char* end = text.data() + text.size();
  const auto [rest, problem] = std::from_chars(text.data(), end, read.incarnation);
  return problem == std::errc{} && rest == end;
}

[[nodiscard]] bool read_scene(const nlohmann::json& scene, Recording& recording) {
  Recording::Scene& read = recording.scene.emplace();
  scene.at("hash").get_to(read.hash);
  for (const nlohmann::json& body : scene.at("bodies")) {
    read.bodies.push_back({body.at(0).get<std::string>(), body.at(1).get<std::string>()});
    if (body.size() > 2) read.bodies.back().parent = body.at(2).get<std::size_t>();
  }
  for (const nlohmann::json& eye : scene.value("eyes", nlohmann::json::array())) {
    read.eyes.push_back({eye.at(0).get<std::size_t>(), eye.at(1).get<double>(), eye.at(2).get<double>(),
                         eye.at(3).get<double>(), eye.at(4).get<double>()});
    if (read.eyes.back().body >= read.bodies.size()) return false;
  }
  return is_scene_hash(read.hash);
}

}  // namespace

bool read_header(Recording& recording) {
  const nlohmann::json header = nlohmann::json::parse(recording.header, nullptr, /*allow_exceptions=*/false);
  if (!header.is_object()) return false;
  try {
    header.at("system").get_to(recording.system);
    header.at("net_hash").get_to(recording.net_hash);
    header.at("verification_hash").get_to(recording.verification_hash);
    header.at("clock").get_to(recording.clock);
    header.at("seed").get_to(recording.seed);
    header.at("instances").get_to(recording.instances);
    if (!read_transitions(header, recording)) return false;
    read_run(header, recording);
    if (!read_deployment(header, recording)) return false;
    if (header.contains("scene") && !read_scene(header.at("scene"), recording)) return false;
    return !header.contains("values") || read_buffers(header.at("values"), recording);
  } catch (const nlohmann::json::exception&) {
    return false;
  }
}

}  // namespace tessera
