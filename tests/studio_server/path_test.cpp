#include <gtest/gtest.h>

#include <limits>

#include "server/recordings/robot_path.hpp"

namespace tessera::server_test {
namespace {

using Path = replay::Thinned<server::PathPoint>;

TEST(Path, KeepsItsBoundTheFirstAndTheLastAndIsEven) {
  for (const int count : {0, 1, 2, 9, 10, 11, 19, 20, 1000, 12345}) {
    Path path(10);
    for (int point = 0; point < count; ++point) path.add({.time_ns = point});
    const nlohmann::json rows = server::rows_of(path);
    ASSERT_LE(rows.size(), 10U);
    ASSERT_GE(rows.size(), std::min<std::size_t>(count, 5));
    if (count == 0) continue;
    EXPECT_EQ(rows.front()[0], 0);
    EXPECT_EQ(rows.back()[0], count - 1);
    for (std::size_t row = 2; row + 1 < rows.size(); ++row)
      EXPECT_EQ(rows[row][0].get<int>() - rows[row - 1][0].get<int>(), rows[1][0].get<int>());
  }
}

}  // namespace
}  // namespace tessera::server_test
