#include <gmock/gmock.h>

#include <cstdlib>

#include "drawing/child.hpp"
#include "drawing/drawing.hpp"
#include "layers/models.hpp"

namespace tessera::drawing {
namespace {

using testing::HasSubstr;

TEST(Dot, DrawsTheGraphicLanguageOfThePaper) {
  const test::Built built = test::build(test::line_follower());
  const std::string follow = to_dot(built.pages, built.pages.find("robot.control.follow"));
  EXPECT_THAT(follow, HasSubstr("p0 [shape=circle"));
  EXPECT_THAT(follow, HasSubstr("p1 [shape=doublecircle"));
  EXPECT_THAT(follow, HasSubstr("t5 [shape=box, width=0.4, height=0.05"));
  EXPECT_THAT(follow, HasSubstr("[never]"));
  const std::string send = to_dot(built.pages, built.pages.find("robot.control.follow.snd"));
  EXPECT_THAT(send, HasSubstr("label=\"●\", xlabel=<motion.empty>, style=dashed]"));
}

TEST(Dot, IsUnderstoodByGraphviz) {
  const spec::Model model = test::fleet(2);
  const test::Built built = test::build(model);
  Options options;
  options.model = &model;
  options.levels = Options::all;
  for (const Notation notation : {Notation::paths, Notation::paper}) {
    options.notation = notation;
    EXPECT_THAT(run_dot(to_dot(built.pages, net::PageId{0}, options)), HasSubstr("cluster_0"));
  }
}

TEST(Dot, ThatGraphvizRefusesIsALayoutError) {
  try {
    (void)run_dot("digraph {");
    FAIL() << "accepted";
  } catch (const LayoutError& error) {
    EXPECT_THAT(error.what(), HasSubstr("syntax error"));
  }
}

TEST(Dot, ThatIsNotInstalledIsALayoutError) {
  const std::string path = std::getenv("PATH");
  ASSERT_EQ(setenv("PATH", "/nonexistent", 1), 0);
  std::string said;
  try {
    (void)run_dot("digraph {}");
  } catch (const LayoutError& error) {
    said = error.what();
  }
  ASSERT_EQ(setenv("PATH", path.c_str(), 1), 0);
  EXPECT_THAT(said, HasSubstr("'dot' is not installed"));
}

}  // namespace
}  // namespace tessera::drawing
