#include "tessera/process_claim.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <optional>
#include <string>

namespace tessera::testing {
namespace {

TEST(ProcessClaim, NamesItsOwnerHoweverManyHaveAskedBefore) {
  const std::array<std::string, 2> parts{"claim of a test", std::to_string(getpid())};
  {
    const ProcessClaim first(parts);
    EXPECT_EQ(first.other(), std::nullopt);
    for (int asked = 0; asked < 200; ++asked) {
      const ProcessClaim other(parts);
      EXPECT_EQ(other.other(), getpid()) << "after " << asked;
    }
  }
  EXPECT_EQ(ProcessClaim(parts).other(), std::nullopt);
}

}  // namespace
}  // namespace tessera::testing
