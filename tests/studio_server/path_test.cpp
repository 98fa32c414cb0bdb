#include <gtest/gtest.h>

#include <limits>

#include "server/recordings/robot_path.hpp"

namespace tessera::server_test {
namespace {

using server::PathPoint;
using server::PathReader;
using server::ThinnedPath;

TEST(PathReader, ReadsLinesThatComeInPieces) {
  PathReader reader;
  EXPECT_TRUE(reader.feed("t_s,x_m,y_m,heading_rad,eye_x_m,eye_y_m,on_line\n0.5,1,").empty());
  const std::vector<PathPoint> points = reader.feed("-2,0.25,0,0,1\n1.5,3,4,5,0,0,1\n2,");
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[0].time_ns, 500'000'000);
  EXPECT_EQ(points[0].x_m, 1);
  EXPECT_EQ(points[0].y_m, -2);
  EXPECT_EQ(points[0].heading_rad, 0.25);
  EXPECT_EQ(points[1].time_ns, 1'500'000'000);
}

TEST(PathReader, PassesOverWhatIsNoPoint) {
  PathReader reader;
  for (const char* line : {"", ",", "1", "1,2,3,4", "1,2,x,4,5", "nan,1,1,1,1", "1,inf,1,1,1",
                           "1e300,1,1,1,1", "1,1e999,1,1,1", "\xff\xfe,1,1,1,1"})
    EXPECT_TRUE(reader.feed(std::string(line) + "\n").empty()) << line;
  for (int piece = 0; piece < 100; ++piece) EXPECT_TRUE(reader.feed(std::string(100'000, '7')).empty());
  EXPECT_TRUE(reader.feed("\n").empty());
  EXPECT_EQ(reader.feed("1,2,3,4,5\n").size(), 1U);
}

TEST(ThinnedPath, KeepsItsBoundTheFirstAndTheLastAndIsEven) {
  for (const int count : {0, 1, 2, 9, 10, 11, 19, 20, 1000, 12345}) {
    ThinnedPath path(10);
    for (int point = 0; point < count; ++point) path.add({.time_ns = point});
    const nlohmann::json rows = path.rows();
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
