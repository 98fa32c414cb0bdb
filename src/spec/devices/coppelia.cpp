#include "spec/devices/coppelia.hpp"

#include <charconv>
#include <string>
#include <utility>

#include "diagnostics/utf8.hpp"
#include "spec/values/quantities.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

std::uint16_t read_port(const Entry& entry, std::uint16_t otherwise, Diagnostics& out) {
  const Node* text = text_of(*entry.value, entry.span, "the port", out);
  if (text == nullptr) return otherwise;
  std::uint16_t port = 0;
  const char* end = text->text.data() + text->text.size();
  const auto [behind, problem] = std::from_chars(text->text.data(), end, port);
  if (problem == std::errc{} && behind == end && port > 0) return port;
  out.error("E204", text->span,
            "the port must be a whole number from 1 to 65535, not " + in_quotes(text->text),
            "CoppeliaSim listens at 23000, unless it is told otherwise");
  return otherwise;
}

/// A name or an address of a host, without a port or a protocol.
void read_host(const Entry& entry, CoppeliaServer& server, Diagnostics& out) {
  const Node* text = text_of(*entry.value, entry.span, "the host", out, "for example host: localhost");
  if (text == nullptr) return;
  if (text->text.find_first_of("/ \t") == std::string::npos) {
    server.host = text->text;
    return;
  }
  out.error("E105", text->span, in_quotes(text->text) + " is no name and no address of a host",
            "for example host: localhost, or host: 192.168.0.7");
}

}  // namespace

CoppeliaServer read_coppelia(const Entry& entry, Diagnostics& out) {
  const Section section(*entry.value, entry.span, "coppelia", {"host", "port", "scene", "timeout"}, out);
  CoppeliaServer server;
  server.span = entry.span;
  if (const Entry* host = section.find("host")) read_host(*host, server, out);
  if (const Entry* port = section.find("port")) server.port = read_port(*port, server.port, out);
  if (const Entry* scene = section.find("scene"))
    if (const Node* text = text_of(*scene->value, scene->span, "the scene", out, "name a file")) {
      server.scene = text->text;
      server.scene_span = text->span;
    }
  if (const Entry* timeout = section.find("timeout"))
    server.timeout = read_duration(*timeout->value, timeout->span, "timeout", out).value_or(server.timeout);
  return server;
}

void refuse_beside_coppelia(const Section& simulation, Diagnostics& out) {
  if (const Entry* world = simulation.find("world"))
    out.error("E107", world->span, "'world' beside 'coppelia'", "a simulation has one world");
  for (const auto& [key, hint] : {std::pair{"track", "the floor is a part of CoppeliaSim's scene"},
                                  {"models", "put the robots into CoppeliaSim's scene"},
                                  {"checks", "remove it"},
                                  {"measures", "remove it"}})
    if (const Entry* entry = simulation.find(key))
      out.error("E102", entry->span, "only worlds of MuJoCo have " + in_quotes(key), hint);
}

}  // namespace tessera::spec
