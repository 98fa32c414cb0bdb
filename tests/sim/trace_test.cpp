#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "read_trace.hpp"

using tessera::sim::read_trace;

namespace {

constexpr auto head = "t_s,x_m,y_m,heading_rad,eye_x_m,eye_y_m,on_line\n";

std::string file_with(const std::string& text) {
  const std::string path =
      std::filesystem::temp_directory_path() / ("tessera_trace_" + std::to_string(getpid()) + ".csv");
  std::ofstream(path) << text;
  return path;
}

TEST(Trace, IsReadBack) {
  const auto trace =
      read_trace(file_with(std::string(head) + "0.010,1.5,-2,0.25,1.6,-2.1,1\n0.020,0,0,0,0,0,0\n"));
  ASSERT_TRUE(trace) << trace.problem();
  ASSERT_EQ(trace->points.size(), 2U);
  EXPECT_EQ(trace->points[0].t_s, 0.01);
  EXPECT_EQ(trace->points[0].y_m, -2);
  EXPECT_EQ(trace->points[0].eye_y_m, -2.1);
  EXPECT_TRUE(trace->points[0].on_line);
  EXPECT_FALSE(trace->points[1].on_line);
}

TEST(Trace, WhatIsNoneIsRefusedWithTheLine) {
  struct Case {
    std::string text, part;
  };
  for (const Case& c :
       {Case{"", "no trace"}, Case{"a,b\n", "no trace"}, Case{std::string(head) + "1,2,3\n", ":2: not seven"},
        Case{std::string(head) + "1,2,3,4,5,6,1\n1,2,3,4,5,6,x\n", ":3: not seven"},
        Case{std::string(head) + "1,2,3,4,5,6,1,8\n", ":2: not seven"}}) {
    const auto trace = read_trace(file_with(c.text));
    EXPECT_FALSE(trace) << c.text;
    EXPECT_NE(trace.problem().find(c.part), std::string::npos) << trace.problem();
  }
  EXPECT_NE(read_trace("/nowhere/trace.csv").problem().find("/nowhere/trace.csv"), std::string::npos);
}

}  // namespace
