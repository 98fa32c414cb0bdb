#include "drawing/paper_labels.hpp"

#include <gtest/gtest.h>

#include "layers/models.hpp"

namespace tessera::drawing {
namespace {

/// Raised text as ^{...}, lowered as _{...}.
std::string tex(const Label& label) {
  std::string text;
  for (const Label::Run& run : label.runs) {
    if (run.level == Label::Level::base) text += run.text;
    if (run.level == Label::Level::raised) text += "^{" + run.text + "}";
    if (run.level == Label::Level::lowered) text += "_{" + run.text + "}";
  }
  return text;
}

class PaperLabels : public testing::Test {
 protected:
  [[nodiscard]] net::PageId at(const char* path) const { return built_.pages.find(path); }
  [[nodiscard]] std::string page(const char* path) const { return tex(labels_->page(at(path))); }
  [[nodiscard]] std::string node(const char* path, std::uint32_t index) const {
    return tex(labels_->node(at(path), index));
  }
  [[nodiscard]] std::string operation(const char* path, std::uint32_t index) const {
    return tex(labels_->operation(at(path), built_.pages.pages[at(path).value].nodes[index].operation).at(0));
  }

  spec::Model model_ = test::fleet(2);
  test::Built built_ = test::build(model_);
  std::unique_ptr<Labels> labels_ = paper_labels(built_.pages, model_);
};

TEST_F(PaperLabels, NamePages) {
  EXPECT_EQ(page("robot[1]"), "a_{2}");
  EXPECT_EQ(page("robot[0].control"), "c_{1}");
  EXPECT_EQ(page("robot[1].sensor"), "r_{2,1}");
  EXPECT_EQ(page("robot[1].motor"), "e_{2,1}");
  EXPECT_EQ(page("robot[0].control.follow"), "^{c}B_{1,2}");
  EXPECT_EQ(page("robot[0].motor.drive"), "^{e}B_{1,1,1}");
  EXPECT_EQ(page("robot[0].motor.drive.rcv"), "^{e}P^{rcv}_{1,1,1}");
}

TEST_F(PaperLabels, NamePlaces) {
  EXPECT_EQ(node("robot[1]", 0), "p^{in}_{2}");
  EXPECT_EQ(node("robot[0].control", 0), "^{c}p^{in}_{1}");
  EXPECT_EQ(node("robot[0].control.follow", 2), "^{c}p^{2}_{1,2}");
}

TEST_F(PaperLabels, NameBuffersByBothEnds) {
  EXPECT_EQ(operation("robot[0].control.follow.snd", 1), "write ^{e}_{y}c_{1,1}");
  EXPECT_EQ(operation("robot[0].control.follow.rcv", 1), "read ^{r}_{x}c_{1,1}");
  EXPECT_EQ(operation("robot[0].motor.drive.rcv", 1), "read ^{c}_{x}e_{1,1}");
  EXPECT_EQ(operation("robot[1].sensor.watch.snd", 1), "write ^{c}_{y}r_{2,1}");
  EXPECT_EQ(node("robot[0].control.follow.snd", 3), "^{e}_{y}c_{1,1} → ^{c}_{x}e_{1,1} empty");
}

TEST_F(PaperLabels, NameFunctionsAndConditions) {
  EXPECT_EQ(operation("robot[0].control.follow", 0), "^{c}f_{1,2}");
  net::Condition condition{
      .kind = net::Condition::Kind::go_on, .truth = net::Condition::Truth::free, .text = "no error"};
  const auto text = [&] { return tex(labels_->condition(at("robot[0].control.follow"), condition).at(0)); };
  EXPECT_EQ(text(), "¬^{c}f^{τ}_{1,2} ∧ ¬^{c}f^{ε}_{1,2}");
  condition.kind = net::Condition::Kind::error;
  EXPECT_EQ(text(), "^{c}f^{ε}_{1,2}");
  condition.truth = net::Condition::Truth::never;
  EXPECT_EQ(text(), "never");
}

TEST_F(PaperLabels, NameTransmissionsBetweenControlSubsystems) {
  test::ModelBuilder builder;
  for (const char* name : {"p", "q"})
    builder.agent(name, {test::subsystem(spec::SubsystemKind::control, "control", {"in1"}, {"out1"},
                                         {test::behaviour("work")})});
  builder.channel({{0}, {0}}, {{1}, {0}});
  model_ = builder.result();
  built_ = test::build(model_);
  labels_ = paper_labels(built_.pages, model_);
  EXPECT_EQ(operation("p.control.work.snd", 1), "write ^{T}_{y}c_{1,2}");
  EXPECT_EQ(operation("q.control.work.rcv", 1), "read ^{T}_{x}c_{2,1}");
}

}  // namespace
}  // namespace tessera::drawing
