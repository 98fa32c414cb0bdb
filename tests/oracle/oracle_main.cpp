// Judges random specifications by an independent reading of the design and compares the result with that
// of the command. See README.md.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "oracle/compare/compare.hpp"
#include "oracle/compare/controller_run.hpp"
#include "oracle/specification/random_specification.hpp"
#include "oracle/specification/shrink.hpp"

namespace {

struct Totals {
  int specifications = 0, refused = 0, too_large = 0, nets = 0, verdicts = 0, violated = 0, runs = 0,
      unknown = 0, without_run = 0;
  std::map<std::string, int> disagreements, refusals;

  void add(const oracle::Comparison& one) {
    ++specifications;
    refused += one.refused ? 1 : 0;
    too_large += one.too_large ? 1 : 0;
    nets += one.nets;
    verdicts += one.verdicts;
    violated += one.violated;
    runs += one.runs;
    unknown += one.unknown;
    without_run += one.without_run;
    if (one.refused) ++refusals[one.refusal];
    for (const auto& disagreement : one.disagreements) ++disagreements[disagreement.kind];
  }
  void print() const {
    std::printf(
        "%d specifications (%d refused, %d too large), %d nets, %d verdicts (%d violated, %d without a run), "
        "%d runs, %d unknown\n",
        specifications, refused, too_large, nets, verdicts, violated, without_run, runs, unknown);
    for (const auto& [code, count] : refusals) std::printf("  refused %s: %d\n", code.c_str(), count);
    for (const auto& [kind, count] : disagreements)
      std::printf("  disagreement %s: %d\n", kind.c_str(), count);
  }
};

constexpr std::size_t limit = 100000;  // markings of a net

int compare_seeds(const oracle::Command& command, std::uint64_t first, std::uint64_t number) {
  Totals totals;
  for (std::uint64_t seed = first; seed < first + number; ++seed) {
    const oracle::Comparison one = oracle::compare(oracle::random_specification(seed), command, limit);
    totals.add(one);
    for (const auto& disagreement : one.disagreements)
      std::printf("seed %s: %s: %s\n", std::to_string(seed).c_str(), disagreement.kind.c_str(),
                  disagreement.detail.c_str());
    std::fflush(stdout);
  }
  totals.print();
  return totals.disagreements.empty() ? 0 : 1;
}

/// Makes and runs the controllers of so many specifications, from `first` on.
int run_controllers(const oracle::Command& command, std::uint64_t first, std::uint64_t number) {
  int made = 0, wrong = 0, firings = 0;
  for (std::uint64_t seed = first; made < static_cast<int>(number); ++seed) {
    const oracle::ControllerRun run =
        oracle::run_controller(oracle::random_specification(seed), command, static_cast<unsigned>(seed));
    made += run.made ? 1 : 0;
    wrong += run.disagreements.empty() ? 0 : 1;
    firings += run.firings;
    for (const auto& disagreement : run.disagreements)
      std::printf("seed %s: %s: %s\n", std::to_string(seed).c_str(), disagreement.kind.c_str(),
                  disagreement.detail.c_str());
    std::fflush(stdout);
  }
  std::printf("%d controllers, %d firings, %d with disagreements\n", made, firings, wrong);
  return wrong == 0 ? 0 : 1;
}

int shrink_seed(const oracle::Command& command, std::uint64_t seed, const std::string& kind) {
  const auto shows = [&](const oracle::Specification& specification) {
    try {
      for (const auto& one : oracle::compare(specification, command, limit).disagreements)
        if (one.kind.starts_with(kind)) return true;
    } catch (const std::exception&) {  // the remaining comparison would use removed parts
    }
    return false;
  };
  const auto small = oracle::shrink(oracle::random_specification(seed), shows, 400);
  std::fputs(oracle::to_yaml(small).c_str(), stdout);
  for (const auto& one : oracle::compare(small, command, limit).disagreements)
    std::printf("# %s: %s\n", one.kind.c_str(), one.detail.c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 2 ? argv[1] : "";
  const auto number = [&](int at) { return std::strtoull(argv[at], nullptr, 10); };
  if (what == "print") {
    std::fputs(oracle::to_yaml(oracle::random_specification(number(2))).c_str(), stdout);
    return 0;
  }
  if (argc < 5) {
    std::fprintf(stderr,
                 "usage: tessera_oracle compare COMMAND FIRST_SEED NUMBER\n"
                 "       tessera_oracle controllers COMMAND FIRST_SEED NUMBER\n"
                 "       tessera_oracle shrink COMMAND SEED KIND      the smallest specification found that "
                 "disagrees so\n"
                 "       tessera_oracle print SEED\n");
    return 2;
  }
  const char* specifications = std::getenv("TESSERA_ORACLE_SPECS");
  const char* seed = std::getenv("TESSERA_ORACLE_SEED");
  const std::uint64_t first =
      what == "compare" && seed != nullptr ? std::strtoull(seed, nullptr, 10) : number(3);
  const std::uint64_t many =
      what == "compare" && specifications != nullptr ? std::strtoull(specifications, nullptr, 10) : number(4);
  const auto folder = std::filesystem::temp_directory_path() / ("tessera_oracle." + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const oracle::Command command(argv[2], folder.string());
  const int result = what == "shrink"        ? shrink_seed(command, first, argv[4])
                     : what == "controllers" ? run_controllers(command, first, many)
                                             : compare_seeds(command, first, many);
  std::filesystem::remove_all(folder);
  return result;
}
