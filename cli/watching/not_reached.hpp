#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/control_messages.hpp"

namespace tessera::cli {

/// Which processes of deployed systems a command of this machine cannot have reached. A system whose processes meet on
/// loopback has none on other machines.
class NotReached {
 public:
  /// The command went to this process; snapshot: its first.
  void reached(const Snapshot& snapshot);
  /// The command went to a controller of that name: SYSTEM.PROCESS.NUMBER.
  void tried(const std::string& controller) { tried_.insert(controller.substr(0, controller.rfind('.'))); }
  /// "line: cart[0] (cart0.local), cart[1] (cart1.local)" for each system that has some.
  [[nodiscard]] std::vector<std::string> texts() const;

 private:
  std::map<std::string, Snapshot::Deployment> systems_;
  std::set<std::string> tried_;  ///< SYSTEM.PROCESS
};

}  // namespace tessera::cli
