#include "network/repetition.hpp"

#include <algorithm>

// Both machines are templates over their rules. This file compiles them once with the rules of the product.
#include "network/receiver.hpp"
#include "network/sender.hpp"

namespace tessera::network {

void Repetition::again() {
  sent_ = std::min(sent_ + 1, recalls);
  if (!recall_) next_ = std::min(2 * next_, longest);
}

template class BasicSender<>;
template class BasicReceiver<>;

}  // namespace tessera::network
