#include "project/build/source_scan.hpp"

#include <gtest/gtest.h>

#include <string>

namespace tessera::project_test {
namespace {

/// "a::b::f@3 ...": every function that was found, with its line.
std::string found(const std::string& text) {
  std::string all;
  for (const project::ScannedFunction& function : project::scan_source(text).functions)
    all += (all.empty() ? "" : " ") + function.space + "::" + function.name + "@" +
           std::to_string(function.line);
  return all;
}

TEST(SourceScan, FindsFunctionsInTheirNamespaces) {
  const struct {
    const char *text, *functions;
  } cases[]{
      {"namespace a::b { void f(Context& c) {} }", "a::b::f@1"},
      {"namespace a { namespace b {\nvoid f(Context &, const Inputs& in) noexcept\n{} } }", "a::b::f@2"},
      {"inline namespace a { void f(Context&) {} }", "a::f@1"},
      {"void a::b::f(a::b::Context& c) {}", "a::b::f@1"},
      {"namespace a { void ::a::b::f(Context&) {} }", "a::a::b::f@1"},
      {"namespace a { auto f(Context&) -> void {} }", "a::f@1"},
      {"namespace a { void f(Context&); }", ""},
      {"namespace a { void f(int); void f(int) {} void g(Context) {} }", ""},
      {"namespace a { // void f(Context&) {}\n/* void g(Context&) {} */ }", ""},
      {"namespace a { const char* t = \"void f(Context&) {}\"; }", ""},
      {"namespace a { const char* t = R\"x(void f(Context&) {} )\" } )x\"; void g(Context&) {} }", "a::g@1"},
      {"namespace a { int n = 1'000'000; char q = '\"'; void f(Context&) {} }", "a::f@1"},
      {"namespace a {\n#if 0\nvoid f(Context&) {}\n#else\nvoid g(Context&) {}\n#endif\n}", "a::g@5"},
      {"#define OPEN namespace b {\nnamespace a { void f(Context&) {} }", "a::f@2"},
      {"namespace a { struct S { void f(Context&) {} }; void g(Context&) {} }", "a::g@1"},
      {"namespace a { void f(Context&) { auto g = [](Context&) {}; if (1) { } } }\nvoid h(Context&) {}",
       "a::f@1 ::h@2"},
      {"using namespace a; namespace c = a::b; void f(Context&) {}", "::f@1"},
      {"namespace { void f(Context&) {} }", "(unnamed)::f@1"},
      {"extern \"C\" { void f(Context&) {} }", "::f@1"},
      {"namespace a { void f(Context& c, int n = (1 + 2)) {} }", "a::f@1"},
      {"", ""},
      {"\"", ""},
      {"/*", ""},
      {"R\"(", ""},
      {"void f(Context&", ""},
      {"}}}}", ""},
      {"namespace", ""},
      {"#", ""},
      {"namespace a { void f(Context&) {", "a::f@1"},
  };
  for (const auto& one : cases) EXPECT_EQ(found(one.text), one.functions) << one.text;
}

TEST(SourceScan, KnowsBodiesAndFunctionsWithOtherArguments) {
  const project::SourceScan scan = project::scan_source(
      "namespace a {\nvoid f(Context c, // copied\n  int n) {\n  if (n) {\n  }\n}\nstruct S {\n};\n}\nvoid "
      "g() {\n");
  ASSERT_EQ(scan.others.size(), 2U);
  EXPECT_EQ(scan.others[0].heading, "void f(Context c, int n)");
  EXPECT_EQ(scan.others[0].line, 2U);
  ASSERT_EQ(scan.bodies.size(), 3U);
  EXPECT_EQ(scan.bodies[0].first, 3U);
  EXPECT_EQ(scan.bodies[0].last, 6U);
  EXPECT_EQ(scan.bodies[1].last, 8U);
  EXPECT_EQ(scan.bodies[2].last, 11U) << "one that is not closed";
}

TEST(SourceScan, KnowsWordsThatMayMakeAFunction) {
  const project::SourceScan scan = project::scan_source(
      "#include \"robot/control.hpp\"\n#define MAKE(name) void name(Context& c)\n"
      "MAKE(first) {}\nvoid second(Context&) { third(); }\n");
  EXPECT_TRUE(scan.words.contains("first"));
  EXPECT_EQ(scan.words.at("second"), 1U);
  EXPECT_FALSE(scan.words.contains("third"));
  EXPECT_FALSE(scan.makes_names);
  EXPECT_EQ(scan.includes, std::vector<std::string>{"robot/control.hpp"});
  EXPECT_TRUE(project::scan_source("#define JOIN(a, b) a##b\n").makes_names);
}

}  // namespace
}  // namespace tessera::project_test
