#include "cli/recordings/coverage.hpp"

#include <fmt/core.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "cli/terminal.hpp"
#include "project/files/files.hpp"
#include "replay/coverage.hpp"
#include "statistics/results.hpp"
#include "tessera/recording.hpp"
#include "verify/hashes.hpp"

namespace tessera::cli {

namespace fs = std::filesystem;
using project::Nets;
using project::Specification;

namespace {

[[noreturn]] void refuse_input(const std::string& file, const std::string& why) {
  throw std::runtime_error(fmt::format("{}: {}", file, why));
}

std::string content_of_readable(const std::string& file) {
  if (!std::ifstream(file)) refuse_input(file, "cannot be read");
  return project::content_of(file);
}

bool is_recording(const std::string& file) {
  if (fs::is_directory(file) || !fs::exists(file))
    return true;  // a folder counts as a recording; its reader reports a missing file
  std::ifstream stream(file, std::ios::binary);
  std::string beginning(recording_magic.size(), '\0');
  stream.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
  return beginning == recording_magic;
}

Nets nets_of(const Specification& specification) {
  std::optional<Nets> nets = project::build(specification, terminal());
  if (!nets) throw std::runtime_error(specification.file.string() + " gives no net");
  return std::move(*nets);
}

}  // namespace

struct CoverageInput::State {
  std::string specification;
  Nets nets;
  std::string hash;
  replay::FiringCounts counts;
  explicit State(const Specification& from)
      : specification(from.file.filename().string()),
        nets(nets_of(from)),
        hash(verify::hash_of(nets.flat)),
        counts(nets.flat) {}
};

CoverageInput::CoverageInput(const Specification& specification)
    : state_(std::make_unique<State>(specification)) {}

CoverageInput::~CoverageInput() = default;

void CoverageInput::add_firings(const std::string& file, const std::string& net,
                                const std::map<std::string, std::uint64_t>& firings, std::uint64_t runs) {
  if (net != state_->hash)
    refuse_input(
        file,
        fmt::format("it is of the net {}, and {} now gives {}: name the specification it was made with, "
                    "with --spec",
                    net, state_->specification, state_->hash));
  if (const auto why = state_->counts.add(firings, runs)) refuse_input(file, why->text);
}

void CoverageInput::add_file(const std::string& file) {
  if (is_recording(file)) {
    std::string error;
    const std::optional<Recording> recording = read_recording(file, error);
    if (!recording) throw std::runtime_error(error);
    add_firings(file, recording->net_hash, {}, 0);
    if (const auto why = state_->counts.add(*recording)) refuse_input(file, why->text);
    return;
  }
  const Result<statistics::Results> results = statistics::parse_results(content_of_readable(file));
  if (!results) refuse_input(file, "is no recording, and " + results.problem());
  if (results->transitions.empty() && results->tried > 0)
    refuse_input(file, "has no coverage: it comes from schedules without --coverage");
  add_firings(file, results->identity.net, results->transitions, results->tried);
}

void report_coverage(const CoverageInput& input, const std::string& to, bool shown) {
  const CoverageInput::State& state = *input.state_;
  const replay::Coverage coverage = replay::coverage_of(state.nets.pages, state.nets.flat, state.counts);
  if (to != shown_only) write_output(to, replay::coverage_json(coverage, state.nets.flat, state.counts));
  if (shown)
    fmt::print("{}", replay::coverage_text(coverage, state.specification, state.nets.flat.parts().sources));
}

}  // namespace tessera::cli
