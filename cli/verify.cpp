#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <csignal>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/terminal.hpp"
#include "cli/walk.hpp"
#include "diagnostics/source.hpp"
#include "explore/explore.hpp"
#include "layers/layers.hpp"
#include "net/pnml_reader.hpp"
#include "verify/abstraction.hpp"

namespace tessera::cli {

namespace {

using nlohmann::json;

struct Options {
  std::string spec = ".", json, trace, timeout = "60s", method = "any";
  std::vector<std::string> properties;
  bool states = false, explain = false;
};

std::atomic<bool> interrupt{false};
void on_interrupt(int /*signal*/) { interrupt.store(true, std::memory_order_relaxed); }

/// Ctrl-C ends the searches, not the command, while this lives.
class Interruptible {
 public:
  Interruptible() : before_(std::signal(SIGINT, on_interrupt)) {}
  ~Interruptible() { std::signal(SIGINT, before_); }
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;

 private:
  void (*before_)(int);
};

/// "60s", "500ms", "2min" or seconds. Throws std::runtime_error for anything else.
std::chrono::duration<double> seconds_of(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string unit(end, text.data() + text.size());
  const double scale = unit.empty() || unit == "s" ? 1 : unit == "ms" ? 0.001 : unit == "min" ? 60 : 0;
  if (error != std::errc() || value < 0 || scale == 0)
    throw std::runtime_error("--timeout: '" + text + "' is no time, such as 60s, 500ms or 2min");
  return std::chrono::duration<double>(value * scale);
}

verify::Method method_of(const std::string& text) {
  if (text == "invariants") return verify::Method::invariants;
  if (text == "circuits") return verify::Method::circuits;
  if (text == "explicit") return verify::Method::exploration;
  return verify::Method::any;
}

/// The net to judge, of a specification or of a PNML file.
struct Judged {
  std::string file;
  std::optional<Nets> nets;  ///< of a specification
  std::optional<net::Net> drawn;
  std::vector<net::Invariant> invariants;
  std::vector<std::string> not_judged;  ///< properties of the specification

  [[nodiscard]] const net::Net& net() const { return drawn ? *drawn : nets->flat; }
  [[nodiscard]] verify::Subject subject() const { return {net(), nets ? &nets->pages : nullptr, invariants}; }
};

std::optional<Judged> load(const std::string& given) {
  Judged judged;
  if (given.ends_with(".pnml")) {
    diagnostics::Diagnostics source = diagnostics::load(given);
    if (!source.has_errors()) judged.drawn = net::read_pnml(source);
    print(source);
    judged.file = given;
    return judged.drawn ? std::optional(std::move(judged)) : std::nullopt;
  }
  std::optional<Specification> specification = read(given);
  if (!specification || !models_are_sound(*specification)) return std::nullopt;
  judged.nets = build(*specification);
  if (!judged.nets) return std::nullopt;
  judged.file = specification->file.string();
  for (const spec::Property& property : specification->model.properties)
    judged.not_judged.push_back(property.name);
  judged.invariants = layers::invariants(specification->model, judged.nets->pages, judged.nets->flat);
  return judged;
}

std::string shown(const explore::Progress& progress) {
  return fmt::format("{:.2f} M markings, {:.2f} M/s, {} MB", static_cast<double>(progress.markings) / 1e6,
                     progress.markings_per_second / 1e6, progress.bytes >> 20U);
}

verify::Report judge(const Judged& judged, const Options& options, Step& step) {
  verify::ProveOptions how;
  how.time = seconds_of(options.timeout);
  how.method = method_of(options.method);
  how.only = options.properties;
  how.stop = &interrupt;
  how.progress = [&](const std::string& property, const explore::Progress& progress) {
    step.progress(property + ": " + shown(progress));
  };
  return verify::prove(judged.subject(), how);
}

// ---------------------------------------------------------------------------------------------- runs

/// The net whose transitions a result's trace names.
net::Net net_of(const Judged& judged, const verify::PropertyResult& property) {
  return verify::abstract_net(judged.net(),
                              property.exceptions ? verify::Assume::exceptions : verify::Assume::conditions);
}

/// "channel.full" for every channel, where the run ends.
std::vector<std::string> channels_after(const net::Net& net, const std::vector<net::TransitionId>& run) {
  std::vector<std::string> states;
  const std::optional<explore::Marking> end = explore::replay(explore::PtNet(net), run);
  if (!end) return states;
  for (std::uint32_t place = 0; place < net.places().size(); ++place)
    if (net.places()[place].fused() && (*end)[place] > 0) states.push_back(net.places()[place].name);
  return states;
}

json trace_of(const net::Net& net, const verify::PropertyResult& property) {
  json steps = json::array();
  for (const net::TransitionId id : property.trace) {
    json step{{"transition", net[id].name}};
    if (net[id].span.line > 0) step["line"] = net[id].span.line;
    steps.push_back(std::move(step));
  }
  return steps;
}

void print_trace(const Judged& judged, const verify::PropertyResult& property) {
  constexpr std::size_t shown_steps = 60;
  const net::Net net = net_of(judged, property);
  fmt::print("  a run of {} firings shows it:\n", property.trace.size());
  const std::size_t left_out =
      property.trace.size() > shown_steps ? property.trace.size() - shown_steps : std::size_t{0};
  if (left_out > 0) fmt::print("    ... {} firings, all of them with --trace FILE\n", left_out);
  for (std::size_t index = left_out; index < property.trace.size(); ++index) {
    const net::Transition& transition = net[property.trace[index]];
    const std::string line = transition.span.line > 0 ? fmt::format(" (line {})", transition.span.line) : "";
    fmt::print("    {:3} {}{}\n", index + 1, transition.name, line);
  }
  const std::vector<std::string> channels = channels_after(net, property.trace);
  if (!channels.empty()) fmt::print("  channels at the end:\n");
  for (const std::string& state : channels) fmt::print("    {}\n", state);
}

void write_trace(const Judged& judged, const verify::Report& report, const std::string& file) {
  json traces = json::array();
  for (const verify::PropertyResult& property : report.properties) {
    if (!property.has_trace) continue;
    const net::Net net = net_of(judged, property);
    traces.push_back({{"property", property.name},
                      {"why", property.why},
                      {"firings", trace_of(net, property)},
                      {"channels", channels_after(net, property.trace)},
                      {"waits", property.waits}});
  }
  write_output(file, json{{"net", judged.file}, {"traces", traces}}.dump(2) + "\n");
}

// ---------------------------------------------------------------------------------------------- reports

void print_result(const Judged& judged, const verify::PropertyResult& property, bool explain) {
  const bool holds = property.verdict == verify::Verdict::holds;
  fmt::print("{}{}: {} ({}{}{})\n", property.warning && !holds ? "warning: " : "", property.name,
             name_of(property.verdict), property.method, property.why.empty() ? "" : ": ", property.why);
  for (const std::string& wait : property.waits) fmt::print("  {}\n", wait);
  if (property.has_trace && !property.warning) print_trace(judged, property);
  if (!explain) return;
  if (!property.explanation.empty()) fmt::print("  {}\n", property.explanation);
  if (property.states > 0) fmt::print("  {} markings visited\n", property.states);
  if (!property.meaning.empty()) fmt::print("  {}\n", property.meaning);
  fmt::print("  {:.3f} s\n", property.seconds);
}

json to_json(const Judged& judged, const verify::Report& report) {
  json properties = json::array();
  for (const verify::PropertyResult& property : report.properties) {
    json one{{"name", property.name},
             {"verdict", name_of(property.verdict)},
             {"method", property.method},
             {"why", property.why},
             {"meaning", property.meaning},
             {"explanation", property.explanation},
             {"seconds", property.seconds},
             {"states", property.states},
             {"warning", property.warning},
             {"waits", property.waits},
             {"trace", nullptr}};
    if (property.has_trace) one["trace"] = trace_of(net_of(judged, property), property);
    properties.push_back(std::move(one));
  }
  return {{"properties", properties},
          {"not_judged", judged.not_judged},
          {"net_hash", report.net_hash},
          {"verification_hash", report.verification_hash}};
}

json count_states(const Judged& judged, const Options& options, Step& step) {
  explore::Limits limits;
  limits.time = seconds_of(options.timeout);
  limits.stop = &interrupt;
  limits.progress = [&](const explore::Progress& progress) { step.progress("states: " + shown(progress)); };
  const net::Net net = verify::possible_part(verify::abstract_net(judged.net()));
  const explore::Count count = explore::count(explore::PtNet(net), limits);
  json result{{"markings", count.markings}, {"edges", count.edges}, {"complete", count.complete}};
  if (!count.complete) result["why"] = count.why;
  return result;
}

bool known(const std::vector<std::string>& asked) {
  bool all = true;
  for (const std::string& name : asked) {
    const std::vector<std::string>& names = verify::default_properties();
    if (std::ranges::find(names, name) != names.end()) continue;
    const std::string hint = diagnostics::did_you_mean(name, names);
    complain("there is no property '" + name + "'" + (hint.empty() ? "" : "; " + hint));
    all = false;
  }
  return all;
}

int exit_code_of(const verify::Report& report) {
  switch (report.overall()) {
    case verify::Verdict::holds:
      return ok;
    case verify::Verdict::violated:
      return failed;
    case verify::Verdict::unknown:
      return unknown;
  }
  return unknown;
}

int verify_command(const Options& options) {
  if (!known(options.properties)) return usage;
  const std::optional<Judged> judged = load(options.spec);
  if (!judged) return failed;
  const Interruptible interruptible;
  json result;
  verify::Report report;
  {
    Step step("verifying");
    report = judge(*judged, options, step);
    result = to_json(*judged, report);
    if (options.states) result["state_space"] = count_states(*judged, options, step);
  }
  for (const std::string& name : judged->not_judged)
    fmt::print(stderr, "tessera: warning: property '{}' of the specification is not judged\n", name);
  if (!options.json.empty()) write_output(options.json, result.dump(2) + "\n");
  if (!options.trace.empty()) write_trace(*judged, report, options.trace);
  if (options.json == "-" || options.trace == "-") return exit_code_of(report);
  for (const verify::PropertyResult& property : report.properties)
    print_result(*judged, property, options.explain);
  if (options.states) {
    const json& space = result["state_space"];
    fmt::print("states: {} markings, {} edges{}\n", space["markings"].get<std::uint64_t>(),
               space["edges"].get<std::uint64_t>(), space["complete"].get<bool>() ? "" : " and more");
  }
  return exit_code_of(report);
}

}  // namespace

void add_verify(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "verify", "Prove that nothing can go wrong in the net, or show the run in which it does");
  auto options = std::make_shared<Options>();
  command->add_option("spec", options->spec, "Specification, the folder of its spec.yaml, or a PNML file")
      ->capture_default_str();
  command->add_option("--property", options->properties, "Only this property; may be given several times");
  command->add_option("--timeout", options->timeout, "For all properties together, such as 60s or 2min")
      ->capture_default_str();
  command->add_option("--method", options->method, "Use only this method")
      ->check(CLI::IsMember({"any", "invariants", "circuits", "explicit"}))
      ->capture_default_str();
  command->add_flag("--states", options->states, "Count the reachable markings as well");
  command->add_option("--json", options->json, "Write the verdicts as JSON (- is standard output)");
  command->add_option("--trace", options->trace, "Write the runs that show violations as JSON");
  command->add_flag("--explain", options->explain,
                    "Say how each verdict came about, and what it means for the net with conditions");
  command->footer(
      "Ends with 0 if all properties hold, 1 if one is violated, 3 if one is unknown.\n"
      "Example: tessera verify robot/spec.yaml --explain\n"
      "         tessera verify net.pnml --states --json -");
  command->callback([options, &exit_code] { exit_code = verify_command(*options); });
}

}  // namespace tessera::cli
