#include "monitor.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "tessera/net_words.hpp"

namespace tessera::test {
namespace {

using Marking = std::uint32_t;

std::optional<Marking> moved(Marking marking, const std::vector<std::uint32_t>& takes,
                             const std::vector<std::uint32_t>& gives) {
  for (const std::uint32_t place : takes) {
    if ((marking >> place & 1U) == 0) return std::nullopt;
    marking &= ~(1U << place);
  }
  for (const std::uint32_t place : gives) {
    if ((marking >> place & 1U) != 0) throw std::logic_error("the net is not safe");
    marking |= 1U << place;
  }
  return marking;
}

}  // namespace

Monitor::Monitor(layers::SideMode send, layers::SideMode receive)
    : model_(layers::networked(send, receive)),
      blocks_(send.blocks),
      waiting_(1U << static_cast<std::uint32_t>(model_.shared.size())) {
  if (model_.shared.size() > 5) throw std::logic_error("more markings than bits");
}

std::uint32_t Monitor::place(std::string_view name) const {
  const auto found = std::ranges::find(model_.shared, name, &spec::SharedPlace::name);
  if (found == model_.shared.end()) throw std::logic_error("no such shared place");
  return static_cast<std::uint32_t>(found - model_.shared.begin());
}

std::uint32_t Monitor::own(const spec::ModelSide& side, std::string_view name) const {
  return static_cast<std::uint32_t>(std::ranges::find(side.places, name, &spec::ModelSide::Place::name) -
                                    side.places.begin());
}

Monitor::Markings Monitor::each(Markings markings,
                                const std::function<void(Marking, Markings&)>& successors) const {
  Markings all = 0;
  for (Marking marking = 0; marking < 64; ++marking)
    if ((markings >> marking & 1U) != 0) successors(marking, all);
  return all;
}

/// Adds every marking that firings of the medium alone lead to.
Monitor::Markings Monitor::with_medium(Markings markings) const {
  while (true) {
    const Markings more = markings | each(markings, [&](Marking marking, Markings& all) {
                            for (const spec::MediumTransition& transition : model_.medium)
                              if (const auto next = moved(marking, transition.takes, transition.gives))
                                all |= Markings{1} << *next;
                          });
    if (more == markings) return markings;
    markings = more;
  }
}

Monitor::Markings Monitor::initial() const {
  Marking marking = 0;
  for (std::uint32_t place = 0; place < model_.shared.size(); ++place)
    if (model_.shared[place].tokens > 0) marking |= 1U << place;
  return with_medium(Markings{1} << marking);
}

/// The transitions of the sender that end a step of its user.
Monitor::Markings Monitor::fired(Markings markings, bool waiting_before,
                                 const std::function<bool(const spec::ModelSide::Transition&)>& which) const {
  return with_medium(each(markings, [&](Marking marking, Markings& all) {
    if (((marking & waiting_) != 0) != waiting_before) return;
    for (const spec::ModelSide::Transition& transition : model_.send.transitions) {
      if (!which(transition)) continue;
      const auto next = moved(marking & ~waiting_, transition.takes, transition.gives);
      const bool waits = blocks_ && transition.to == own(model_.send, words::waiting);
      if (next) all |= Markings{1} << (*next | (waits ? waiting_ : 0U));
    }
  }));
}

Monitor::Markings Monitor::write(Markings markings) const {
  const std::uint32_t work = own(model_.send, words::transfer);
  return fired(markings, false,
               [&](const spec::ModelSide::Transition& transition) { return transition.from == work; });
}

Monitor::Markings Monitor::acknowledged(Markings markings) const {
  const std::uint32_t wait = own(model_.send, words::waiting);
  return fired(markings, true, [&](const spec::ModelSide::Transition& transition) {
    return transition.from == wait && !transition.elapsed;
  });
}

Monitor::Markings Monitor::time_up(Markings markings) const {
  return fired(markings, true,
               [](const spec::ModelSide::Transition& transition) { return transition.elapsed; });
}

Monitor::Markings Monitor::read(Markings markings) const {
  const std::uint32_t work = own(model_.receive, words::transfer);
  for (const bool begins : {true, false})
    markings = with_medium(each(markings, [&](Marking marking, Markings& all) {
      for (const spec::ModelSide::Transition& transition : model_.receive.transitions)
        if ((begins ? transition.to : transition.from) == work)
          if (const auto next = moved(marking, transition.takes, transition.gives))
            all |= Markings{1} << *next;
    }));
  return markings;
}

Monitor::Markings Monitor::skip(Markings markings) const {
  return with_medium(each(markings, [&](Marking marking, Markings& all) {
    for (const spec::ModelSide::Transition& transition : model_.receive.transitions)
      if (transition.from == spec::ModelSide::in && transition.to == spec::ModelSide::out)
        if (const auto next = moved(marking, transition.takes, transition.gives)) all |= Markings{1} << *next;
  }));
}

/// It forgets its state; messages on the way may arrive or not.
Monitor::Markings Monitor::sender_restarted(Markings markings) const {
  const Marking slots = 1U << place(words::empty) | 1U << place(words::full);
  return with_medium(each(markings, [&](Marking marking, Markings& all) {
    all |= Markings{1} << (marking & ~waiting_);
    all |= Markings{1} << ((marking & slots) | 1U << place(words::idle));
  }));
}

/// Its state is gone; a value that was not acknowledged is sent again.
Monitor::Markings Monitor::receiver_restarted(Markings markings) const {
  const Marking slots = 1U << place(words::empty) | 1U << place(words::full);
  return with_medium(each(markings, [&](Marking marking, Markings& all) {
    const Marking emptied = (marking & ~slots) | 1U << place(words::empty);
    const Marking nothing = (marking & waiting_) | 1U << place(words::empty);
    all |= Markings{1} << emptied;
    all |= Markings{1} << (nothing | 1U << place(words::idle));
    if (!blocks_ || (marking & waiting_) != 0) all |= Markings{1} << (nothing | 1U << place(words::sent));
  }));
}

}  // namespace tessera::test
