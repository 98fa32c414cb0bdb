#include "cli/recordings/process_bags.hpp"

#include <fmt/core.h>

#include <stdexcept>
#include <system_error>
#include <utility>

#include "cli/outputs.hpp"
#include "cli/recordings/bags.hpp"
#include "mcap/records.hpp"

namespace tessera::cli {

void ProcessBags::check(const std::filesystem::path& folder) {
  if (std::filesystem::exists(folder) && !std::filesystem::is_directory(folder))
    throw std::runtime_error(
        fmt::format("--mcap names a folder for the bags of all processes, and {} is none", folder.string()));
}

ProcessBags::ProcessBags(std::filesystem::path folder, const project::Specification& specification)
    : folder_(std::move(folder)), background_(background_of(specification)) {
  check(folder_);
  std::error_code problem;
  std::filesystem::create_directories(folder_, problem);
  if (problem)
    throw std::runtime_error(
        fmt::format("cannot write the folder {}: {}", folder_.string(), problem.message()));
}

std::string ProcessBags::begin(std::size_t process, const std::filesystem::path& recording) {
  try {
    const std::string file = (folder_ / recording.filename().replace_extension(bag_extension)).string();
    check_replaceable(file, mcap::magic);
    live_[process] = std::make_unique<bag::LiveBag>(recording.string(), file, background_, bag_library);
    return {};
  } catch (const std::exception& problem) {
    return problem.what();
  }
}

std::string ProcessBags::end(std::size_t process) {
  const auto found = live_.find(process);
  if (found == live_.end()) return {};
  const std::string problem = found->second->finish();
  live_.erase(found);
  return problem;
}

}  // namespace tessera::cli
