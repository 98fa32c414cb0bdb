#pragma once

#include <string>

#include "assembly/assembler.hpp"

namespace tessera {

/// An assembler that is kept, and makes the subsystems of one process again (ProcessRestarts).
class RestartingAssembler final : public Assembler, public ProcessRestarts {
 public:
  using Assembler::Assembler;
  RestartingAssembler(const RestartingAssembler&) = delete;
  RestartingAssembler& operator=(const RestartingAssembler&) = delete;
  /// Some drivers may have been made although a later step has failed.
  ~RestartingAssembler() override {
    for (SubsystemParts& parts : parts_) destroy_drivers(parts);
  }
  void kill(std::uint32_t process) override;
  [[nodiscard]] bool restart(std::uint32_t process, network::Incarnation incarnation,
                             std::string& error) override;

 private:
  [[nodiscard]] bool is_in(const End& end, std::uint32_t process) const;
  [[nodiscard]] bool make_subsystems(std::uint32_t process);
  [[nodiscard]] bool link_again(std::uint32_t process);
  [[nodiscard]] bool set_values_again(std::uint32_t process);
  [[nodiscard]] bool make_channels_again(std::uint32_t process, network::Incarnation incarnation);
  [[nodiscard]] bool replace_executors(std::uint32_t process);
};

}  // namespace tessera
