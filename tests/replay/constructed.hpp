#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "tessera/recording.hpp"

/// Builds recordings event by event.
class Constructed {
 public:
  tessera::Recording recording;

  explicit Constructed(std::vector<std::string> subsystems) { recording.instances = std::move(subsystems); }

  /// `transition` is local to the subsystem: "follow.t1". Its role is that of the transition which the layers
  /// call so.
  Constructed& fire(double at_s, std::uint32_t subsystem, const std::string& transition) {
    const std::string name = recording.instances.at(subsystem) + "." + transition;
    std::uint32_t subject = 0;
    while (subject < recording.transitions.size() && recording.transitions[subject].name != name) ++subject;
    if (subject == recording.transitions.size()) {
      recording.transitions.push_back({name, subsystem, role_of(transition)});
    }
    return add(at_s, subsystem, tessera::Event::Kind::firing, subject, 0, {});
  }
  Constructed& call(double at_s, std::uint32_t subsystem) {
    return add(at_s, subsystem, tessera::Event::Kind::call, 0, 0, {});
  }
  /// Adds a value of the buffer with that number, in the header or not.
  Constructed& value(double at_s, std::uint32_t subsystem, std::uint32_t buffer, std::uint32_t flags,
                     const std::string& bytes) {
    return add(at_s, subsystem, tessera::Event::Kind::value, static_cast<std::uint32_t>(bytes.size()),
               buffer | flags << 24U, bytes);
  }
  Constructed& log(double at_s, std::uint32_t subsystem, std::uint32_t level, const std::string& text) {
    return add(at_s, subsystem, tessera::Event::Kind::log, static_cast<std::uint32_t>(text.size()), level,
               text);
  }
  Constructed& safe(double at_s, std::uint32_t subsystem, tessera::SafeEvent what, const std::string& text) {
    return add(at_s, subsystem, tessera::Event::Kind::safe, static_cast<std::uint32_t>(text.size()),
               static_cast<std::uint32_t>(what), text);
  }

 private:
  [[nodiscard]] static tessera::TransitionRole role_of(const std::string& local) {
    using tessera::Step;
    static const std::map<std::string, Step> steps{{"t1", Step::begin_sending},   {"t2", Step::end_sending},
                                                   {"t3", Step::begin_receiving}, {"t4", Step::go_on},
                                                   {"t5", Step::terminal},        {"t6", Step::error}};
    static const std::map<std::string, Step> transfers{
        {"t1o", Step::overwrite}, {"skip", Step::skip}, {"timeout", Step::timeout}};
    const std::size_t dot = local.find('.');
    if (local == "t_in") return {.step = Step::start};
    if (dot == std::string::npos)
      return {.step = Step::leave, .behaviour = local.substr(2, local.rfind('_') - 2)};
    const std::string rest = local.substr(dot + 1), last = rest.substr(rest.rfind('.') + 1);
    const bool in_block = std::ranges::count(rest, '.') > 1, on_page = rest.find('.') != rest.npos;
    const auto& known = on_page ? transfers : steps;
    const auto found = known.find(last);
    const Step otherwise = in_block ? Step::transfer : on_page ? Step::page : Step::other;
    return {.step = found != known.end() && on_page == in_block ? found->second : otherwise,
            .behaviour = local.substr(0, dot)};
  }
  Constructed& add(double at_s, std::uint32_t subsystem, tessera::Event::Kind kind, std::uint32_t subject,
                   std::uint32_t version, const std::string& text) {
    recording.entries.push_back({{.time_ns = std::llround(at_s * 1e9),
                                  .subject = subject,
                                  .version = version,
                                  .origin = subsystem * 256 + static_cast<std::uint32_t>(kind)},
                                 text});
    return *this;
  }
};
