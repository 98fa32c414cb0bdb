#include "cli/recordings/legality_check.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "cli/recordings/bags.hpp"
#include "cli/terminal.hpp"
#include "project/files/file_names.hpp"
#include "project/verification/pipeline.hpp"
#include "replay/legality.hpp"
#include "verify/hashes.hpp"

namespace tessera::cli {

namespace fs = std::filesystem;

std::vector<std::string> recordings_of(const std::string& given) {
  const fs::path folder(given);
  const bool is_run = fs::exists(folder / project::file_names::deployment);
  if (!is_run && (!fs::is_directory(folder) || fs::exists(folder / recording_file_name))) return {given};
  std::vector<std::string> all;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string file = entry.path().string();
    if (entry.path().extension() == (is_run ? ".tsr" : bag_extension) && without_segment_number(file).empty())
      all.push_back(file);
  }
  if (all.empty() && !is_run) return {given};
  std::ranges::sort(all);
  return all;
}

namespace {

replay::ProcessMap processes_of(const spec::Model& model) {
  replay::ProcessMap processes;
  for (const spec::Agent& agent : model.agents) processes.of_agents.push_back(agent.process);
  if (model.deployment)
    for (const spec::Process& process : model.deployment->processes) processes.names.push_back(process.name);
  return processes;
}

bool is_of_this_net(const std::vector<Recording>& recordings, const std::string& hash,
                    const project::Specification& specification) {
  const std::string& system = specification.model.system;
  for (const Recording& recording : recordings)
    if (recording.system != system)
      return complain(fmt::format("the recording is of the system '{}', and {} has the system '{}': name the "
                                  "specification it was made with by --spec",
                                  recording.system, specification.file.string(), system)),
             false;
  const auto other = std::ranges::find_if(
      recordings, [&](const Recording& recording) { return recording.net_hash != hash; });
  if (other == recordings.end()) return true;
  const std::string whose = other->process ? "the recording of " + other->process->name : "the recording";
  complain(fmt::format(
      "{} is of the net {}, and {} now gives {}: check out the specification it was made with, or "
      "name it with --spec",
      whose, other->net_hash, specification.file.string(), hash));
  return false;
}

}  // namespace

std::optional<replay::Legality> check_against(const std::string& specification,
                                              const std::vector<Recording>& recordings) {
  const std::optional<project::Specification> read = project::read(specification, terminal());
  if (!read) return std::nullopt;
  const bool deployed = std::ranges::any_of(recordings, replay::is_of_deployed);
  if (!deployed && recordings.size() > 1)
    return complain("several recordings are checked together only if they are of processes of one system"),
           std::nullopt;
  const std::optional<project::Nets> nets = project::build(*read, terminal());
  if (!nets || !is_of_this_net(recordings, verify::hash_of(nets->flat), *read)) return std::nullopt;
  if (!deployed) return replay::check_legal(recordings, nets->flat);
  const replay::ProcessMap processes = processes_of(read->model);
  if (const auto wrong = replay::cannot_be_joined(recordings, processes))
    return complain(*wrong), std::nullopt;
  return replay::check_legal(recordings, nets->flat, processes);
}

}  // namespace tessera::cli
