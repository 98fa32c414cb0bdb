#include "network/dds/settings.hpp"

#include "network/carrier.hpp"
#include "network/dds/setup_error.hpp"

namespace tessera::dds {
namespace {

std::string element(const std::string& name, const std::string& content) {
  return "<" + name + ">" + content + "</" + name + ">";
}

/// On loopback, a datagram is as long as possible. Elsewhere it fits into one frame, because a datagram of
/// ten frames is lost when any of them is.
std::string sizes(bool is_loopback) {
  return element("MaxMessageSize", is_loopback ? "65000 B" : "1456 B") +
         element("FragmentSize", is_loopback ? "32000 B" : "1344 B");
}

std::string peers_of(const Location& location) {
  std::string peers;
  for (const std::string& peer : location.peers) peers += "<Peer Address=\"" + peer + "\"/>";
  return element("Peers", peers);
}

/// An interruption of the network that is shorter than the lease has no effect on discovery. After a longer
/// one, the processes find each other again within the interval of discovery (SPDP). Both cost traffic
/// (docs/use/scale.md).
std::string discovery(int domain, const Location& location, std::chrono::seconds lease) {
  return element("Discovery",
                 element("ExternalDomainId", std::to_string(domain)) + element("ParticipantIndex", "auto") +
                     element("MaxAutoParticipantIndex", std::to_string(most_processes_on_a_host)) +
                     peers_of(location) + element("SPDPInterval", "4 s") +
                     element("LeaseDuration", std::to_string(lease.count()) + " s"));
}

/// A writer is never held back: it keeps one value of each channel, so its memory is bounded.
///
/// A writer asks once a second (not ten times) whether everything has arrived. While many processes meet at
/// once, most of the traffic would be such questions and their answers. The protocol of channels repeats
/// sooner than either.
std::string writing() {
  return element(
      "Internal",
      element("HeartbeatInterval", "1 s") +
          element("Watermarks", element("WhcLow", "1 kB") + element("WhcHigh", "1 GiB") +
                                    element("WhcHighInit", "1 GiB") + element("WhcAdaptive", "false")));
}

}  // namespace

int first_port(int domain) { return 7400 + 250 * domain + 10; }

std::string settings(int domain, const Location& location, std::chrono::seconds lease) {
  if (domain < 0 || domain > network::last_domain)
    throw SetupError("there is no domain " + std::to_string(domain) + ": use one of 0 to " +
                     std::to_string(network::last_domain));
  const std::string interface =
      "<Interfaces><NetworkInterface address=\"" + location.address + "\" multicast=\"false\"/></Interfaces>";
  return element("CycloneDDS", "<Domain Id=\"any\">" +
                                   element("General", interface + element("AllowMulticast", "false") +
                                                          sizes(location.is_loopback)) +
                                   discovery(domain, location, lease) + writing() +
                                   element("Tracing", element("Verbosity", "none")) + "</Domain>");
}

}  // namespace tessera::dds
