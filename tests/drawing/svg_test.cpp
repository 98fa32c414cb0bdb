#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <pugixml.hpp>

#include "drawing/drawing.hpp"
#include "drawing/layout.hpp"
#include "layers/models.hpp"

namespace tessera::drawing {
namespace {

std::size_t count(const pugi::xml_document& document, const std::string& path) {
  return document.select_nodes(path.c_str()).size();
}

TEST(Svg, HasASymbolForEveryElement) {
  const spec::Model model = test::line_follower();
  const test::Built built = test::build(model);
  Options options;
  options.model = &model;
  options.levels = Options::all;
  for (const Notation notation : {Notation::paths, Notation::paper}) {
    options.notation = notation;
    pugi::xml_document document;
    ASSERT_TRUE(document.load_string(to_svg(built.pages, net::PageId{0}, options).c_str()));
    EXPECT_EQ(count(document, "//path[starts-with(@class,'arc')]"), built.net.arc_count());
    EXPECT_EQ(count(document, "//g[title]/rect"), built.net.transitions().size());
    EXPECT_EQ(count(document, "//g[title]/circle[starts-with(@class,'place')]"), built.net.places().size());
    EXPECT_EQ(count(document, "//g[title]/circle[@class='token']"), 3U) << "in, line.channel, velocity.empty";
  }
}

TEST(Svg, NamesEveryElementByItsPath) {
  const test::Built built = test::build(test::line_follower());
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(to_svg(built.pages, built.pages.find("robot.motor.drive.rcv")).c_str()));
  EXPECT_EQ(count(document, "//g[title='robot.motor.drive.rcv.velocity.timeout']"), 1U);
  EXPECT_EQ(count(document, "//text[@class='condition' and tspan='[200 ms]']"), 1U);
}

class SvgLayout : public testing::Test {
 protected:
  void lay(const char* path, unsigned levels) {
    Options options;
    options.levels = levels;
    picture_ = picture_of(built_.pages, built_.pages.find(path), options);
    layout_ = lay_out(picture_);
  }
  test::Built built_ = test::build(test::line_follower());
  Picture picture_;
  Layout layout_;
};

TEST_F(SvgLayout, LeadsEveryArrowFromSymbolToSymbol) {
  lay("", Options::all);
  for (std::size_t index = 0; index < picture_.arrows.size(); ++index) {
    const Arrow& arrow = picture_.arrows[index];
    ASSERT_GE(layout_.arrows[index].size(), 4U);
    const Point at_circle = arrow.to_bar ? layout_.arrows[index].front() : layout_.arrows[index].back();
    const Point at_bar = arrow.to_bar ? layout_.arrows[index].back() : layout_.arrows[index].front();
    const Point circle = layout_.circles[arrow.circle], bar = layout_.bars[arrow.bar];
    EXPECT_NEAR(std::hypot(at_circle.x - circle.x, at_circle.y - circle.y), Sizes::circle_radius + 1, 0.5);
    EXPECT_LE(std::abs(at_bar.x - bar.x), Sizes::bar_width / 2 + 0.5);
    EXPECT_LE(std::abs(at_bar.y - bar.y), Sizes::bar_height / 2 + 0.5);
  }
}

TEST_F(SvgLayout, KeepsSymbolsApart) {
  lay("", Options::all);
  std::vector<Point> all = layout_.circles;
  all.insert(all.end(), layout_.bars.begin(), layout_.bars.end());
  for (std::size_t a = 0; a < all.size(); ++a)
    for (std::size_t b = a + 1; b < all.size(); ++b)
      EXPECT_TRUE(std::abs(all[a].x - all[b].x) >= 30 || std::abs(all[a].y - all[b].y) >= 15)
          << a << " and " << b;
}

TEST_F(SvgLayout, KeepsSymbolsInTheirFrames) {
  lay("", Options::all);
  for (std::size_t index = 0; index < picture_.circles.size(); ++index) {
    const FrameId frame = picture_.circles[index].frame;
    if (!frame.valid()) continue;
    const Box& box = layout_.frames[frame.value];
    EXPECT_GT(layout_.circles[index].x, box.left);
    EXPECT_LT(layout_.circles[index].x, box.right);
    EXPECT_GT(layout_.circles[index].y, box.top);
    EXPECT_LT(layout_.circles[index].y, box.bottom);
  }
}

TEST_F(SvgLayout, LeadsTheWayOfABehaviourStraightDown) {
  lay("robot.control.follow", 0);
  EXPECT_NEAR(layout_.circles[0].x, layout_.circles[2].x, 2) << "in above 2";
  EXPECT_LT(layout_.circles[0].y, layout_.circles[2].y);
  EXPECT_LT(layout_.circles[3].y, layout_.circles[4].y) << "rcv above out";
}

TEST(Svg, OfMoreThanAnyoneCanReadIsRefused) {
  const test::Built built = test::build(test::fleet(40));
  Options options;
  options.levels = Options::all;
  EXPECT_THROW((void)to_svg(built.pages, net::PageId{0}, options), LayoutError);
}

}  // namespace
}  // namespace tessera::drawing
