#include "cli/timing/conduct_texts.hpp"

#include <fmt/format.h>

#include "cli/timing/time_texts.hpp"

namespace tessera::cli {
namespace {

using nlohmann::json;

json time_json(timing::Time time) { return time >= timing::unbounded ? json(nullptr) : json(time); }
const char* fires_word(timing::Fires fires) {
  switch (fires) {
    case timing::Fires::never:
      return "never";
    case timing::Fires::may:
      return "may";
    case timing::Fires::must:
      return "must";
  }
  return "may";
}
const char* fires_text(timing::Fires fires) {
  switch (fires) {
    case timing::Fires::never:
      return "never fires";
    case timing::Fires::may:
      return "may fire";
    case timing::Fires::must:
      return "fires in every run";
  }
  return "may fire";
}
std::string at_most_text(timing::Time time) {
  return time >= timing::unbounded ? "without a bound" : "at most " + time_text(time);
}

class ConductWords {
 public:
  ConductWords(const timing::Declared& declared, const spec::Model& model)
      : declared_(declared), model_(model) {}

  [[nodiscard]] std::string path(std::uint32_t subsystem) const {
    return model_.instance_path(spec::InstanceId{subsystem});
  }
  [[nodiscard]] std::string channel(std::uint32_t channel) const {
    return model_.channel_name(model_.channels[spec::ChannelId{channel}]);
  }
  [[nodiscard]] bool is_known(std::uint32_t subsystem) const { return declared_.missing[subsystem].empty(); }
  [[nodiscard]] bool is_channel_known(std::uint32_t channel) const {
    const timing::Channel& one = declared_.system.channels[channel];
    return is_known(one.from) && is_known(one.to);
  }

  [[nodiscard]] ConductLine line(const timing::RateVerdict& rate) const {
    const std::string name = path(rate.subsystem);
    const std::string every = "every " + time_text(rate.period);
    if (rate.keeps) return {name, "begins " + every + ": it keeps its rate", false};
    if (rate.may_overrun)
      return {name,
              fmt::format("may overrun its period of {}: a call takes up to {}", time_text(rate.period),
                          time_text(declared_.system.subsystems[rate.subsystem].longest)),
              true};
    const std::string why = rate.waits_for == rate.subsystem ? "" : ": it waits for " + path(rate.waits_for);
    if (rate.longest >= timing::unbounded)
      return {name, "begins " + every + " or later, without a bound" + why, false};
    if (rate.longest <= rate.period) return {name, "begins " + every + why, false};
    return {name,
            fmt::format("begins every {} to {}{}", time_text(rate.period), time_text(rate.longest), why),
            true};
  }

  [[nodiscard]] ConductLine line(const timing::WaitVerdict& wait) const {
    const timing::Channel& ends = declared_.system.channels[wait.channel];
    const std::string other = path(wait.receives ? ends.from : ends.to);
    const char* const what = wait.receives ? "receive" : "send";
    const std::string whom = fmt::format("for {} ({})", other, channel(wait.channel));
    if (wait.fires == timing::Fires::must)
      return {path(wait.subsystem),
              fmt::format("the timeout of its {} {} fires in every run: again and again, the wait would last "
                          "at least {}, and the timeout is {}",
                          what, whom, least_time_text(wait.certain), time_text(wait.timeout)),
              true};
    std::string text = fmt::format("its {} waits {} {}", what, at_most_text(wait.longest), whom);
    if (wait.timeout > 0)
      text += fmt::format(": its timeout of {} {}", time_text(wait.timeout), fires_text(wait.fires));
    return {path(wait.subsystem), text, wait.timeout > 0 && wait.fires != timing::Fires::never};
  }

  [[nodiscard]] ConductLine line(const timing::StaleVerdict& stale) const {
    const bool must = stale.fires == timing::Fires::must;
    return {path(stale.subsystem),
            fmt::format("the value of {} gets {}: `stale` ({}) {}", channel(stale.channel),
                        must ? fmt::format("at least {} old, again and again", least_time_text(stale.certain))
                             : at_most_text(stale.oldest) + " old",
                        time_text(stale.stale), fires_text(stale.fires)),
            stale.fires != timing::Fires::never};
  }

 private:
  const timing::Declared& declared_;
  const spec::Model& model_;
};

}  // namespace

std::vector<ConductLine> lines_of(const timing::Conduct& conduct, const timing::Declared& declared,
                                  const spec::Model& model) {
  const ConductWords words(declared, model);
  std::vector<ConductLine> lines;
  for (const timing::RateVerdict& rate : conduct.rates)
    if (words.is_known(rate.subsystem)) lines.push_back(words.line(rate));
  for (const timing::WaitVerdict& wait : conduct.waits)
    if (words.is_channel_known(wait.channel)) lines.push_back(words.line(wait));
  for (const timing::StaleVerdict& stale : conduct.stale)
    if (words.is_channel_known(stale.channel)) lines.push_back(words.line(stale));
  return lines;
}

json conduct_json(const timing::Conduct& conduct, const timing::Declared& declared,
                  const spec::Model& model) {
  const ConductWords words(declared, model);
  json rates = json::array(), waits = json::array(), stale = json::array();
  for (const timing::RateVerdict& rate : conduct.rates) {
    if (!words.is_known(rate.subsystem)) {
      rates.push_back({{"subsystem", words.path(rate.subsystem)},
                       {"period_ns", rate.period},
                       {"why", declared.missing[rate.subsystem]}});
      continue;
    }
    json one{{"subsystem", words.path(rate.subsystem)},
             {"period_ns", rate.period},
             {"keeps", rate.keeps},
             {"longest_ns", time_json(rate.longest)},
             {"may_overrun", rate.may_overrun}};
    if (rate.waits_for != rate.subsystem) one["waits_for"] = words.path(rate.waits_for);
    rates.push_back(std::move(one));
  }
  for (const timing::WaitVerdict& wait : conduct.waits) {
    json one{{"subsystem", words.path(wait.subsystem)},
             {"channel", words.channel(wait.channel)},
             {"of", wait.receives ? "receive" : "send"},
             {"longest_ns", time_json(wait.longest)}};
    if (wait.timeout > 0)
      one.update(
          {{"timeout_ns", wait.timeout}, {"fires", fires_word(wait.fires)}, {"certain_ns", wait.certain}});
    waits.push_back(std::move(one));
  }
  for (const timing::StaleVerdict& one : conduct.stale)
    stale.push_back({{"subsystem", words.path(one.subsystem)},
                     {"channel", words.channel(one.channel)},
                     {"stale_ns", one.stale},
                     {"oldest_ns", time_json(one.oldest)},
                     {"certain_ns", one.certain},
                     {"fires", fires_word(one.fires)}});
  return {{"rates", std::move(rates)}, {"waits", std::move(waits)}, {"stale", std::move(stale)}};
}

}  // namespace tessera::cli
