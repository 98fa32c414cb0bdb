#pragma once

#include <string>
#include <vector>

#include "spec/model/model.hpp"

namespace tessera::project {

/// A unit of systemd that runs a controller, or one process of a deployed system.
struct ServiceUnit {
  std::string host;  ///< its machine; empty: none was given
  std::string file;  ///< "crossroads-cart-0.service"
  std::string text;
};

/// The differences between units of one kind.
struct ServiceOptions {
  /// systemd makes a user for the units of the system while they run, in these groups besides. Their control
  /// sockets
  /// are in /run/SYSTEM/tessera, so that one emergency stop reaches all. false: root runs them.
  bool own_user = false;
  std::vector<std::string> groups;
  bool parameters = false;     ///< it reads /opt/SYSTEM/parameters
  bool own_libraries = false;  ///< /opt/SYSTEM has libraries that no Debian package has
};

/// A name of the specification as file names have it: "cart[0]" is "cart-0".
[[nodiscard]] std::string plain_name(const std::string& name);

/// One unit per process of the deployment; without one, a single unit. The controller is expected at
/// /opt/SYSTEM/controller, and the recordings go to /var/lib/SYSTEM.
///
/// Threads: pure.
[[nodiscard]] std::vector<ServiceUnit> service_units(const spec::Model& model,
                                                     const ServiceOptions& options = {});

/// Writes them to a folder, in one folder per host if there are several. Returns the paths. Throws
/// std::runtime_error if a file cannot be written, or if one is there that does not begin as these do.
std::vector<std::string> write_service_units(const spec::Model& model, const std::string& folder);

}  // namespace tessera::project
