#include "spec/agents/limits.hpp"

#include <algorithm>
#include <string>
#include <string_view>

#include "diagnostics/utf8.hpp"
#include "spec/document/section.hpp"
#include "spec/values/literals.hpp"
#include "spec/values/quantities.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

constexpr const char* limits_hint = "for example left: { min: -10, max: 10, per_second: 50 }";
constexpr std::uint64_t most_elements = 256;

/// The number that a path such as "pose.x" leads to, and its value in the safe command.
struct Target {
  RealId real{};
  const Type* type = nullptr;
  std::string field;           ///< path inside the buffer: "pose.x"
  const Node* safe = nullptr;  ///< nullptr: not given, which means zero
};

class LimitReader {
 public:
  LimitReader(const Entry* safe, const std::vector<Field>& real, const Types& types, Diagnostics& out)
      : safe_(safe), real_(real), types_(types), out_(out) {}

  void read(const Entry& section, Subsystem& subsystem) {
    for (const Entry& entry : entries_of(*section.value, section.span, "limits", out_)) read_one(entry);
    subsystem.limits = std::move(limits_);
    subsystem.non_finite = std::move(non_finite_);
  }

 private:
  void read_one(const Entry& entry) {
    const std::optional<Target> target = find(entry);
    const Section section(*entry.value, entry.span, "a limit",
                          {"min", "max", "per_second", "beyond", "non_finite"}, out_);
    if (!target || !section.readable()) return;
    read_non_finite(entry, section, *target);
    const bool limits =
        std::ranges::any_of(entry.value->entries, [](const Entry& key) { return key.key != "non_finite"; });
    if (!limits && section.find("non_finite") != nullptr) return;
    if (!holds_numbers(*target->type)) {
      out_.error("E211", entry.span, in_quotes(entry.key) + " holds no numbers that could be limited",
                 "a limit is for a number, or for a short array of numbers");
      return;
    }
    Limit limit;
    limit.real = target->real;
    limit.field = target->field;
    limit.span = entry.span;
    limit.minimum = number(section.find("min"), *target->type);
    limit.maximum = number(section.find("max"), *target->type);
    limit.per_second = number(section.find("per_second"), *target->type);
    read_beyond(section.find("beyond"), limit);
    if (limit.per_second && target->type->scalar != Scalar::float64 &&
        target->type->scalar != Scalar::float32)
      out_.error("E211", entry.span,
                 "per_second is for floating-point numbers, and this is " + types_.spelled(*target->type));
    if (check(entry, section, limit)) check_safe(entry, *target, limit);
    limits_.push_back(std::move(limit));
  }

  /// Follows the names of the key through buffer and structures.
  std::optional<Target> find(const Entry& entry) {
    Target target;
    const std::string_view path = entry.key;
    const std::string buffer(path.substr(0, path.find('.')));
    const auto found =
        std::find_if(real_.begin(), real_.end(), [&](const Field& one) { return one.name == buffer; });
    if (found == real_.end()) return unknown(entry, "real buffer", buffer, real_);
    target.real = {static_cast<std::uint32_t>(found - real_.begin())};
    target.type = &found->type;
    if (safe_ != nullptr && safe_->value->is_map()) target.safe = value_of(*safe_->value, buffer);
    for (std::size_t at = buffer.size(); at < path.size();) {
      const std::size_t end = std::min(path.find('.', at + 1), path.size());
      const std::string name(path.substr(at + 1, end - at - 1));
      if (!step(entry, name, target)) return std::nullopt;
      at = end;
    }
    if (Types::is_unknown(*target.type)) return std::nullopt;
    return target;
  }

  /// `non_finite: allowed`: the device gives NaN or infinity a meaning.
  void read_non_finite(const Entry& entry, const Section& section, const Target& target) {
    const Entry* const key = section.find("non_finite");
    if (key == nullptr) return;
    const Node* text = text_of(*key->value, key->span, "non_finite", out_, "write allowed or fault");
    if (text == nullptr) return;
    if (text->text != "allowed" && text->text != "fault") {
      out_.error("E104", text->span, "non_finite must be allowed or fault, not " + in_quotes(text->text),
                 did_you_mean(text->text, {"allowed", "fault"}));
    } else if (!types_.holds_floats(*target.type)) {
      out_.error("E211", entry.span, in_quotes(entry.key) + " holds no floating-point numbers",
                 "only a float32 or float64 can be infinite or NaN");
    } else {
      non_finite_.push_back({target.real, target.field, text->text == "allowed", entry.span});
    }
  }

  bool step(const Entry& entry, const std::string& name, Target& target) {
    if (Types::is_unknown(*target.type)) return false;  // which has been said
    if (target.type->kind != Type::Kind::structure || target.type->extent > 0) {
      out_.error("E101", entry.span, in_quotes(entry.key) + " leads through something that has no fields");
      return false;
    }
    const std::vector<Field>& fields = types_.fields_of(*target.type);
    const auto found =
        std::find_if(fields.begin(), fields.end(), [&](const Field& one) { return one.name == name; });
    if (found == fields.end()) return unknown(entry, "field", name, fields).has_value();
    target.type = &found->type;
    target.field += (target.field.empty() ? "" : ".") + name;
    target.safe = target.safe != nullptr && target.safe->is_map() ? value_of(*target.safe, name) : nullptr;
    return true;
  }

  std::optional<Target> unknown(const Entry& entry, const std::string& what, const std::string& name,
                                const std::vector<Field>& known) {
    std::vector<std::string> names;
    for (const Field& one : known) names.push_back(one.name);
    out_.error("E101", entry.span, "unknown " + what + " " + in_quotes(name), did_you_mean(name, names));
    return std::nullopt;
  }

  static const Node* value_of(const Node& map, const std::string& name) {
    const auto found = std::find_if(map.entries.begin(), map.entries.end(),
                                    [&](const Entry& one) { return one.key == name; });
    return found == map.entries.end() ? nullptr : found->value;
  }

  static bool holds_numbers(const Type& type) {
    return type.kind == Type::Kind::scalar && type.scalar != Scalar::boolean && !type.is_sequence &&
           type.extent <= most_elements;
  }

  std::optional<double> number(const Entry* entry, const Type& type) {
    if (entry == nullptr) return std::nullopt;
    const Node* text = text_of(*entry->value, entry->span, entry->key, out_, limits_hint);
    if (text == nullptr) return std::nullopt;
    const auto quantity = split_quantity(text->text);
    if (!quantity) {
      out_.error("E205", text->span, entry->key + " must be a number, not " + in_quotes(text->text));
      return std::nullopt;
    }
    if (quantity->unit.empty() || quantity->unit == type.unit) return quantity->number;
    out_.error("E208", text->span,
               "unit " + in_quotes(quantity->unit) + " where the type is " + types_.spelled(type),
               entry->key == "per_second"
                   ? "per_second has the unit of the buffer: 50 means 50 of it a second"
                   : "units are compared as they are written");
    return std::nullopt;
  }

  void read_beyond(const Entry* entry, Limit& limit) {
    if (entry == nullptr) return;
    const Node* text = text_of(*entry->value, entry->span, "beyond", out_, "write clamp or fault");
    if (text == nullptr) return;
    limit.fault = text->text == "fault";
    if (limit.fault || text->text == "clamp") return;
    out_.error("E104", text->span, "beyond must be clamp or fault, not " + in_quotes(text->text),
               did_you_mean(text->text, {"clamp", "fault"}));
  }

  bool check(const Entry& entry, const Section& section, const Limit& limit) {
    const auto twice = std::find_if(limits_.begin(), limits_.end(), [&](const Limit& other) {
      return other.real == limit.real && other.field == limit.field;
    });
    if (twice != limits_.end())
      out_.error("E107", entry.span, in_quotes(entry.key) + " is limited twice",
                 "the first is on " + out_.words(twice->span.line));
    if (section.find("min") == nullptr && section.find("max") == nullptr &&
        section.find("per_second") == nullptr)
      out_.error("E103", entry.span, "a limit needs min, max, per_second or non_finite", limits_hint);
    if (limit.per_second && *limit.per_second <= 0)
      out_.error("E206", section.find("per_second")->value->span, "per_second must be positive");
    if (limit.minimum && limit.maximum && *limit.minimum > *limit.maximum) {
      out_.error("E211", entry.span, "min is above max");
      return false;
    }
    return true;
  }

  void check_safe(const Entry& entry, const Target& target, const Limit& limit) {
    if (target.safe != nullptr && target.safe->is_sequence()) {
      for (const Node* item : target.safe->items) check_safe_number(entry, item, limit);
    } else {
      check_safe_number(entry, target.safe, limit);
    }
  }

  void check_safe_number(const Entry& entry, const Node* safe, const Limit& limit) {
    double number = 0;
    if (safe != nullptr) {
      const auto quantity = safe->is_scalar() ? split_quantity(safe->text) : std::nullopt;
      if (!quantity) return;  // reported elsewhere
      number = quantity->number;
    }
    if (number >= limit.minimum.value_or(number) && number <= limit.maximum.value_or(number)) return;
    const std::string text = safe == nullptr ? "0, the default," : in_quotes(safe->text);
    out_.error("E211", safe == nullptr ? entry.span : safe->span,
               "the safe command " + text + " is outside the limits of " + in_quotes(entry.key),
               "a safe command within the limits stands under `safe`");
  }

  const Entry* safe_;
  const std::vector<Field>& real_;
  const Types& types_;
  Diagnostics& out_;
  std::vector<Limit> limits_;
  std::vector<NonFinite> non_finite_;
};

}  // namespace

void read_limits(const Entry* limits, const Entry* safe, const Types& types, Subsystem& subsystem,
                 Diagnostics& out) {
  if (limits != nullptr) LimitReader(safe, subsystem.real, types, out).read(*limits, subsystem);
}

}  // namespace tessera::spec
