#pragma once

#include <cmath>
#include <string>

#include "tessera/old_names.hpp"
#include "tessera/recording.hpp"

/// Builds recordings event by event.
class Constructed {
 public:
  tessera::Recording recording;

  explicit Constructed(std::vector<std::string> subsystems) { recording.instances = std::move(subsystems); }

  /// `transition` is local to the subsystem: "follow.t1". Its role is what this name says.
  Constructed& fire(double at_s, std::uint32_t subsystem, const std::string& transition) {
    const std::string name = recording.instances.at(subsystem) + "." + transition;
    std::uint32_t subject = 0;
    while (subject < recording.transitions.size() && recording.transitions[subject].name != name) ++subject;
    if (subject == recording.transitions.size()) {
      const std::string& path = recording.instances.at(subsystem);
      recording.transitions.push_back({name, subsystem, tessera::role_of_old_name(name, path)});
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
