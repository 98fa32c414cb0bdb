// Measures the way from the text of a specification to the files of its controller, in memory: the work of
// `tessera generate` before it writes. Each stage is measured beside the whole, so the ratio shows the share
// of its time.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string>

#include "codegen/codegen.hpp"
#include "fleet/fleet.hpp"
#include "layers/layers.hpp"
#include "net/flatten.hpp"
#include "spec/parser.hpp"
#include "verify/verify.hpp"

namespace {

using namespace tessera;

std::string text_of(benchmark::State& state, test::Form form) {
  test::Fleet fleet = *test::fleet_named("nbring", static_cast<unsigned>(state.range(0)));
  fleet.form = form;
  return test::fleet_spec(fleet);
}

template <class T>
T require(std::optional<T> value) {
  if (!value) std::abort();
  return std::move(*value);
}

void parse(benchmark::State& state, test::Form form) {
  const std::string text = text_of(state, form);
  for (auto _ : state) {
    diagnostics::Diagnostics diagnostics("fleet.yaml", text);
    benchmark::DoNotOptimize(require(spec::parse(diagnostics)));
  }
  state.counters["bytes"] = static_cast<double>(text.size());
}

void yaml_to_files(benchmark::State& state, test::Form form) {
  const std::string text = text_of(state, form);
  std::size_t places = 0, lines = 0;
  for (auto _ : state) {
    diagnostics::Diagnostics diagnostics("fleet.yaml", text);
    const spec::Model model = require(spec::parse(diagnostics));
    const net::HierarchicalNet pages = require(layers::build(model, diagnostics));
    net::Net flat = require(net::flatten(pages, diagnostics));
    places = flat.places().size();
    verify::Report report = verify::check(flat, layers::invariants(model, pages, flat));
    const verify::VerifiedNet verified = require(verify::accept(std::move(flat), std::move(report)));
    lines = 0;
    for (const codegen::File& file : codegen::generate(verified, model, "fleet.yaml"))
      lines += static_cast<std::size_t>(std::count(file.text.begin(), file.text.end(), '\n'));
  }
  state.counters["places"] = static_cast<double>(places);
  state.counters["lines"] = static_cast<double>(lines);
}

BENCHMARK_CAPTURE(parse, template, test::Form::one_template)->Arg(1000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(parse, written_out, test::Form::written_out)->Arg(1000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(yaml_to_files, template, test::Form::one_template)
    ->Arg(10)
    ->Arg(100)
    ->Arg(1000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(yaml_to_files, written_out, test::Form::written_out)
    ->Arg(10)
    ->Arg(100)
    ->Arg(1000)
    ->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
