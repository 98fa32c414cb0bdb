#include "bag/bag_inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "bag/buffer_channel.hpp"
#include "bag/raw_channel.hpp"
#include "mcap/reader.hpp"
#include "tessera/recording.hpp"

namespace tessera::bag {
namespace {

using nlohmann::ordered_json;

/// A topic of the bag that feeds an input.
struct Feed {
  std::optional<ros2::Translator> translator;
  std::uint64_t messages = 0, misfits = 0;
};

class Extraction {
 public:
  Extraction(const std::string& system, const std::vector<WantedInput>& wanted)
      : system_(system), wanted_(wanted), feeds_(wanted.size()) {}

  std::optional<BagInputs> run(std::string_view bag, std::string& error) {
    const mcap::Condition found = mcap::read(bag, {.message = [this](const mcap::ReadMessage& one) {
                                               first_ns_ = std::min(first_ns_, one.message.log_ns);
                                             }});
    if (!found.is_mcap) {
      error = "is no MCAP file";
      return std::nullopt;
    }
    inputs_.recording = file_start(header());
    static_cast<void>(mcap::read(bag, {.message = [this](const mcap::ReadMessage& one) { take(one); }}));
    if (problem_.empty() && inputs_.values == 0) problem_ = "has no value for any real input";
    if (!problem_.empty()) {
      error = problem_;
      return std::nullopt;
    }
    inputs_.recording += raw_end(inputs_.end_ns, 0);
    if (const std::string told = found.told(); !told.empty()) inputs_.notes.push_back(told);
    tell();
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
    for (std::size_t number = 0; number < wanted_.size() && problem_.empty(); ++number)
      if (wanted_[number].ros.topic == one.channel.topic) take(one, number);
  }

  void take(const mcap::ReadMessage& one, std::size_t number) {
    const WantedInput& wanted = wanted_[number];
    const std::string type = one.schema == nullptr ? "an unknown type" : one.schema->name;
    if (one.channel.encoding != "cdr" || type != wanted.ros.type) {
      problem_ = fmt::format("has {} messages of {} on {}, and the driver of {} wants cdr messages of {}",
                             one.channel.encoding, type, wanted.ros.topic, wanted.ros.path, wanted.ros.type);
      return;
    }
    Feed& feed = feeds_[number];
    if (!feed.translator) {
      RosBuffer ros = wanted.ros;
      if (one.schema->encoding == "ros2msg") ros.definition = one.schema->data;
      std::string why;
      feed.translator = translator_of(ros, wanted.type, ros2::Direction::receive, why);
      if (!feed.translator) {
        problem_ = fmt::format("has messages of {} that {} cannot take: {}", type, wanted.ros.path, why);
        return;
      }
    }
    ++feed.messages;
    std::vector<std::byte> value;
    if (feed.translator->decode(std::as_bytes(std::span(one.message.data)), value) !=
        ros2::Translator::Outcome::good)
      ++feed.misfits;
    else
      put(number, one.message.log_ns, {reinterpret_cast<const char*>(value.data()), value.size()});
  }

  void put(std::size_t number, std::uint64_t log_ns, std::string_view value) {
    Event event;
    event.time_ns = static_cast<std::int64_t>(
        std::min<std::uint64_t>(log_ns - first_ns_, std::numeric_limits<std::int64_t>::max()));
    event.subject = static_cast<std::uint32_t>(value.size());
    event.version = static_cast<std::uint32_t>(number) | ValueFlags::fresh << 24U;
    event.sequence = static_cast<std::uint32_t>(feeds_[number].messages - feeds_[number].misfits - 1);
    event.origin = static_cast<std::uint32_t>(number) << 8U | static_cast<std::uint32_t>(Event::Kind::value);
    inputs_.recording += file_bytes(raw_of({event, std::string(value)}));
    inputs_.end_ns = std::max(inputs_.end_ns, event.time_ns);
    ++inputs_.values;
  }

  void tell() {
    for (std::size_t number = 0; number < wanted_.size(); ++number) {
      const RosBuffer& ros = wanted_[number].ros;
      if (feeds_[number].messages == 0)
        inputs_.notes.push_back(fmt::format("has no message on {}: {} gets no value", ros.topic, ros.path));
      else if (feeds_[number].misfits > 0)
        inputs_.notes.push_back(fmt::format("{} of {} messages on {} do not fit into {} and are left out",
                                            feeds_[number].misfits, feeds_[number].messages, ros.topic,
                                            ros.path));
    }
  }

  const std::string& system_;
  const std::vector<WantedInput>& wanted_;
  std::vector<Feed> feeds_;
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
