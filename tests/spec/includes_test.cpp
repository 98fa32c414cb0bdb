#include <cstdlib>
#include <filesystem>

#include "layers/layers.hpp"
#include "net/flatten.hpp"
#include "spec_reading.hpp"

/// Specifications of several files.
namespace tessera::spec {
namespace {

namespace fs = std::filesystem;

/// A folder of files, which is removed at the end.
class IncludedFiles : public testing::Test {
 protected:
  IncludedFiles() {
    std::string pattern = (fs::temp_directory_path() / "tessera-includes-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~IncludedFiles() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
  }

  [[nodiscard]] diagnostics::Diagnostics source(const std::string& text) const {
    return {"robots/spec.yaml", text, folder_};
  }

  fs::path folder_;
};

constexpr const char* written_types = "types: { Pose: { x: float64 m } }\n";
constexpr const char* written_docking = R"(templates:
  docking:
    with: [pose]
    until: in.pose.fresh
    behaviours:
      approach: { receive: [pose], terminal: true, next: dock }
      dock: { terminal: in.pose.x > 1, next: approach }
)";
constexpr const char* written_carrier = R"(  carrier:
    control:
      rate: 10 Hz
      inputs: { pose: Pose }
      behaviours:
        work: { terminal: true, next: charge }
        charge: { use: docking, with: { pose: pose }, next: work }
    receptors:
      odometry: { rate: 10 Hz, outputs: { pose: Pose }, behaviours: { measure: { terminal: true, next: measure } } }
)";
constexpr const char* written_rest = R"(agents:
  carrier: { use: carrier, count: 2 }
channels: [ "carrier[i].odometry.pose -> carrier[i].control.pose" ]
)";
constexpr const char* written_head = "tessera: 1\nsystem: depot\n";

/// Everything of a net but the lines.
std::string picture(const Model& model) {
  diagnostics::Diagnostics out("", "");
  const auto pages = layers::build(model, out);
  const auto net = net::flatten(*pages, out);
  std::string text;
  for (std::uint32_t id = 0; id < net->transitions().size(); ++id) {
    const net::Transition& one = net->transitions()[id];
    text += one.name + " [" + one.condition.text + "]";
    for (const net::Arc& arc : net->preset({id})) text += " <" + (*net)[arc.place].name;
    for (const net::Arc& arc : net->postset({id})) text += " >" + (*net)[arc.place].name;
    text += "\n";
  }
  return text;
}

TEST_F(IncludedFiles, MeanWhatTheSameTextMeansInOneFile) {
  write("parts/types.yaml", std::string("tessera: 1\n") + written_types);
  write("parts/docking.yaml", std::string(written_docking));
  write("parts/robots/carrier.yaml",
        std::string("include: [../types.yaml, ../docking.yaml]\ntemplates:\n") + written_carrier);
  diagnostics::Diagnostics split =
      source(std::string(written_head) + "include: [parts/robots/carrier.yaml, parts/docking.yaml]\n" +
             written_rest);
  const Reading whole(std::string(written_head) + written_types + written_docking + written_carrier +
                      written_rest);
  const std::optional<Model> model = parse(split);
  ASSERT_TRUE(model.has_value()) << render(split);
  ASSERT_TRUE(whole.model.has_value()) << whole.report();
  EXPECT_EQ(picture(*model), picture(*whole.model));
  EXPECT_EQ(model->sources.included(), (std::vector<std::string>{"parts/robots/carrier.yaml",
                                                                 "parts/types.yaml", "parts/docking.yaml"}));
}

TEST_F(IncludedFiles, HaveTheLinesOfTheirElements) {
  write("docking.yaml", std::string("# a comment\n") + written_types + written_docking);
  diagnostics::Diagnostics split = source(std::string(written_head) + "include: docking.yaml\ntemplates:\n" +
                                          written_carrier + written_rest);
  const std::optional<Model> model = parse(split);
  ASSERT_TRUE(model.has_value()) << render(split);
  std::vector<std::string> lines;
  for (const Behaviour& one : model->definitions.begin()->subsystems.front().behaviours)
    lines.push_back(one.name + " " + model->sources.words(one.span.line));
  EXPECT_EQ(lines, (std::vector<std::string>{"work line 10 of spec.yaml", "charge line 11 of spec.yaml",
                                             "charge.approach line 8 of docking.yaml",
                                             "charge.dock line 9 of docking.yaml"}));
  EXPECT_EQ(model->sources.own_line(10), 10U);
  const std::uint32_t dock = model->definitions.begin()->subsystems.front().behaviours.end()[-1].span.line;
  EXPECT_EQ(model->sources.own_line(dock), 0U);
  EXPECT_EQ(model->sources.included_line(dock), "docking.yaml:9");
}

TEST_F(IncludedFiles, AreNamedInMessagesBesideTheSpecification) {
  write("parts/types.yaml", "types:\n  Pose: { x: float64 m, y: Metre }\n");
  diagnostics::Diagnostics split =
      source(std::string(written_head) + "include: parts/types.yaml\n" + "agents: {}\n");
  EXPECT_FALSE(parse(split).has_value());
  EXPECT_NE(render(split).find("robots/parts/types.yaml:2:28: error E101: unknown type 'Metre'\n"
                               "    2 |   Pose: { x: float64 m, y: Metre }\n"
                               "      |                            ^~~~~\n"),
            std::string::npos)
      << render(split);
  EXPECT_NE(render_json(split).find("\"file\": \"robots/parts/types.yaml\",\n    \"line\": 2"),
            std::string::npos)
      << render_json(split);
}

TEST_F(IncludedFiles, AreWhatTheSourceDependsOn) {
  const std::string text = std::string(written_head) + "include: parts/types.yaml\n" + written_rest;
  diagnostics::Diagnostics without = source(text);
  EXPECT_FALSE(parse(without).has_value());
  EXPECT_EQ(without.sources().included(), (std::vector<std::string>{"parts/types.yaml"}));
  write("parts/types.yaml", written_types);
  diagnostics::Diagnostics with = source(text);
  static_cast<void>(parse(with));
  EXPECT_EQ(with.text(), without.text());
  EXPECT_NE(with.whole_text(), without.whole_text());
}

TEST_F(IncludedFiles, MayHoldTemplatesThatNobodyUses) {
  write("parts.yaml", std::string(written_types) + written_docking + written_carrier);
  diagnostics::Diagnostics split = source(std::string(written_head) + R"(include: parts.yaml
agents: { robot: { control: { rate: 10 Hz, behaviours: { work: { terminal: true, next: work } } } } }
)");
  EXPECT_TRUE(parse(split).has_value());
  EXPECT_EQ(render(split), "");
}

TEST_F(IncludedFiles, AreNotReadFromPipes) {
  fs::create_directories(folder_);
  ASSERT_EQ(std::system(("mkfifo " + (folder_ / "pipe.yaml").string()).c_str()), 0);  // NOLINT(cert-env33-c)
  diagnostics::Diagnostics split = source(std::string(written_head) + "include: pipe.yaml\n" + written_rest);
  EXPECT_FALSE(parse(split).has_value());
  EXPECT_NE(render(split).find("E357"), std::string::npos) << render(split);
}

TEST(IncludeWithoutFolder, IsRefused) {
  const Reading reading(std::string(written_head) + "include: parts.yaml\n" + written_rest);
  EXPECT_FALSE(reading.model.has_value());
  EXPECT_EQ(reading.codes(), "E361");
}

}  // namespace
}  // namespace tessera::spec
