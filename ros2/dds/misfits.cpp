#include "ros2/dds/misfits.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace tessera::ros2 {
namespace {

/// The values of the policies that can keep two endpoints apart.
struct Offer {
  dds_reliability_kind_t reliability = DDS_RELIABILITY_BEST_EFFORT;
  dds_durability_kind_t durability = DDS_DURABILITY_VOLATILE;
  dds_duration_t deadline = DDS_INFINITY;
  dds_liveliness_kind_t liveliness = DDS_LIVELINESS_AUTOMATIC;
  dds_duration_t lease = DDS_INFINITY;
};

Offer offer_in(const dds_qos_t* qos) {
  Offer offer;
  dds_duration_t block = 0;
  dds_qget_reliability(qos, &offer.reliability, &block);
  dds_qget_durability(qos, &offer.durability);
  dds_qget_deadline(qos, &offer.deadline);
  dds_qget_liveliness(qos, &offer.liveliness, &offer.lease);
  return offer;
}

const char* text_of(dds_reliability_kind_t kind) {
  return kind == DDS_RELIABILITY_RELIABLE ? "reliable" : "best_effort";
}
const char* text_of(dds_durability_kind_t kind) {
  switch (kind) {
    case DDS_DURABILITY_VOLATILE:
      return "volatile";
    case DDS_DURABILITY_TRANSIENT_LOCAL:
      return "transient_local";
    default:
      return "transient";
  }
}
const char* text_of(dds_liveliness_kind_t kind) {
  switch (kind) {
    case DDS_LIVELINESS_AUTOMATIC:
      return "automatic";
    case DDS_LIVELINESS_MANUAL_BY_PARTICIPANT:
      return "manual by participant";
    default:
      return "manual by topic";
  }
}
std::string text_of(dds_duration_t duration) {
  return duration == DDS_INFINITY ? "none" : std::to_string(duration / DDS_MSECS(1)) + " ms";
}

struct Difference {
  const char* policy;
  std::string offered, requested;
  const char* way_out;  ///< what our side can write; empty: nothing
};

/// we_write: ours is the offer.
std::vector<Difference> differences(const Offer& offered, const Offer& requested, bool we_write) {
  std::vector<Difference> found;
  if (offered.reliability < requested.reliability)
    found.push_back({"reliability", text_of(offered.reliability), text_of(requested.reliability),
                     we_write ? "qos: { reliability: reliable }" : "qos: { reliability: best_effort }"});
  if (offered.durability < requested.durability)
    found.push_back({"durability", text_of(offered.durability), text_of(requested.durability),
                     we_write ? "qos: { durability: transient_local }" : "qos: { durability: volatile }"});
  if (offered.deadline > requested.deadline)
    found.push_back({"deadline", text_of(offered.deadline), text_of(requested.deadline), ""});
  if (offered.liveliness < requested.liveliness)
    found.push_back({"liveliness", text_of(offered.liveliness), text_of(requested.liveliness), ""});
  else if (offered.lease > requested.lease)
    found.push_back({"lease of the liveliness", text_of(offered.lease), text_of(requested.lease), ""});
  return found;
}

class Finder {
 public:
  Finder(dds_entity_t own, bool writes, const std::string& topic, const std::string& dds_topic,
         const std::string& dds_type)
      : writes_(writes), topic_(topic), dds_topic_(dds_topic), dds_type_(dds_type) {
    dds_qos_t* const qos = dds_create_qos();
    if (dds_get_qos(own, qos) == DDS_RETCODE_OK) own_ = offer_in(qos);
    dds_delete_qos(qos);
  }

  void note(const dds_builtintopic_endpoint_t& other) {
    if (!own_ || other.topic_name != dds_topic_) return;
    const std::string who = std::string(writes_ ? "a subscriber of " : "a publisher of ") + topic_;
    if (other.type_name != dds_type_)
      return tell(who + " has the type " + other.type_name + ", and ours is " + dds_type_);
    const Offer others = offer_in(other.qos);
    const auto found = writes_ ? differences(*own_, others, true) : differences(others, *own_, false);
    for (const Difference& one : found) {
      std::string text = who + (writes_ ? " requests " : " offers ") + one.policy + " " +
                         (writes_ ? one.requested : one.offered) + ", and ours " +
                         (writes_ ? "offers " + one.offered : "requests " + one.requested);
      if (*one.way_out != '\0' && dds_topic_.starts_with("rt/"))
        text += std::string(" (`") + one.way_out + "` in the driver would fit)";
      tell(std::move(text));
    }
  }

  [[nodiscard]] std::vector<std::string> take() { return std::move(texts_); }

 private:
  void tell(std::string text) {
    if (std::ranges::find(texts_, text) == texts_.end()) texts_.push_back(std::move(text));
  }

  bool writes_;
  std::string topic_, dds_topic_, dds_type_;
  std::optional<Offer> own_;
  std::vector<std::string> texts_;
};

}  // namespace

std::vector<std::string> misfits(dds_entity_t participant, dds_entity_t own, bool writes,
                                 const std::string& topic, const std::string& dds_topic,
                                 const std::string& dds_type) {
  Finder finder(own, writes, topic, dds_topic, dds_type);
  const dds_entity_t others = writes ? DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION : DDS_BUILTIN_TOPIC_DCPSPUBLICATION;
  const dds_entity_t reader = dds_create_reader(participant, others, nullptr, nullptr);
  if (reader < 0) return {};
  constexpr std::size_t most = 32;
  for (;;) {
    std::array<void*, most> samples{};
    std::array<dds_sample_info_t, most> infos{};
    const dds_return_t count = dds_take(reader, samples.data(), infos.data(), most, most);
    if (count <= 0) break;
    for (std::size_t index = 0; index < static_cast<std::size_t>(count); ++index)
      if (infos[index].valid_data && infos[index].instance_state == DDS_ALIVE_INSTANCE_STATE)
        finder.note(*static_cast<const dds_builtintopic_endpoint_t*>(samples[index]));
    static_cast<void>(dds_return_loan(reader, samples.data(), count));
  }
  dds_delete(reader);
  return finder.take();
}

}  // namespace tessera::ros2
