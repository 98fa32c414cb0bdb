#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "network/dds/endpoints.hpp"
#include "network/status.hpp"

/// The topic of the state of processes, for `tessera top` and the studio.
namespace tessera::dds {

/// Another format of the texts has another number.
inline constexpr int status_version = 1;

/// One for all nets and lists of processes of a system, so that a user sees that they differ.
[[nodiscard]] std::string status_topic_name(std::string_view system);
/// Best effort: a process never waits for a reader that is slow, stopped or killed.
[[nodiscard]] Qos qos_of_status();

[[nodiscard]] std::size_t matched_readers(dds_entity_t writer);
/// A text that is too long is not sent.
void write_status(dds_entity_t writer, const network::StatusSource& source, network::StatusPart part,
                  std::string_view text);

}  // namespace tessera::dds
