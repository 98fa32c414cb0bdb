#include "cli/timing/worst_run_texts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ranges>

#include "cli/timing/time_texts.hpp"

namespace tessera::cli {
namespace {

/// "80 ms", to the nanosecond.
std::string instant_text(timing::Time ns) { return fmt::format("{:.12g} ms", static_cast<double>(ns) / 1e6); }

class RunStory {
 public:
  RunStory(const timing::WorstRun& run, const timing::Declared& declared, const spec::Model& model)
      : run_(run), declared_(declared), model_(model) {}

  std::string tell(bool is_age) {
    const std::uint32_t root = channel(run_.hops.front()).from;
    const timing::CallOfRun first = writer(run_.hops.front());
    if (is_age) {
      say(run_.from, path(root) + " reads its device");
    } else {
      say(run_.from, path(root) + " has read its device, and an event comes just after");
      say(first.begin, path(root) + " reads its device the next time");
    }
    for (std::size_t at = 0; at < run_.hops.size(); ++at) {
      const timing::HopOfRun& hop = run_.hops[at];
      const std::string to = path(channel(hop).to);
      say(hop.written, fmt::format("{} sends {}{}", path(channel(hop).from),
                                   at == 0 ? "the reading" : "what follows from it", took(writer(hop))));
      if (hop.looked >= 0 && hop.looked <= hop.written && hop.read > hop.written)
        say(hop.looked, to + " has received before that, and does so again an iteration later");
      say(hop.read, to + (is_age ? " receives it" : " receives it, or a newer one"));
      const timing::CallOfRun user = user_of(hop, at);
      say(user.begin, to + " uses it in its next iteration");
      if (at + 1 == run_.hops.size()) say(run_.to, to + " has given its command" + took(user));
    }
    return text_;
  }

 private:
  void say(timing::Time at, const std::string& what) {
    text_ += fmt::format("    {:>12}  {}\n", instant_text(at), what);
  }
  [[nodiscard]] const timing::Channel& channel(const timing::HopOfRun& hop) const {
    return declared_.system.channels[hop.channel];
  }
  [[nodiscard]] std::string path(std::uint32_t subsystem) const {
    return model_.instance_path(spec::InstanceId{subsystem});
  }
  [[nodiscard]] timing::CallOfRun writer(const timing::HopOfRun& hop) const {
    timing::CallOfRun last;
    for (const timing::CallOfRun& call : run_.calls)
      if (call.subsystem == channel(hop).from && call.end <= hop.written) last = call;
    return last;
  }
  /// The call that is based on the value.
  [[nodiscard]] timing::CallOfRun user_of(const timing::HopOfRun& hop, std::size_t at) const {
    const bool is_last = at + 1 == run_.hops.size();
    for (const timing::CallOfRun& call : run_.calls)
      if (call.subsystem == channel(hop).to && call.begin >= hop.read && (!is_last || call.end == run_.to))
        return call;
    return {};
  }
  /// " (its call took 8 ms, the longest)"
  [[nodiscard]] std::string took(const timing::CallOfRun& call) const {
    const timing::Subsystem& one = declared_.system.subsystems[call.subsystem];
    const timing::Time takes = call.end - call.begin;
    const char* const how = one.shortest == one.longest ? ""
                            : takes == one.longest      ? ", the longest"
                            : takes == one.shortest     ? ", the shortest"
                                                        : "";
    return fmt::format(" (its call took {}{})", instant_text(takes), how);
  }

  const timing::WorstRun& run_;
  const timing::Declared& declared_;
  const spec::Model& model_;
  std::string text_;
};

}  // namespace

std::string story_of(const timing::WorstRun& run, bool is_age, timing::Time bound,
                     const timing::Declared& declared, const spec::Model& model) {
  const char* const name = is_age ? "age" : "reaction";
  const std::string head =
      run.reaches ? fmt::format("  a run with that {}, from {} to {}:\n", name, instant_text(run.from),
                                instant_text(run.to))
                  : fmt::format("  no run was found with {} {}; the nearest takes {}, from {} to {}:\n", name,
                                time_text(bound), time_text(run.time()), instant_text(run.from),
                                instant_text(run.to));
  return head + RunStory(run, declared, model).tell(is_age);
}

std::optional<RunToWrite> run_to_write(const spec::Model& model, const std::string& name,
                                       const timing::StopAsked& stop) {
  const timing::Declared declared = timing::declared(model);
  const timing::Bounds bounds(declared.system, stop);
  timing::WorstRunSearch search(declared, bounds, stop);
  for (const timing::DeclaredChain& chain : declared.chains) {
    if (!name.empty() && chain.name != name) continue;
    timing::ChainVerdict verdict = timing::judge(declared, model, bounds, chain);
    if (name.empty() && !chain.age && !chain.reaction) continue;
    const timing::WorstRuns runs = search.find(chain);
    timing::take_runs(verdict, chain, runs);
    const bool is_age =
        verdict.age == timing::Answer::violated && verdict.reaction != timing::Answer::violated;
    const bool is_violated = is_age || verdict.reaction == timing::Answer::violated;
    if (name.empty() && !is_violated) continue;
    if (const std::optional<timing::WorstRun>& run = is_age ? runs.age : runs.reaction)
      return RunToWrite{*run, chain.name, is_age};
  }
  return std::nullopt;
}

}  // namespace tessera::cli
