// Measures the speed of the explorer, and the memory of a marking: breadth first, one core.
//
// Counts a built-in net, and the nets named on the command line: bench_explore_count NET.pnml ...

#include <benchmark/benchmark.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "diagnostics/source.hpp"
#include "explore/explore.hpp"
#include "net/pnml_reader.hpp"

namespace {

using namespace tessera;

/// Independent rings with one token each: places^rings markings, all firings possible in each.
net::Net rings(std::uint32_t count, std::uint32_t places) {
  net::Net net;
  for (std::uint32_t place = 0; place < count * places; ++place) {
    net::Place part;
    part.tokens = place % places == 0 ? 1 : 0;
    net.add(std::move(part));
  }
  for (std::uint32_t place = 0; place < count * places; ++place) {
    const std::uint32_t next = place % places + 1 == places ? place + 1 - places : place + 1;
    const std::vector<net::Arc> from{{net::PlaceId{place}, 1}}, to{{net::PlaceId{next}, 1}};
    net.add(net::Transition{}, from, to);
  }
  return net;
}

void count_markings(benchmark::State& state, const net::Net& net) {
  const explore::PtNet compiled(net);
  explore::Count counted;
  for (auto _ : state) counted = count(compiled, {});
  if (!counted.complete) return state.SkipWithError(counted.why.c_str());
  const auto markings = static_cast<double>(counted.markings);
  const auto each = benchmark::Counter::kIsIterationInvariantRate;
  state.counters["markings"] = markings;
  state.counters["markings/s"] = {markings, each};
  state.counters["edges/s"] = {static_cast<double>(counted.edges), each};
  state.counters["bytes/marking"] = static_cast<double>(counted.effort.bytes) / markings;
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  std::vector<net::Net> nets{rings(7, 8)};
  std::vector<std::string> names{"rings"};
  for (int at = 1; at < argc; ++at) {
    auto source = diagnostics::load(argv[at]);
    auto net = net::read_pnml(source);
    if (!net) {
      std::fputs(render(source).c_str(), stderr);
      return 1;
    }
    nets.push_back(std::move(*net));
    names.push_back(std::filesystem::path(argv[at]).stem().string());
  }
  for (std::size_t at = 0; at < nets.size(); ++at)
    benchmark::RegisterBenchmark(names[at].c_str(), [&nets, at](benchmark::State& state) {
      count_markings(state, nets[at]);
    })->Unit(benchmark::kMillisecond);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
