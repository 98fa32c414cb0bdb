// How old commands were in a recording, for the page.
#include <algorithm>
#include <deque>
#include <stdexcept>
#include <utility>

#include "replay/times/measured_ages.hpp"
#include "replay/times/recorded_way.hpp"
#include "server/recordings/recording_stream.hpp"
#include "server/recordings/recordings.hpp"

namespace tessera::server {

namespace fs = std::filesystem;
using nlohmann::json;
using replay::ExplainedTime;
using replay::MeasuredChain;

namespace {

/// Reads the whole file: `use.begin(header)` once, then `use.take(header, entry)` of each entry.
template <class Use>
void read_whole(const fs::path& file, Use&& use) {
  RecordingStream stream(RecordingStream::of_file(file, GrowingRecording::From::oldest));
  bool is_first = true;
  while (stream.next()) {
    if (!stream.recording()) continue;
    if (std::exchange(is_first, false)) use.begin(*stream.recording());
    for (const Recording::Entry& entry : stream.recording()->entries) use.take(*stream.recording(), entry);
  }
  if (is_first) throw std::runtime_error(file.filename().string() + " is no recording");
}

/// The ways of the worst cases, which are read together.
struct WorstCases {
  struct One {
    const MeasuredChain& chain;
    ExplainedTime time;
    json& shown;  ///< of the answer
  };
  std::vector<One> all;
  std::deque<replay::RecordedWayReader> readers;

  void begin(const Recording& header) {
    for (const One& one : all) readers.emplace_back(header, one.chain, one.time);
  }
  void take(const Recording& header, const Recording::Entry& entry) {
    for (replay::RecordedWayReader& reader : readers) reader.take(header, entry);
  }
};

/// As that of a run that was computed (POST /api/timing/worst).
json way_json(const replay::RecordedWay& way) {
  json calls = json::array(), hops = json::array();
  for (const replay::RecordedWay::Call& call : way.calls)
    calls.push_back({{"subsystem", call.subsystem},
                     {"behaviour", call.behaviour},
                     {"begin_ns", call.begin_ns},
                     {"end_ns", call.end_ns}});
  for (const replay::RecordedWay::Hop& hop : way.hops)
    hops.push_back({{"channel", hop.channel},
                    {"from", hop.from},
                    {"to", hop.to},
                    {"written_ns", hop.written_ns},
                    {"read_ns", hop.read_ns}});
  return {{"calls", std::move(calls)}, {"hops", std::move(hops)}};
}

}  // namespace

std::optional<std::variant<json, std::string>> Recordings::measured_times(const std::string& name,
                                                                          const spec::Model& model) const {
  const auto known = files();
  const auto found = known.find(name);
  if (found == known.end()) return std::nullopt;
  const std::vector<MeasuredChain> chains = replay::measured_chains(model);
  struct Measuring {
    replay::Ages ages;
    std::string system{};
    void begin(const Recording& header) {
      system = header.system;
      ages.begin(header);
    }
    void take(const Recording& header, const Recording::Entry& entry) { ages.take(header, entry); }
  } measuring{replay::Ages(chains)};
  read_whole(found->second, measuring);
  if (measuring.system != model.system)
    return "the recording is of the system " + measuring.system + ", and not of " + model.system;
  measuring.ages.end();
  json answer = replay::ages_json(replay::beside_bounds(measuring.ages.finish(), model), {});

  WorstCases worst;
  for (json& one : answer) {
    const auto first = std::ranges::find(chains, one.at("chain").get<std::string>(), &MeasuredChain::group);
    one["name"] = first->name;
    one["named"] = model.timing.chains.has_value();
    one["path"] = first->subsystems;
    for (const auto& [of, what] :
         {std::pair{"age", ExplainedTime::Of::age}, std::pair{"reaction", ExplainedTime::Of::reaction}}) {
      if (!one.at(of).contains("worst")) continue;
      json& shown = one.at(of).at("worst");
      const auto chain =
          std::ranges::find(chains, shown.at("chain").get<std::string>(), &MeasuredChain::name);
      worst.all.push_back(
          {*chain,
           {what, shown.at("from_ns").get<std::int64_t>(), shown.at("to_ns").get<std::int64_t>()},
           shown});
    }
  }
  read_whole(found->second, worst);
  for (std::size_t index = 0; index < worst.all.size(); ++index)
    worst.all[index].shown.update(way_json(worst.readers[index].finish()));
  return json{{"chains", std::move(answer)}};
}

}  // namespace tessera::server
