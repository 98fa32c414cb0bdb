#pragma once

#include <string>
#include <vector>

/// Specifications with one mistake each, and their corrected twins.
namespace tessera::verify {

struct Fault {
  const char* name;
  std::string faulty, corrected;
  const char* property;  ///< that finds it
};
[[nodiscard]] const std::vector<Fault>& faults();

/// By its name, which has to be one of faults().
[[nodiscard]] const Fault& fault(const std::string& name);

}  // namespace tessera::verify
