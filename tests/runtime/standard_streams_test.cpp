#include "tessera/standard_streams.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <initializer_list>

#include "child_run.hpp"

namespace tessera {
namespace {

TEST(StandardStreams, ThatAreClosedGiveTheirNumbersToNoOtherFile) {
  testing::ChildRun child([](testing::CommandLog&) {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) close(stream);
    open_missing_streams();
    const int file = open("/dev/null", O_RDWR);
    const bool refused = write(STDOUT_FILENO, "x", 1) < 0 && write(STDERR_FILENO, "x", 1) < 0;
    return file > STDERR_FILENO && refused ? 0 : 1;
  });
  EXPECT_EQ(child.wait(), 0);
}

TEST(StandardStreams, ThatAreOpenStayAsTheyAre) {
  testing::ChildRun child([](testing::CommandLog&) {
    const int file = open("/dev/null", O_WRONLY);
    dup2(file, STDOUT_FILENO);
    close(STDIN_FILENO);
    open_missing_streams();
    return write(STDOUT_FILENO, "x", 1) == 1 ? 0 : 1;
  });
  EXPECT_EQ(child.wait(), 0);
}

}  // namespace
}  // namespace tessera
