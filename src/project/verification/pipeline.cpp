#include "project/verification/pipeline.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "diagnostics/source.hpp"
#include "layers/closed_pair.hpp"
#include "layers/layers.hpp"
#include "layers/properties.hpp"
#include "net/flatten.hpp"
#include "project/files/assets.hpp"
#include "project/files/file_names.hpp"
#include "project/files/ros2_messages.hpp"
#include "project/files/world_check.hpp"
#include "project/process/listener.hpp"
#include "project/verification/measured_times.hpp"
#include "project/verification/verdicts.hpp"
#include "project/verification/violation.hpp"
#include "spec/model/former_routes.hpp"
#include "spec/parser.hpp"
#include "timing/declared.hpp"
#include "verify/communication/model_soundness.hpp"

namespace tessera::project {

namespace fs = std::filesystem;

fs::path spec_file(const fs::path& given) {
  fs::path inside = given / file_names::specification;
  return fs::exists(inside) ? inside : given;
}

fs::path located(const fs::path& file) {
  const fs::path absolute = fs::absolute(file).lexically_normal();
  return fs::weakly_canonical(absolute.parent_path()) / absolute.filename();
}

std::optional<Specification> read(const fs::path& given, Listener& listener) {
  const fs::path file = spec_file(given);
  return read(diagnostics::load(file), file, listener);
}

std::optional<Specification> read(diagnostics::Diagnostics diagnostics, const fs::path& file,
                                  Listener& listener) {
  std::optional<spec::Model> model;
  if (!diagnostics.has_errors()) model = spec::parse(diagnostics);
  const fs::path absolute = located(file);
  bool found = model && find_messages(*model, absolute.parent_path(), diagnostics);
  found = model && read_measured_times(*model, absolute.parent_path(), diagnostics) && found;
  listener.say(diagnostics);
  if (!found) return std::nullopt;
  return Specification{absolute, absolute.parent_path(), std::move(diagnostics), std::move(*model)};
}

namespace {

/// A verdict on a default property must never be confused with one on a property of the specification.
bool names_are_free(const spec::Model& model, diagnostics::Diagnostics& out) {
  bool free = true;
  for (const spec::Property& property : model.properties) {
    if (std::ranges::count(verify::default_properties(), property.name) == 0) continue;
    out.error("E106", property.span, fmt::format("the property name '{}' is taken", property.name),
              "a property of that name is judged in every system; choose another name");
    free = false;
  }
  return free;
}

}  // namespace

PartialNets build_what_is_possible(const spec::Model& model, diagnostics::Diagnostics& out) {
  PartialNets nets;
  nets.pages = layers::build(model, out);
  if (nets.pages) nets.flat = net::flatten(*nets.pages, out);
  if (nets.flat) nets.properties = layers::properties(model, *nets.pages, *nets.flat, out);
  return nets;
}

Draft draft_of(diagnostics::Diagnostics& text, const fs::path& project) {
  Draft draft;
  draft.model = spec::parse(text);
  if (!draft.model) return draft;
  note_former_routes(*draft.model, text);
  timing::note_missing(*draft.model, text);
  // A mistake in a driver does not change the net.
  if (!project.empty()) {
    find_messages(*draft.model, project, text);
    read_measured_times(*draft.model, project, text);
  }
  judge_models(*draft.model, text);
  draft.nets = build_what_is_possible(*draft.model, text);
  return draft;
}

std::optional<Nets> build(const spec::Model& model, diagnostics::Diagnostics& out) {
  const bool free = names_are_free(model, out);
  PartialNets nets = build_what_is_possible(model, out);
  if (!nets.properties || !free) return std::nullopt;
  return Nets{std::move(*nets.pages), std::move(*nets.flat), std::move(*nets.properties)};
}

std::optional<Nets> build(const Specification& specification, Listener& listener) {
  diagnostics::Diagnostics found = specification.diagnostics.of_same_source();
  std::optional<Nets> nets = build(specification.model, found);
  listener.say(found);
  return nets;
}

bool judge_models(const spec::Model& model, diagnostics::Diagnostics& out) {
  bool sound = true;
  for (const spec::CommunicationModel& one : model.models) {
    const layers::ClosedPair pair = layers::closed_pair(one);
    sound =
        verify::judge_soundness({pair.net, pair.sends_again, pair.receives_again, one.name, one.span}, out) &&
        sound;
  }
  return sound;
}

bool models_are_sound(const Specification& specification, Listener& listener) {
  diagnostics::Diagnostics found = specification.diagnostics.of_same_source();
  const bool sound = judge_models(specification.model, found);
  listener.say(found);
  return sound;
}

bool simulation_is_possible(const Specification& specification, Listener& listener,
                            const std::string& world) {
  diagnostics::Diagnostics found = specification.diagnostics.of_same_source();
  const bool there = check_simulation_files(specification.model, specification.project, found) &&
                     check_world(specification.model, specification.project, world, found);
  listener.say(found);
  return there;
}

const char* name_of(verify::Verdict verdict) {
  switch (verdict) {
    case verify::Verdict::holds:
      return "holds";
    case verify::Verdict::violated:
      return "violated";
    case verify::Verdict::unknown:
      return "unknown";
  }
  return "";
}

namespace {

std::string list_of(const std::vector<const verify::PropertyResult*>& properties) {
  std::string names;
  for (const verify::PropertyResult* property : properties)
    names += (names.empty() ? "" : ", ") + property->name;
  return names;
}

std::vector<const verify::PropertyResult*> with_verdict(const verify::Report& report,
                                                        verify::Verdict verdict) {
  std::vector<const verify::PropertyResult*> found;
  for (const verify::PropertyResult& property : report.properties)
    if (property.verdict == verdict && !property.warning) found.push_back(&property);
  return found;
}

/// false: it does not pass. The first violation is shown; the others usually have the same cause.
bool passes(const Nets& nets, const verify::Report& report, const VerificationGate& gate,
            const fs::path& given, Listener& listener) {
  for (const verify::PropertyResult* property : with_verdict(report, verify::Verdict::unknown))
    listener.warn(fmt::format("{} is unknown: {}", property->name, property->why));
  const auto violated = with_verdict(report, verify::Verdict::violated);
  if (violated.empty()) return true;
  if (gate.accept_violations) {
    listener.warn(list_of(violated) + " violated, and accepted");
    return true;
  }
  listener.say(text_of(nets.flat, *violated.front()));
  listener.complain(fmt::format("no controller is made of a net that violates {}", list_of(violated)));
  listener.say(fmt::format(
      "hint: `tessera verify {}` shows every violation; --accept-violations makes the controller all "
      "the same\n",
      given.string()));
  return false;
}

}  // namespace

std::optional<Verified> run_pipeline(const fs::path& given, const VerificationGate& gate,
                                     Listener& listener) {
  std::optional<Specification> specification = read(given, listener);
  if (!specification || !models_are_sound(*specification, listener)) return std::nullopt;
  std::optional<Nets> nets = build(*specification, listener);
  if (!nets) return std::nullopt;
  verify::Report report = verify_or_recall(*specification, *nets, gate, listener);
  if (!passes(*nets, report, gate, given, listener)) return std::nullopt;
  std::optional<verify::VerifiedNet> verified = verify::accept(
      std::move(nets->flat), std::move(report), {.unknown = true, .violated = gate.accept_violations});
  if (!verified) return std::nullopt;
  return Verified{std::move(*specification), std::move(*verified)};
}

}  // namespace tessera::project
