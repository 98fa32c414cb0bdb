#include "tessera/process_claim.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
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

TEST(ProcessClaim, WaitsForTheGuardianOfADeadOwner) {
  const std::array<std::string, 2> parts{"guarded claim of a test", std::to_string(getpid())};
  const pid_t owner = fork();
  if (owner == 0) {
    const ProcessClaim claim(parts);
    if (fork() == 0) usleep(300'000);  // a guardian has the socket, too
    _exit(claim.other() ? 1 : 0);
  }
  int status = -1;
  ASSERT_EQ(waitpid(owner, &status, 0), owner);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(ProcessClaim(parts).other(), std::nullopt);
}

}  // namespace
}  // namespace tessera::testing
