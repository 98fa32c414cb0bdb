#include <fmt/format.h>

#include <algorithm>

#include "language/language.hpp"
#include "language/questions/place.hpp"

namespace tessera::language {
namespace {

bool overlap(const Range& a, const Range& b) { return a.start <= b.end && b.start <= a.end; }

/// Offers for one document and range.
class Fixer {
 public:
  Fixer(const Document& document, Range range)
      : document_(document), index_(document.index()), range_(range) {}

  std::vector<Fix> fix(const std::vector<diagnostics::Diagnostic>& found) {
    for (const diagnostics::Diagnostic& one : found) {
      at_ = range_of(document_, one.span);
      if (one.span.line == 0 || !overlap(at_, range_)) continue;
      code_ = one.code;
      for_diagnostic(one);
    }
    at_ = range_;
    code_.clear();
    for_place();
    return std::move(fixes_);
  }

 private:
  void add(std::string title, Range range, std::string text) {
    Fix fix;
    fix.title = std::move(title);
    fix.code = code_;
    fix.at = at_;
    fix.edits.push_back({"", range, std::move(text), true});
    fixes_.push_back(std::move(fix));
  }

  void add_at(std::size_t offset, std::string title, std::string text) {
    add(std::move(title), document_.lines().range({offset, offset}), std::move(text));
  }

  void for_diagnostic(const diagnostics::Diagnostic& one) {
    if (one.proposal) add(fmt::format("Replace by '{}'", *one.proposal), at_, *one.proposal);
    const UnitNames* unit = unit_here(document_.lines().offset(at_.start));
    if (one.code == "W324" && unit != nullptr) {
      add_entry(unit->way, "stale", "500 ms", "Give the safe command after 500 ms without a new value");
      add_entry(unit->way, "stale", "never", "Keep the last command: stale: never");
    }
    if (one.code == "W313" && unit != nullptr) route_error(*unit);
    if (one.code == "W312" && unit != nullptr) last_entry(*unit);
    if (one.code == "N330") as_before(one.span);
  }

  /// The subsystem whose text contains a byte.
  const UnitNames* unit_here(std::size_t offset) const {
    for (const DefinitionNames& definition : index_.definitions())
      for (const UnitNames& unit : definition.units)
        if (index_[unit.symbol].whole.touches(offset)) return &unit;
    return nullptr;
  }

  const Symbol* behaviour_here(const UnitNames& unit, std::size_t offset) const {
    const Symbol* innermost = nullptr;
    for (const SymbolId id : unit.all_behaviours())
      if (index_[id].whole.touches(offset)) innermost = &index_[id];
    return innermost;
  }

  /// Adds `key: value` to the map at `way`, in the style in which it is written.
  void add_entry(const Way& way, const std::string& key, const std::string& value, std::string title) {
    const Node& map = node_at(document_.outline(), way);
    if (!map.is_map() || map.find(key) != nullptr) return;
    if (map.flow) {
      const std::string& text = document_.text();
      const bool empty = map.entries.empty();
      const std::size_t inside = map.extent.begin + 1;
      const bool space = inside < text.size() && text[inside] == ' ';
      add_at(inside, std::move(title),
             fmt::format(" {}: {}{}{}", key, value, empty ? "" : ",", empty && !space ? " " : ""));
    } else {
      add_at(map.extent.begin, std::move(title),
             fmt::format("{}: {}\n{}", key, value, std::string(map.column, ' ')));
    }
  }

  /// An error that no entry of `next` asks for: the behaviour begins again.
  void route_error(const UnitNames& unit) {
    const Symbol* behaviour = behaviour_here(unit, document_.lines().offset(at_.start));
    if (behaviour == nullptr) return;
    const Node& body = node_at(document_.outline(), behaviour->way);
    const std::string name = behaviour->fleet.empty() ? behaviour->name : '"' + behaviour->name + "[i]\"";
    const std::string entry = fmt::format("{{ to: {}, when: error }}", name);
    const std::string title = fmt::format("After an error, run '{}' again", behaviour->name);
    const Node& next = body["next"];
    if (body.find("next") == nullptr)
      return add_entry(behaviour->way, "next", fmt::format("[{}, end]", entry), title);
    if (next.is_sequence() && next.flow) {
      add_at(next.extent.begin + 1, title, entry + (next.items.empty() ? "" : ", "));
    } else if (next.is_sequence()) {
      add_at(next.extent.begin, title, fmt::format("- {}\n{}", entry, std::string(next.column, ' ')));
    } else if (next.is_scalar() || next.flow) {
      const Range whole = document_.lines().range(next.extent);
      const std::string text =
          document_.text().substr(next.extent.begin, next.extent.end - next.extent.begin);
      add(title, whole, fmt::format("[{}, {}]", entry, text));
    }
  }

  /// Failures lead where they have led in earlier versions.
  void as_before(const diagnostics::Span& span) {
    const std::optional<Migration> migration = migrate(document_, span);
    if (!migration || migration->steps.empty()) return;
    Fix fix{.title = "Go on after a failure, too", .edits = {}, .code = code_, .at = at_};
    for (const Migration::Step& step : migration->steps) fix.edits.push_back(step.edit);
    fixes_.push_back(std::move(fix));
  }

  /// `next` may have no entry to take: one without a condition goes last.
  void last_entry(const UnitNames& unit) {
    const Symbol* behaviour = behaviour_here(unit, document_.lines().offset(at_.start));
    if (behaviour == nullptr) return;
    const Node& next = node_at(document_.outline(), behaviour->way)["next"];
    if (!next.is_sequence() || next.items.empty()) return;
    const std::size_t end = next.items.back().value->extent.end;
    add_at(end, "Add a last entry without a condition: end",
           next.flow ? ", end" : fmt::format("\n{}- end", std::string(next.column, ' ')));
  }

  /// Offers that need no diagnostic.
  void for_place() {
    const std::size_t offset = document_.lines().offset(range_.start);
    if (const UnitNames* unit = unit_here(offset); unit != nullptr && unit->role == SubsystemRole::effector &&
                                                   index_[unit->symbol].definition.touches(offset))
      write_safe(*unit);
    for (const Entry& item : document_.outline().root()["channels"].items) {
      const Node* channel = item.value;
      const bool waits = (*channel)["send"].text == "blocking" || (*channel)["receive"].text == "blocking";
      const bool limited = channel->find("timeout") != nullptr || channel->find("send_timeout") != nullptr ||
                           channel->find("receive_timeout") != nullptr;
      if (!channel->is_map() || !channel->extent.touches(offset) || !waits || limited || !channel->flow)
        continue;
      const std::size_t last = channel->entries.back().value->extent.end;
      add_at(last, "Wait for at most 200 ms: timeout", ", timeout: 200 ms");
    }
  }

  void write_safe(const UnitNames& unit) {
    std::string values;
    for (const auto& [name, id] : unit.real) {
      const std::string& type = index_[id].type;
      const bool number = type.find('[') == std::string::npos && index_.fields_of(type) == nullptr;
      if (number)
        values += fmt::format("{}{}: {}", values.empty() ? "" : ", ", name,
                              type.starts_with("bool")     ? "false"
                              : type.starts_with("string") ? "\"\""
                                                           : "0");
    }
    if (!values.empty()) add_entry(unit.way, "safe", "{ " + values + " }", "Write the safe command");
  }

  const Document& document_;
  const Index& index_;
  Range range_;
  Range at_;
  std::string code_;
  std::vector<Fix> fixes_;
};

}  // namespace

std::vector<Fix> fixes(const Document& document, Range range,
                       const std::vector<diagnostics::Diagnostic>& found) {
  return Fixer(document, range).fix(found);
}

}  // namespace tessera::language
