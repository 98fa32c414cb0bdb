#include "project/verification/violation.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "faults.hpp"
#include "proved.hpp"

namespace tessera::cli_test {
namespace {

namespace fs = std::filesystem;

const fs::path golden = fs::path(TESSERA_SOURCE_DIR) / "tests/golden/violations";

std::string content_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

struct Shown {
  const char* fault;
  const char* file;
};

TEST(Violation, ReadsAsReviewed) {
  const Shown shown[] = {{"crossed blocking sends", "crossed_sends.txt"},
                         {"a ring that waits on itself", "ring.txt"},
                         {"one stuck agent of 51", "one_of_51.txt"},
                         {"no initial condition may hold", "no_condition.txt"},
                         {"a request that is taken back", "taken_back.txt"},
                         {"a behaviour nobody can reach", "unreachable.txt"}};
  for (const auto& [name, file] : shown) {
    SCOPED_TRACE(name);
    const verify::Fault& fault = verify::fault(name);
    const verify::Proved faulty = verify::proved(fault.faulty);
    const std::string text = project::text_of(faulty.net, faulty[fault.property]);
    if (std::getenv("TESSERA_UPDATE_GOLDEN") != nullptr)
      std::ofstream(golden / file, std::ios::binary) << text;
    EXPECT_EQ(text, content_of(golden / file));
  }
}

}  // namespace
}  // namespace tessera::cli_test
