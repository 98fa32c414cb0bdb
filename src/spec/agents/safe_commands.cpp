#include "spec/agents/safe_commands.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "diagnostics/utf8.hpp"
#include "spec/document/section.hpp"
#include "spec/values/literals.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

std::string joined(const std::string& path, const std::string& name) {
  return path.empty() || name.empty() ? path + name : path + "." + name;
}

class SafeReader {
 public:
  SafeReader(const Entry* section, const Types& types, Subsystem& subsystem, Diagnostics& out)
      : section_(section), types_(types), subsystem_(subsystem), out_(out) {}

  void read() {
    subsystem_.safe = std::vector<std::string>(subsystem_.real.size());
    std::vector<const Node*> given(subsystem_.real.size());
    if (section_ != nullptr)
      for (const Entry& value : entries_of(*section_->value, section_->span, "safe", out_))
        read_one(value, given);
    for (const RealId real : subsystem_.real.ids()) warn_of_zeros(real, given[real.value]);
  }

 private:
  void read_one(const Entry& value, std::vector<const Node*>& given) {
    const auto found = std::ranges::find(subsystem_.real, value.key, &Field::name);
    if (found == subsystem_.real.end()) {
      std::vector<std::string> names;
      for (const Field& one : subsystem_.real) names.push_back(one.name);
      out_.error("E101", value.span, "unknown real buffer " + in_quotes(value.key),
                 did_you_mean(value.key, names));
      return;
    }
    const RealId real{static_cast<std::uint32_t>(found - subsystem_.real.begin())};
    std::vector<NonFiniteNumber> special;
    subsystem_.safe[real] =
        initialiser(*value.value, value.span, found->type, types_, "the safe command", out_, &special)
            .value_or("");
    given[real.value] = value.value;
    for (const NonFiniteNumber& number : special)
      if (!subsystem_.may_be_non_finite(real, number.path))
        out_.error("E216", number.span,
                   in_quotes(joined(value.key, number.path)) + " must be a finite number",
                   "if the device gives it a meaning: limits: { " + joined(value.key, number.path) +
                       ": { non_finite: allowed } }");
  }

  /// A device that knows NaN often takes zero for a command: PX4 flies to a position of zero.
  void warn_of_zeros(RealId real, const Node* given) {
    std::string unsaid;
    collect_unsaid(real, subsystem_.real[real].type, given, "", unsaid);
    if (unsaid.empty()) return;
    const std::string& name = subsystem_.real[real].name;
    out_.warning("W340", section_ == nullptr ? subsystem_.real[real].span : section_->span,
                 "the safe command of " + in_quotes(name) + " does not say " + unsaid +
                     ", which may be NaN, so that it is zero",
                 "say it in `safe`: .nan, if that means `no command` to the device, or 0");
  }

  void collect_unsaid(RealId real, const Type& type, const Node* given, const std::string& path,
                      std::string& unsaid) {
    const bool said = given != nullptr && !(given->is_map() && type.kind == Type::Kind::structure);
    if (said || !types_.holds_floats(type)) return;
    const bool divided = subsystem_.divides_non_finite(real, path);
    if (type.kind == Type::Kind::structure && type.extent == 0 && (given != nullptr || divided)) {
      for (const Field& field : types_.structures()[type.structure].fields) {
        const Node* part = nullptr;
        if (given != nullptr)
          for (const Entry& entry : given->entries)
            if (entry.key == field.name) part = entry.value;
        collect_unsaid(real, field.type, part, joined(path, field.name), unsaid);
      }
      return;
    }
    if (!subsystem_.may_be_non_finite(real, path)) return;
    unsaid += (unsaid.empty() ? "" : ", ") + (path.empty() ? "its value" : in_quotes(path));
  }

  const Entry* section_;
  const Types& types_;
  Subsystem& subsystem_;
  Diagnostics& out_;
};

}  // namespace

void read_safe(const Entry* entry, const Types& types, Subsystem& subsystem, Diagnostics& out) {
  SafeReader(entry, types, subsystem, out).read();
}

}  // namespace tessera::spec
