#include <gtest/gtest.h>

#include <string>

#include "diagnostics/diagnostics.hpp"
#include "spec/document/names.hpp"

namespace tessera::spec {
namespace {

bool is_free(const std::string& name) {
  diagnostics::Diagnostics found("", "");
  return check_system_name(name, {}, found);
}

// The namespace of a system stands beside the functions of the C library. The first and the last of them, and
// some of each letter between.
TEST(SystemNames, ThoseOfTheCLibraryAreTaken) {
  for (const char* name :
       {"a64l",   "abs",     "bsearch", "calloc", "div",    "exit",    "fopen",    "getenv", "hypot",
        "index",  "j0",      "kill",    "ldexp",  "malloc", "nan",     "open",     "pause",  "qsort",
        "rand",   "signal",  "sin",     "sinf64", "sleep",  "stat",    "strlen",   "system", "tan",
        "time",   "timer_t", "tm",      "trunc",  "ungetc", "unlink",  "usleep",   "vfork",  "vprintf",
        "wcslen", "write",   "y0",      "yn",     "fmt",    "testing", "uint16_t", "errno"})
    EXPECT_FALSE(is_free(name)) << name;
}

TEST(SystemNames, OthersAreFree) {
  for (const char* name :
       {"rover", "line_follower", "cell", "time_1", "robot", "fleet", "arm", "zu", "timers"})
    EXPECT_TRUE(is_free(name)) << name;
}

}  // namespace
}  // namespace tessera::spec
