#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "bag/live_bag.hpp"
#include "project/verification/pipeline.hpp"

namespace tessera::cli {

/// The bags of a deployed run, which are written while it goes on: one for each start of a process, with the name of
/// its recording: "process-office.mcap", "process-office@2.mcap".
class ProcessBags {
 public:
  /// Throws std::runtime_error: there is something else than a folder.
  static void check(const std::filesystem::path& folder);
  /// The folder is made if it does not exist. Throws std::runtime_error if it cannot be written.
  ProcessBags(std::filesystem::path folder, const project::Specification& specification);

  /// A process begins. Returns why there is no bag of this start; empty: there is one.
  [[nodiscard]] std::string begin(std::size_t process, const std::filesystem::path& recording);
  /// It has ended. Returns what is wrong with its bag; empty: nothing.
  [[nodiscard]] std::string end(std::size_t process);

 private:
  std::filesystem::path folder_;
  bag::Background background_;
  std::map<std::size_t, std::unique_ptr<bag::LiveBag>> live_;
};

}  // namespace tessera::cli
