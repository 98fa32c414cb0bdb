#include "office/control.hpp"

#include <array>

#include "errands.hpp"

namespace features::office::control {
namespace {

using Going = std::array<std::uint8_t, 6>;
/// The states that errands go through, by their numbers. The fourth breaks every rule, and never ends.
constexpr std::array<Going, 5> lives{
    {{9, 9, 9, 8, 8, 8}, {9, 1, 2, 2, 4, 4}, {9, 7, 7, 7, 7, 7}, {1, 2, 2, 6, 6, 6}, {2, 1, 9, 0, 99, 2}}};

}  // namespace

/// Behaviour answer of office.control.
void answer(Context& context, const Inputs& in, Memory&, Outputs& out) {
  static std::uint64_t since = 0;
  static bool cancels = false;
  if (!in.errand.valid) {
    out.progress = {0, 0};
    return;
  }
  if (in.errand.call != out.progress.call || in.errand.cancel != cancels) since = context.iteration;
  if (served_errands.empty() || served_errands.back() != in.errand.call)
    served_errands.push_back(in.errand.call);
  cancels = in.errand.cancel;
  const auto age = static_cast<std::size_t>(context.iteration - since);
  const Going& going = lives[in.errand.call % lives.size()];
  std::uint8_t state = going[age < going.size() ? age : going.size() - 1];
  if (cancels) state = age < 3 ? 3 : 5;
  out.progress = {in.errand.call, state};
  if (in.errand.call % lives.size() == 4 && age == 8) out.progress = {in.errand.call + 70, 4};
}

}  // namespace features::office::control
