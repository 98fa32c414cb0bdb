#include "controller_run.hpp"

#include <filesystem>
#include <sstream>

#include "oracle/judge/conditions.hpp"

namespace oracle {
namespace {

namespace fs = std::filesystem;

/// Every transition function throws the dice of its subsystem, which the conditions look at.
void throw_dice(const fs::path& sources) {
  for (const auto& entry : fs::recursive_directory_iterator(sources)) {
    if (entry.path().extension() != ".cpp") continue;
    std::string text = read_text(entry.path().string());
    const std::string stub = "Outputs& out) {}",
                      body =
                          "Outputs& out) { memory.dice = (memory.dice + 77777U) * 1664525U + 1013904223U; }";
    for (std::size_t at = text.find(stub); at != std::string::npos; at = text.find(stub, at + body.size()))
      text.replace(at, stub.size(), body);
    write_text(entry.path().string(), text);
  }
}

/// The transitions of `tessera replay --csv`: time, sequence, kind, subsystem, version, text.
std::vector<std::string> firings(const std::string& csv) {
  std::vector<std::string> names;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    std::size_t at = 0;
    for (int comma = 0; comma < 2; ++comma) at = line.find(',', at) + 1;
    if (line.compare(at, 7, "firing,") == 0) names.push_back(line.substr(line.rfind(',') + 1));
  }
  return names;
}

void play(const Specification& specification, const std::vector<std::string>& names, ControllerRun& run) {
  const FlatNet flat = flat_net(specification);
  const FlatNet net = abstract_net(flat, false);
  const PetriNet player = petri_net(net);
  std::map<std::string, int> number;
  for (std::size_t t = 0; t < net.transitions.size(); ++t)
    number[net.transitions[t].name] = static_cast<int>(t);
  std::map<int, bool> by_error;
  Marking marking = player.initial;
  for (const std::string& name : names) {
    const auto at = number.find(name);
    const auto after = at == number.end()
                           ? std::nullopt
                           : fired(player.transitions[static_cast<std::size_t>(at->second)], marking);
    if (!after) {
      run.disagreements.push_back({"controller", "firing " + std::to_string(run.firings + 1) + ", " + name +
                                                     ", is not one of the net that is judged"});
      return;
    }
    const FlatTransition& by = net.transitions[static_cast<std::size_t>(at->second)];
    if (by.role == Role::t5 || by.role == Role::t6) by_error[by.subsystem] = by.role == Role::t6;
    if (by.role == Role::next) {
      const Ways ways = ways_of(net, by.behaviour, false, by.facts);
      const Following& following = by_error[by.subsystem] ? ways.after_error : ways.after_terminal;
      if (!following.entries[static_cast<std::size_t>(by.entry)])
        run.disagreements.push_back({"controller", name + " cannot be taken there"});
    }
    marking = *after;
    ++run.firings;
  }
}

}  // namespace

ControllerRun run_controller(const Specification& specification, const Command& command, unsigned seed) {
  ControllerRun run;
  const std::string folder = command.folder() + "/project";
  fs::remove_all(folder);
  fs::create_directories(folder);
  write_text(folder + "/spec.yaml", to_yaml(specification));
  const Answer generated = command.run({"generate", folder, "--stubs", "--accept-violations"});
  if (generated.exit != 0) return run;
  run.made = true;
  throw_dice(folder + "/src");
  const Answer simulated = command.run({"simulate", folder, "--for", "1s", "--seed", std::to_string(seed),
                                        "--accept-violations", "--record", folder + "/run.tsr"});
  if (!fs::exists(folder + "/run.tsr")) {
    run.disagreements.push_back(
        {"controller",
         "it does not run: " +
             simulated.errors.substr(simulated.errors.size() > 2000 ? simulated.errors.size() - 2000 : 0)});
    return run;
  }
  const Answer checked =
      command.run({"replay", folder + "/run.tsr", "--check", "--spec", folder + "/spec.yaml"});
  if (checked.exit != 0) run.disagreements.push_back({"controller", "replay --check: " + checked.output});
  play(
      specification,
      firings(
          command.run({"replay", folder + "/run.tsr", "--csv", "-", "--spec", folder + "/spec.yaml"}).output),
      run);
  if (run.firings == 0 && run.disagreements.empty())
    run.disagreements.push_back({"controller", "nothing fires: " + simulated.errors});
  return run;
}

}  // namespace oracle
