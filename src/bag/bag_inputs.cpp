#include "bag/bag_inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "bag/feed.hpp"
#include "bag/raw_channel.hpp"
#include "mcap/reader.hpp"
#include "tessera/recording.hpp"

namespace tessera::bag {
namespace {

using nlohmann::ordered_json;

class Extraction {
 public:
  Extraction(const std::string& system, const std::vector<WantedInput>& wanted)
      : system_(system), wanted_(wanted), values_(wanted.size()) {}

  std::optional<BagInputs> run(std::string_view bag, std::string& error) {
    const mcap::Condition found = mcap::read(bag, {.message = [this](const mcap::ReadMessage& one) {
                                               first_ns_ = std::min(first_ns_, one.message.log_ns);
                                             }});
    if (!found.is_mcap) {
      error = "is no MCAP file";
      return std::nullopt;
    }
    for (const WantedInput& input : wanted_) {
      feeds_.push_back(make_feed(input, error));
      if (feeds_.back() == nullptr) return std::nullopt;
    }
    inputs_.recording = file_start(header());
    static_cast<void>(mcap::read(bag, {.message = [this](const mcap::ReadMessage& one) { take(one); }}));
    for (std::size_t number = 0; number < feeds_.size() && problem_.empty(); ++number)
      feeds_[number]->finish([this, number](const Feed::Value& value) { put(number, value); });
    if (problem_.empty() && inputs_.values == 0) problem_ = "has no value for any real input";
    if (!problem_.empty()) {
      error = problem_;
      return std::nullopt;
    }
    inputs_.recording += raw_end(inputs_.end_ns, 0);
    if (const std::string told = found.told(); !told.empty()) inputs_.notes.push_back(told);
    for (const auto& feed : feeds_)
      for (std::string& note : feed->notes()) inputs_.notes.push_back(std::move(note));
    return std::move(inputs_);
  }

 private:
  [[nodiscard]] std::string header() const {
    ordered_json header{
        {"system", system_}, {"net_hash", ""}, {"verification_hash", ""}, {"seed", 0}, {"clock", "bag"}};
    header["instances"] = ordered_json::array();
    header["channels"] = ordered_json::array();
    header["transitions"] = ordered_json::array();
    header["behaviours"] = ordered_json::array();
    ordered_json buffers = ordered_json::array();
    for (std::size_t number = 0; number < wanted_.size(); ++number) {
      header["instances"].push_back(wanted_[number].ros.path);
      header["behaviours"].push_back(ordered_json::array());
      buffers.push_back(
          ordered_json::array({wanted_[number].ros.path, number, name_of(Recording::Direction::real_input),
                               wanted_[number].type}));
    }
    header["values"] = {{"limit", std::numeric_limits<std::uint32_t>::max()},
                        {"buffers", std::move(buffers)}};
    return header.dump();
  }

  void take(const mcap::ReadMessage& one) {
    for (std::size_t number = 0; number < feeds_.size() && problem_.empty(); ++number)
      if (feeds_[number]->reads(one.channel.topic))
        problem_ =
            feeds_[number]->take(one, [this, number](const Feed::Value& value) { put(number, value); });
  }

  void put(std::size_t number, const Feed::Value& value) {
    Event event;
    event.time_ns = static_cast<std::int64_t>(
        std::min<std::uint64_t>(value.log_ns - first_ns_, std::numeric_limits<std::int64_t>::max()));
    event.subject = static_cast<std::uint32_t>(value.bytes.size());
    const std::uint32_t flags = ValueFlags::fresh | (value.is_queued ? ValueFlags::queued : 0);
    event.version = static_cast<std::uint32_t>(number) | flags << 24U;
    event.sequence = values_[number]++;
    event.origin = static_cast<std::uint32_t>(number) << 8U | static_cast<std::uint32_t>(Event::Kind::value);
    const std::string text(reinterpret_cast<const char*>(value.bytes.data()), value.bytes.size());
    inputs_.recording += file_bytes(raw_of({event, text}));
    inputs_.end_ns = std::max(inputs_.end_ns, event.time_ns);
    ++inputs_.values;
  }

  const std::string& system_;
  const std::vector<WantedInput>& wanted_;
  std::vector<std::unique_ptr<Feed>> feeds_;
  std::vector<std::uint32_t> values_;  // given to each
  std::uint64_t first_ns_ = std::numeric_limits<std::uint64_t>::max();
  BagInputs inputs_;
  std::string problem_;
};

}  // namespace

std::optional<BagInputs> inputs_of(std::string_view bag, const std::string& system,
                                   const std::vector<WantedInput>& wanted, std::string& error) {
  return Extraction(system, wanted).run(bag, error);
}

}  // namespace tessera::bag
