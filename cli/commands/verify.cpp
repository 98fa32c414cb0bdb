#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "cli/commands/commands.hpp"
#include "cli/terminal.hpp"
#include "cli/timing/chain_explanation.hpp"
#include "cli/timing/chain_verdicts.hpp"
#include "cli/timing/worst_run_texts.hpp"
#include "diagnostics/source.hpp"
#include "explore/explore.hpp"
#include "layers/layers.hpp"
#include "net/pnml_reader.hpp"
#include "project/files/run_folder.hpp"
#include "project/verification/pipeline.hpp"
#include "project/verification/run_files.hpp"
#include "project/verification/verdicts.hpp"
#include "project/verification/violation.hpp"
#include "tessera/nearest.hpp"
#include "tessera/printable.hpp"
#include "timing/worst/run_scenario.hpp"
#include "verify/communication/abstraction.hpp"
#include "verify/hashes.hpp"

namespace tessera::cli {

using namespace project;

namespace {

using nlohmann::json;

struct VerifyOptions {
  std::string spec = ".", json, trace, scenario, timeout = "60s", memory = "2GB", method = "any";
  std::vector<std::string> properties, without;
  std::optional<std::string> explain;  ///< a chain; empty: each verdict
  bool states = false;
};

std::atomic<bool> searches_stopped{false};
void stop_searches(int /*signal*/) { searches_stopped.store(true, std::memory_order_relaxed); }

/// During its lifetime, Ctrl-C ends the searches and not the command.
class Interruptible {
 public:
  Interruptible() : before_(std::signal(SIGINT, stop_searches)) {}
  ~Interruptible() { std::signal(SIGINT, before_); }
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;

 private:
  void (*before_)(int);
};

/// The net to judge, from a specification or from a PNML file.
struct Judged {
  std::string file;
  std::optional<Nets> nets;  ///< from a specification
  std::optional<net::Net> drawn;
  std::vector<net::Invariant> invariants;
  std::optional<spec::Model> model{};  ///< of a specification

  [[nodiscard]] const net::Net& net() const { return drawn ? *drawn : nets->flat; }
  [[nodiscard]] verify::Subject subject() const {
    if (!nets) return {net(), nullptr, invariants};
    return {net(), &nets->pages, invariants, nets->properties};
  }
  /// The names of all properties that can be requested.
  [[nodiscard]] std::vector<std::string> properties() const {
    std::vector<std::string> names = verify::default_properties_of(net());
    if (nets)
      for (const net::Property& property : nets->properties) names.push_back(property.name);
    return names;
  }
};

std::optional<Judged> load(const std::string& given) {
  Judged judged;
  diagnostics::Diagnostics source = diagnostics::load(spec_file(given));
  if (diagnostics::is_xml(source.text())) {
    judged.drawn = net::read_pnml(source);
    terminal().say(source);
    judged.file = given;
    return judged.drawn ? std::optional(std::move(judged)) : std::nullopt;
  }
  std::optional<Specification> specification = read(std::move(source), spec_file(given), terminal());
  if (!specification || !models_are_sound(*specification, terminal())) return std::nullopt;
  judged.nets = build(*specification, terminal());
  if (!judged.nets) return std::nullopt;
  judged.file = specification->file.string();
  judged.invariants = layers::invariants(specification->model, judged.nets->pages, judged.nets->flat);
  judged.model = std::move(specification->model);
  return judged;
}

std::string shown(const explore::Progress& progress) {
  return fmt::format("{:.2f} M markings, {:.2f} M/s, {} MB", static_cast<double>(progress.markings) / 1e6,
                     progress.markings_per_second / 1e6, progress.bytes >> 20U);
}

/// The limits of the whole command: reading the file counts too.
class Allowance {
 public:
  explicit Allowance(const VerifyOptions& options)
      : seconds_(parse_seconds(options.timeout, "--timeout")),
        bytes_(parse_size(options.memory, "--memory")) {}

  [[nodiscard]] std::chrono::duration<double> time_left() const {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start_;
    return std::max(std::chrono::duration<double>(0), std::chrono::duration<double>(seconds_) - spent);
  }
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
  /// Asked by the computation of times, which may take that part of the time that is left.
  [[nodiscard]] timing::StopAsked stop(double part) const {
    const auto end =
        std::chrono::steady_clock::now() +
        std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::min(time_left() * part, most));
    return [end] {
      return searches_stopped.load(std::memory_order_relaxed) || std::chrono::steady_clock::now() >= end;
    };
  }

 private:
  static constexpr std::chrono::duration<double> most = std::chrono::hours(24 * 365);

  double seconds_;
  std::uint64_t bytes_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

verify::Report judge(const Judged& judged, const VerifyOptions& options, const Allowance& allowance,
                     project::Step& step) {
  verify::ProveOptions how;
  how.time = allowance.time_left();
  how.bytes = allowance.bytes();
  if (options.method != "any") how.method = options.method;
  how.only = options.properties;
  for (const std::string& rule : options.without) static_cast<void>(reduce::switch_off(how.rules, rule));
  how.stop = &searches_stopped;
  how.progress = [&](const std::string& property, const explore::Progress& progress) {
    step.progress(property + ": " + shown(progress));
  };
  return verify::prove(judged.subject(), how);
}

// ---------------------------------------------------------------------------------------------- reports

void print_result(const Judged& judged, const verify::PropertyResult& property, bool explain) {
  fmt::print("{}", printable(text_of(judged.net(), property)));
  if (!explain) return;
  if (!property.asks.empty() && property.asks != property.name) fmt::print("  {}\n", property.asks);
  if (!property.explanation.empty()) fmt::print("  {}\n", property.explanation);
  if (property.states > 0) fmt::print("  {} markings visited\n", property.states);
  if (!property.meaning.empty()) fmt::print("  {}\n", property.meaning);
  fmt::print("  {:.3f} s\n", property.seconds);
}

/// Writes the run of a chain. chain: empty: the first one of which something asked is violated.
int write_times(const Judged& judged, const std::string& chain, const VerifyOptions& options,
                const Allowance& allowance) {
  if (verify::is_deployed(judged.net()))
    return complain("--scenario drives a controller of one process, and this system is deployed");
  const std::optional<RunToWrite> found = run_to_write(*judged.model, chain, allowance.stop(1));
  if (!found) return complain("no run of the chain was found, so there is no scenario to write");
  if (!found->run.on_simulated_clock)
    return complain("that run needs wake-ups that are late, which the simulated clock does not make");
  const auto path = [&](std::uint32_t subsystem) {
    return judged.model->instance_path(spec::InstanceId{subsystem});
  };
  write_output(
      options.scenario,
      timing::scenario_json(found->run, {found->chain, found->is_age, verify::hash_of(judged.net())}, path)
              .dump(1) +
          "\n");
  fmt::print(
      stderr,
      "scenario of the {} of {}: {}\nhint: `tessera simulate {} --scenario {}` makes the controller take "
      "these times\n",
      found->is_age ? "age" : "reaction", found->chain, options.scenario, options.spec, options.scenario);
  return ok;
}

/// Writes the run of the first violation that has one, else of a chain, or that of a warning if there is no other.
int write_scenario(const Judged& judged, const verify::Report& report, const ChainVerdicts& chains,
                   const VerifyOptions& options, const Allowance& allowance) {
  const std::string& file = options.scenario;
  const verify::PropertyResult* chosen = nullptr;
  for (const verify::PropertyResult& property : report.properties)
    if (property.has_trace && (chosen == nullptr || (chosen->warning && !property.warning)))
      chosen = &property;
  if (!chains.violated.empty() && (chosen == nullptr || chosen->warning))
    return write_times(judged, {}, options, allowance);
  if (verify::is_deployed(judged.net()))
    return complain("--scenario drives a controller of one process, and these runs are of a deployed system");
  if (judged.drawn) return complain("--scenario needs a specification: a PNML net has no controller");
  if (chosen == nullptr)
    return complain("no property is violated by a run, so there is no scenario to write");
  write_output(file, scenario_json(judged.net(), report, *chosen).dump(2) + "\n");
  fmt::print(
      stderr,
      "scenario of {}: {}\nhint: `tessera simulate {} --scenario {}` drives the controller through it\n",
      chosen->name, file, options.spec, file);
  return ok;
}

/// Counts the markings. This gets the same time once more, since a user wants the number besides the
/// verdicts.
json count_states(const Judged& judged, const VerifyOptions& options, const Allowance& allowance,
                  project::Step& step) {
  explore::Limits limits;
  limits.time = std::chrono::duration<double>(parse_seconds(options.timeout, "--timeout"));
  limits.bytes = allowance.bytes();
  limits.stop = &searches_stopped;
  limits.progress = [&](const explore::Progress& progress) { step.progress("states: " + shown(progress)); };
  const net::Net net = verify::possible_part(verify::abstract_net(judged.net()));
  const explore::Count count = explore::count(explore::PtNet(net), limits);
  json result{{"markings", count.markings}, {"edges", count.edges}, {"complete", count.complete}};
  if (!count.complete) result["why"] = count.why;
  return result;
}

bool known(const std::vector<std::string>& asked, const std::vector<std::string>& names) {
  bool all = true;
  for (const std::string& name : asked) {
    if (std::ranges::find(names, name) != names.end()) continue;
    complain(with_hint("there is no property '" + name + "'", did_you_mean(name, names)));
    all = false;
  }
  return all;
}

int exit_code_of(verify::Verdict verdict) {
  switch (verdict) {
    case verify::Verdict::holds:
      return ok;
    case verify::Verdict::violated:
      return failed;
    case verify::Verdict::unknown:
      return unknown;
  }
  return unknown;
}

verify::Verdict overall(const verify::Report& report, const ChainVerdicts& chains) {
  const verify::Verdict net = report.overall();
  if (net == verify::Verdict::violated || chains.overall == verify::Verdict::holds) return net;
  return chains.overall;
}

/// Bounds assume that the system goes on.
bool stands_still(const verify::Report& report) {
  return std::ranges::any_of(report.properties, [](const verify::PropertyResult& property) {
    return (property.name == "goes_on" || property.name == "deadlock_free") &&
           property.verdict == verify::Verdict::violated;
  });
}

/// Explains one chain, and proves nothing else.
int explain_one(const Judged& judged, const VerifyOptions& options, const Allowance& allowance) {
  if (!judged.model) return complain("a PNML net has no chains");
  const std::vector<std::string> names = chain_names(*judged.model);
  if (std::ranges::find(names, *options.explain) == names.end()) {
    Hint hint = did_you_mean(*options.explain, names);
    if (names.empty()) hint = "a chain leads from a receptor to an effector";
    if (hint.empty()) {
      constexpr std::size_t most = 5;
      hint = fmt::format("the {} are: {}", names.size() > most ? "first chains" : "chains",
                         fmt::join(names.begin(), names.begin() + std::min(most, names.size()), ", "));
    }
    complain(with_hint("there is no chain '" + *options.explain + "'", hint));
    return usage;
  }
  const Interruptible interruptible;
  try {
    project::Step step(terminal(), "computing times");
    const std::optional<ChainExplanation> chain =
        explain_chain(*judged.model, *options.explain, allowance.stop(1));
    if (!options.json.empty()) write_output(options.json, chain->json.dump(2) + "\n");
    if (options.json != "-") fmt::print("{}", printable(chain->text));
    if (!options.scenario.empty() && write_times(judged, *options.explain, options, allowance) != ok)
      return failed;
    return exit_code_of(chain->verdict);
  } catch (const timing::Interrupted&) {
    complain("the times are not computed: the time limit is reached, or the search was stopped");
    return unknown;
  }
}

int verify_command(const VerifyOptions& given) {
  VerifyOptions options = given;
  // `verify --explain robot/spec.yaml`: the word behind the option is the specification.
  if (options.explain && options.spec == "." && std::filesystem::exists(*options.explain))
    options.spec = std::exchange(*options.explain, "");
  const Allowance allowance(options);
  const std::optional<Judged> judged = load(options.spec);
  if (!judged) return exit_code_without_net();
  if (!known(options.properties, judged->properties())) return usage;
  if (options.explain && !options.explain->empty()) return explain_one(*judged, options, allowance);
  const Interruptible interruptible;
  json space;
  ChainVerdicts chains;
  verify::Report report;
  {
    project::Step step(terminal(), "verifying");
    // Bounds are found at once, but in systems of hundreds of timeouts: properties get the larger part of the time.
    if (judged->model && options.properties.empty())
      chains = chain_verdicts(*judged->model, allowance.stop(0.3), options.explain.has_value());
    report = judge(*judged, options, allowance, step);
    if (options.states) space = count_states(*judged, options, allowance, step);
  }
  const int exit_code = exit_code_of(overall(report, chains));
  if (!options.json.empty()) {
    json result = report_json(judged->net(), judged->nets ? &judged->nets->pages : nullptr, report);
    if (options.states) result["state_space"] = space;
    if (!chains.json.empty()) result["chains"] = chains.json;
    if (!chains.conduct.empty()) result["times"] = chains.conduct;
    write_output(options.json, result.dump(2) + "\n");
  }
  if (!options.trace.empty())
    write_output(options.trace, traces_json(judged->file, judged->net(),
                                            judged->nets ? &judged->nets->pages : nullptr, report)
                                        .dump(2) +
                                    "\n");
  if (!options.scenario.empty() && write_scenario(*judged, report, chains, options, allowance) != ok)
    return failed;
  if (options.json == "-" || options.trace == "-") return exit_code;
  for (const verify::PropertyResult& property : report.properties)
    print_result(*judged, property, options.explain.has_value());
  if (options.states) {
    fmt::print("states: {} markings, {} edges{}\n", space["markings"].get<std::uint64_t>(),
               space["edges"].get<std::uint64_t>(), space["complete"].get<bool>() ? "" : " and more");
  }
  fmt::print("{}", printable(options.explain ? chains.explained : chains.text));
  if (!chains.json.empty() && stands_still(report))
    fmt::print("  these times do not count: the system does not go on\n");
  return exit_code;
}

}  // namespace

void add_verify(CommandLine& app) {
  Subcommand command =
      app.add("verify", "Prove that nothing can go wrong in the net, or show the run in which it does");
  VerifyOptions& options = command.runs(verify_command);
  command.option("spec", options.spec, "Specification, the folder of its spec.yaml, or a PNML file")
      .shows_default();
  command.option("--property", options.properties, "Only this property; may be given several times");
  command.option("--timeout", options.timeout, "For all properties together, such as 60s or 2min")
      .shows_default();
  command.option("--memory", options.memory, "For the markings of a search, such as 500MB or 4GB")
      .shows_default();
  std::vector<std::string> methods = verify::method_names();
  methods.insert(methods.begin(), "any");
  command.option("--method", options.method, "Use only this method").one_of(methods).shows_default();
  std::vector<std::string> rules{"all"};
  for (const reduce::NamedRule& rule : reduce::named_rules()) rules.emplace_back(rule.name);
  command.option("--without", options.without, "Do not use this reduction (to check one against the rest)")
      .one_of(rules);
  command.flag("--states", options.states, "Count the reachable markings as well");
  command.option("--json", options.json, "Write the verdicts as JSON (- is standard output)");
  command.option("--trace", options.trace, "Write the runs that show violations as JSON");
  command.option("--scenario", options.scenario,
                 "Write the run of a violation for `tessera simulate --scenario`; with --explain CHAIN, the "
                 "run in which a command of the chain is as old as it can be");
  command.optional_value(
      "--explain", options.explain,
      "Explain each verdict: its method, and its meaning for the net with conditions; with "
      "the name of a chain: where its time goes, and what would help");
  command.footer(
      "Ends with 0 if all properties hold, 1 if one is violated or the specification is wrong,\n"
      "2 if a file cannot be read, 3 if a property is unknown. What `timing` asks of chains counts as well.\n"
      "Example: tessera verify robot/spec.yaml --explain\n"
      "         tessera verify net.pnml --states --json -");
}

}  // namespace tessera::cli
