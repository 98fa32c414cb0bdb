#include "network/dds/status/status_topic.hpp"

#include "wire.h"

namespace tessera::dds {

std::string status_topic_name(std::string_view system) {
  return plain_topic_name("tessera/status/" + std::to_string(status_version) + "/" + std::string(system));
}

Qos qos_of_status() { return newest(DDS_RELIABILITY_BEST_EFFORT, DDS_DURABILITY_VOLATILE); }

std::size_t matched_readers(dds_entity_t writer) {
  dds_publication_matched_status_t status{};
  return dds_get_publication_matched_status(writer, &status) == DDS_RETCODE_OK ? status.current_count : 0;
}

void write_status(dds_entity_t writer, const network::StatusSource& source, network::StatusPart part,
                  std::string_view text) {
  if (text.size() > network::longest_status_bytes) return;
  tessera_wire_Status sample{};
  sample.process = source.process;
  sample.incarnation = source.incarnation;
  sample.part = static_cast<std::uint8_t>(part);
  // The middleware reads them only. Its type knows no constant bytes.
  sample.text._buffer = const_cast<std::uint8_t*>(reinterpret_cast<const std::uint8_t*>(text.data()));
  sample.text._length = sample.text._maximum = static_cast<std::uint32_t>(text.size());
  dds_write(writer, &sample);
}

}  // namespace tessera::dds
