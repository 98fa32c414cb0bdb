// Controllers generated from random specifications: on either clock and in any interleaving, their firings
// are a firing sequence of the verified net, and do not contradict the verdicts. TESSERA_CONTROLLERS=50 is
// the long form.

#include <fmt/format.h>

#include <random>
#include <vector>

#include "../environment.hpp"
#include "command.hpp"

namespace tessera::cli_test {
namespace {

[[nodiscard]] std::uint64_t controllers() { return from_environment("TESSERA_CONTROLLERS", 2); }

/// Two to four agents of one control subsystem each, and channels of all modes between them. A second
/// behaviour uses only some of the channels, and is left for the first again, or for good.
class RandomSpecification {
 public:
  explicit RandomSpecification(unsigned seed) : random_(seed), agents_(2 + below(3)) {
    for (unsigned from = 0; from < agents_.size(); ++from)
      for (unsigned to = 0; to < agents_.size(); ++to)
        if (from != to && below(2) == 0) connect(from, to);
    if (channels_.empty()) connect(0, 1);
    text_ = fmt::format("tessera: 1\nsystem: random_{}\ntypes: {{ Word: {{ n: int32 }} }}\nagents:\n", seed);
    for (unsigned agent = 0; agent < agents_.size(); ++agent) add(agent);
    text_ += "channels:\n" + channels_;
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  struct Agent {
    std::vector<std::string> inputs, outputs;
  };

  [[nodiscard]] unsigned below(unsigned limit) { return static_cast<unsigned>(random_() % limit); }

  void connect(unsigned from, unsigned to) {
    agents_[from].outputs.push_back(fmt::format("to{}", to));
    agents_[to].inputs.push_back(fmt::format("from{}", from));
    channels_ += fmt::format("  - {{ from: r{}.control.to{}, to: r{}.control.from{}{}{} }}\n", from, to, to,
                             from, side("send"), side("receive"));
  }
  [[nodiscard]] std::string side(const std::string& name) {
    if (below(2) == 0) return "";
    if (below(2) == 0) return fmt::format(", {}: blocking", name);
    return fmt::format(", {0}: blocking, {0}_timeout: {1} ms", name, 3 + below(20));
  }

  void add(unsigned number) {
    const Agent& agent = agents_[number];
    text_ +=
        fmt::format("  r{}:\n    control:\n      rate: {} Hz\n", number, std::vector{200, 100, 50}[below(3)]);
    if (!agent.inputs.empty()) text_ += "      inputs: " + buffers(agent.inputs);
    if (!agent.outputs.empty()) text_ += "      outputs: " + buffers(agent.outputs);
    text_ += "      memory: { n: int32 }\n      behaviours:\n";
    const unsigned rounds = 1 + below(6);
    const std::string transfer = below(3) == 0 ? ", transfer: parallel" : "";
    if (below(3) == 0) {
      text_ += fmt::format("        first: {{ terminal: \"false\"{} }}\n", transfer);
      return;
    }
    text_ += fmt::format("        first: {{ terminal: \"memory.n % {} == 0\", next: second{} }}\n", rounds,
                         transfer);
    text_ += fmt::format("        second: {{ send: [{}], receive: [{}], terminal: true", some(agent.outputs),
                         some(agent.inputs));
    text_ += below(4) == 0 ? " }\n" : ", next: first }\n";
  }
  [[nodiscard]] static std::string buffers(const std::vector<std::string>& names) {
    return fmt::format("{{ {}: Word }}\n", fmt::join(names, ": Word, "));
  }
  [[nodiscard]] std::string some(const std::vector<std::string>& names) {
    std::vector<std::string> chosen;
    for (const std::string& name : names)
      if (below(2) == 0) chosen.push_back(name);
    return fmt::format("{}", fmt::join(chosen, ", "));
  }

  std::mt19937_64 random_;
  std::vector<Agent> agents_;
  std::string channels_, text_;
};

class Controllers : public Command {
 protected:
  void make(unsigned seed) {
    write(folder_ / "spec.yaml", RandomSpecification(seed).text());
    const project::Exit made = tessera("generate --accept-violations --stubs");
    ASSERT_EQ(made.code, 0) << made.text;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / "src"))
      if (entry.is_regular_file()) count_calls(entry.path());
    static_cast<void>(tessera("verify --json verdicts.json"));
    verdicts_ = nlohmann::json::parse(content_of(folder_ / "verdicts.json"));
  }
  /// After a run: its firings are legal, and no event that was proved impossible has happened.
  void expect_sound(const std::string& how, const project::Exit& ran) {
    const std::string what = how + "\n" + content_of(folder_ / "spec.yaml") + ran.text;
    const project::Exit checked = tessera("replay .tessera/last/recording.tsr --check");
    EXPECT_EQ(checked.code, 0) << checked.text << what;
    EXPECT_EQ(ran.text.find("second token"), std::string::npos) << what;
    const bool stuck = ran.text.find("nothing can ever happen") != std::string::npos;
    EXPECT_FALSE(stuck && holds("deadlock_free")) << what;
    const bool some_stuck = ran.text.find("stuck for good") != std::string::npos;
    EXPECT_FALSE(some_stuck && holds("goes_on")) << what;
  }

 private:
  static void count_calls(const fs::path& source) {
    std::string text = content_of(source);
    for (std::size_t at = 0; (at = text.find("Outputs& out) {}", at)) != std::string::npos; at += 1)
      text.replace(at, 16, "Outputs& out) { ++memory.n; }");
    for (std::size_t at = 0; (at = text.find("Memory& memory) {}", at)) != std::string::npos; at += 1)
      text.replace(at, 18, "Memory& memory) { ++memory.n; }");
    write(source, text);
  }
  [[nodiscard]] bool holds(const std::string& property) const {
    for (const auto& one : verdicts_.at("properties"))
      if (one.at("name") == property) return one.at("verdict") == "holds";
    return false;
  }
  nlohmann::json verdicts_;
};

TEST_F(Controllers, OfRandomSpecificationsRunAsTheirNetAllows) {
  for (unsigned seed = 1; seed <= controllers() && !HasFailure(); ++seed) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    make(seed);
    if (HasFatalFailure()) return;
    for (const char* how :
         {"simulate --for 2s --seed 1", "simulate --for 2s --seed 2 --interleave", "run --for 200ms"})
      expect_sound(how, tessera(fmt::format("{} --accept-violations", how)));
  }
}

}  // namespace
}  // namespace tessera::cli_test
