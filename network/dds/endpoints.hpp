#pragma once

#include <dds/dds.h>

#include <chrono>
#include <map>
#include <memory>
#include <string>

#include "network/dds/deployment.hpp"
#include "network/dds/location.hpp"
#include "network/dds/settings.hpp"

namespace tessera::dds {

/// The entity that a call has made. Errors: SetupError: the call has failed.
dds_entity_t made(dds_entity_t entity, const char* what);
/// Keeps the newest value of each key. A write never waits.
using Qos = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;
[[nodiscard]] Qos newest(dds_reliability_kind_t reliability, dds_durability_kind_t durability);
/// Without letters that are patterns for some implementations.
[[nodiscard]] std::string plain_topic_name(std::string name);

/// The DDS domain of a carrier with everything in it. Each carrier has a domain object of its own, even if
/// others in this process use the same domain number, so that its configuration is its own.
class Domain {
 public:
  /// lease: the others forget a participant that was silent for so long. Errors: SetupError.
  Domain(int number, const Location& location, std::chrono::seconds lease = usual_lease);
  ~Domain();
  Domain(const Domain&) = delete;
  Domain& operator=(const Domain&) = delete;
  [[nodiscard]] dds_entity_t participant() const { return participant_; }

 private:
  dds_entity_t domain_ = 0, participant_ = 0;
};

/// The writers and readers of a process.
///
/// Each process reads from the partition of its own number, and writes to the partitions of the processes
/// that share a channel with it. So a message of a channel never reaches a process without that channel.
class Endpoints {
 public:
  /// Errors: SetupError.
  Endpoints(const Deployment& deployment, int domain, const Location& location);

  struct Writers {
    dds_entity_t data = 0, state = 0;  ///< 0: no channel in this direction
  };
  [[nodiscard]] Writers to(ProcessNumber peer) const;
  [[nodiscard]] dds_entity_t alive_writer() const { return alive_writer_; }
  /// For `tessera top` and the studio; no process reads it.
  [[nodiscard]] dds_entity_t status_writer() const { return status_writer_; }
  [[nodiscard]] dds_entity_t data() const { return data_; }
  [[nodiscard]] dds_entity_t state() const { return state_; }
  [[nodiscard]] dds_entity_t alive() const { return alive_; }
  [[nodiscard]] dds_entity_t announcements() const { return announcements_; }
  /// Waits for any reader, for wake(), or until the time is over.
  void wait(dds_duration_t longest) const;
  /// Threads: any.
  void wake() const { dds_set_guardcondition(guard_, true); }
  /// Whether wake() was called since the last call.
  [[nodiscard]] bool was_woken() const;

 private:
  void make_readers(const Deployment& deployment);
  void make_writers(const Deployment& deployment, ProcessNumber peer);
  void make_alive_writer(const Deployment& deployment);
  void make_status_writer(const Deployment& deployment);
  void announce(const Deployment& deployment) const;
  void wait_for(dds_entity_t reader) const;

  Domain domain_;
  dds_entity_t data_topic_ = 0, state_topic_ = 0, alive_topic_ = 0, announcement_topic_ = 0;
  dds_entity_t waitset_ = 0, guard_ = 0;
  dds_entity_t data_ = 0, state_ = 0, alive_ = 0, announcements_ = 0;
  dds_entity_t alive_writer_ = 0, status_writer_ = 0;
  std::map<ProcessNumber, Writers> writers_;
};

}  // namespace tessera::dds
