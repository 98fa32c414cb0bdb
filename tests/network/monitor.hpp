#pragma once

#include <cstdint>
#include <functional>

#include "layers/networked.hpp"
#include "spec/model/communication_model.hpp"

namespace tessera::test {

/// Follows the actions of the users of a channel on the net that the layers draw for it, and keeps all
/// possible markings, because the actions of the medium are not visible. No marking: the actions are no run
/// of the net.
class Monitor {
 public:
  using Markings = std::uint64_t;  ///< a set: one bit per marking

  Monitor(layers::SideMode send, layers::SideMode receive);

  [[nodiscard]] Markings initial() const;
  [[nodiscard]] Markings write(Markings markings) const;
  [[nodiscard]] Markings acknowledged(Markings markings) const;
  [[nodiscard]] Markings time_up(Markings markings) const;
  [[nodiscard]] Markings read(Markings markings) const;
  [[nodiscard]] Markings skip(Markings markings) const;
  /// A restart is no transition of the net; these are the markings from which it goes on.
  [[nodiscard]] Markings sender_restarted(Markings markings) const;
  [[nodiscard]] Markings receiver_restarted(Markings markings) const;

 private:
  /// One bit per shared place, and one for a sender that waits.
  using Marking = std::uint32_t;
  using Places = std::vector<std::uint32_t>;

  [[nodiscard]] Markings each(Markings markings,
                              const std::function<void(Marking, Markings&)>& successors) const;
  [[nodiscard]] Markings with_medium(Markings markings) const;
  [[nodiscard]] Markings fired(Markings markings, bool waiting_before,
                               const std::function<bool(const spec::ModelSide::Transition&)>& which) const;
  [[nodiscard]] std::uint32_t place(std::string_view name) const;
  [[nodiscard]] std::uint32_t own(const spec::ModelSide& side, std::string_view name) const;

  spec::CommunicationModel model_;
  bool blocks_;
  Marking waiting_;  ///< the bit of a sender that waits
};

}  // namespace tessera::test
