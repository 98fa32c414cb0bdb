#include "ros2/tf/missing_transform.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

#include "tessera/nearest.hpp"

namespace tessera::ros2 {
namespace {

using MissingOutcome = TransformBuffer::Answer::Outcome;

/// "map, odom, base_link and 12 others"
std::string list_of_frames(std::vector<std::string> names) {
  constexpr std::size_t most = 20;
  const std::size_t others = names.size() > most ? names.size() - most : 0;
  names.resize(names.size() - others);
  const std::string listed = fmt::format("{}", fmt::join(names, ", "));
  return others == 0 ? listed : fmt::format("{} and {} others", listed, others);
}

/// The reason without the frames that become known little by little.
std::string kind_of(const TransformBuffer::Answer& answer, const TransformBuffer& known) {
  const bool nothing = answer.outcome == MissingOutcome::unknown_frame && known.is_empty();
  return nothing ? "nothing"
                 : fmt::format("{} {}", static_cast<int>(answer.outcome), fmt::join(answer.frames, " "));
}

}  // namespace

MissingTransform::MissingTransform(std::string frame, std::string in, std::string at, std::string topic,
                                   Clock::time_point now)
    : frame_(std::move(frame)),
      in_(std::move(in)),
      at_(std::move(at)),
      topic_(std::move(topic)),
      missing_since_(now) {}

std::optional<std::string> MissingTransform::look(const TransformBuffer::Answer& answer,
                                                  Clock::time_point now, const TransformBuffer& known) {
  if (answer.outcome == MissingOutcome::found) {
    missing_since_.reset();
    if (std::exchange(told_, {}).empty()) return std::nullopt;
    return fmt::format("the transform of `{}` in `{}` is there", frame_, in_);
  }
  if (!missing_since_) missing_since_ = now;
  if (now - *missing_since_ < patience || !told_.insert(kind_of(answer, known)).second) return std::nullopt;
  return fmt::format("there is no transform of `{}` in `{}`: {}", frame_, in_, reason(answer, known));
}

std::string MissingTransform::reason(const TransformBuffer::Answer& answer,
                                     const TransformBuffer& known) const {
  const std::vector<std::string>& frames = answer.frames;
  switch (answer.outcome) {
    case MissingOutcome::unknown_frame: {
      if (known.is_empty()) return fmt::format("nothing has come on {}", topic_);
      const std::vector<std::string> all = known.frames();
      return with_hint(fmt::format("no frame `{}`; known: {}", frames[0], list_of_frames(all)),
                       did_you_mean(frames[0], all));
    }
    case MissingOutcome::unconnected:
      return fmt::format("they are in two trees, whose roots are `{}` and `{}`", frames[0], frames[1]);
    case MissingOutcome::loop:
      return fmt::format("the frames {} are a loop, each the parent of another", list_of_frames(frames));
    case MissingOutcome::no_common_time:
      if (!at_.empty()) return fmt::format("`{}` is not known at the stamps of {}", frames[0], at_);
      return fmt::format(
          "the frames between them are known at no common time; `{}` is not known at that of "
          "the others",
          frames[0]);
    case MissingOutcome::found:
      break;
  }
  return {};
}

}  // namespace tessera::ros2
