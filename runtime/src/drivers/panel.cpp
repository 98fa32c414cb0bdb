#include "drivers/panel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "system/waker.hpp"
#include "tessera/nearest.hpp"
#include "tessera/panel.hpp"
#include "tessera/value_text.hpp"

namespace tessera {
namespace {

/// The field of a real buffer that is no structure.
constexpr std::string_view only_field = "value";
constexpr std::size_t longest_operator = 64;

/// Bytes of an encoded scalar; texts are empty.
std::size_t encoded_size(std::string_view type) {
  if (type == "bool") return 1;
  if (type.starts_with("string")) return sizeof(std::uint32_t);
  const std::size_t digits = type.find_first_of("0123456789");
  std::size_t number = 0;
  if (digits != std::string_view::npos)
    std::from_chars(type.data() + digits, type.data() + type.size(), number);
  return type.starts_with("bytes") ? number : number / 8;
}

template <class Number>
void put_number(double value, std::byte* at) {
  const auto number = static_cast<Number>(value);
  std::memcpy(at, &number, sizeof number);
}

template <class Number>
std::string shown_number(const std::byte* at) {
  Number number{};
  std::memcpy(&number, at, sizeof number);
  return fmt::format("{}", number);
}

struct NumberKind {
  std::string_view name;
  void (*put)(double, std::byte*);
  std::string (*text)(const std::byte*);
};

template <class Number>
constexpr NumberKind number_kind(std::string_view name) {
  return {name, put_number<Number>, shown_number<Number>};
}

/// nullptr: it is no number.
const NumberKind* kind_of(std::string_view type) {
  static constexpr std::array kinds = {
      number_kind<std::int8_t>("int8"),     number_kind<std::int16_t>("int16"),
      number_kind<std::int32_t>("int32"),   number_kind<std::int64_t>("int64"),
      number_kind<std::uint8_t>("uint8"),   number_kind<std::uint16_t>("uint16"),
      number_kind<std::uint32_t>("uint32"), number_kind<std::uint64_t>("uint64"),
      number_kind<float>("float32"),        number_kind<double>("float64")};
  const auto found = std::ranges::find(kinds, type, &NumberKind::name);
  return found == kinds.end() ? nullptr : &*found;
}

void put_number(const std::string& type, double value, std::byte* at) {
  if (const NumberKind* const kind = kind_of(type)) kind->put(value, at);
}

/// "forward -0.5 0.5 m/s; horn": the fields that have controls, with the ranges and units of numbers.
std::vector<Panel::Control> controls_of(const std::string& text, const ValueLayout& layout,
                                        std::size_t& size) {
  const std::vector<std::string> paths = layout.paths(), types = layout.types();
  const std::vector<std::string> sequences = layout.sequences();  // which a panel leaves empty
  std::optional<std::string> in_sequence;
  std::map<std::string, Panel::Control, std::less<>> all;
  size = 0;
  for (std::size_t index = 0; index < paths.size(); ++index) {
    const auto around = std::ranges::find_if(
        sequences, [&](const std::string& sequence) { return paths[index].starts_with(sequence + '['); });
    if (around != sequences.end()) {
      if (in_sequence != *around) size += sizeof(std::uint32_t);
      in_sequence = *around;
      continue;
    }
    const std::string field = paths[index].empty() ? std::string(only_field) : paths[index];
    all[field] = {.field = field, .type = types[index], .offset = size};
    size += encoded_size(types[index]);
  }
  std::vector<Panel::Control> controls;
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view one = rest.substr(0, rest.find("; "));
    rest.remove_prefix(std::min(rest.size(), one.size() + 2));
    const std::size_t blank = one.find(' ');
    const auto found = all.find(one.substr(0, blank));
    if (found == all.end())
      throw DriverError(fmt::format("the real buffer has no field '{}'", one.substr(0, blank)));
    Panel::Control control = found->second;
    if (blank != std::string_view::npos) {
      const char* const end = one.data() + one.size();
      const auto first = std::from_chars(one.data() + blank + 1, end, control.minimum);
      auto second = first;
      if (first.ptr != end) second = std::from_chars(first.ptr + 1, end, control.maximum);
      if (second.ptr != end) control.unit.assign(second.ptr + 1, end);
    }
    controls.push_back(std::move(control));
  }
  return controls;
}

/// "3000000000 pause true; 5000000000 speed 0.5": nanoseconds, field and value.
std::vector<Panel::Step> steps_of(const std::string& text) {
  std::vector<Panel::Step> steps;
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view one = rest.substr(0, rest.find("; "));
    rest.remove_prefix(std::min(rest.size(), one.size() + 2));
    const std::size_t first = one.find(' '), last = one.rfind(' ');
    std::int64_t at = 0;
    if (first == last || std::from_chars(one.data(), one.data() + first, at).ptr != one.data() + first)
      throw DriverError("the script is not readable");
    Panel::Step step{Time(Duration(at)), std::string(one.substr(first + 1, last - first - 1)), false};
    const std::string_view value = one.substr(last + 1);
    double number = 0;
    if (std::from_chars(value.data(), value.data() + value.size(), number).ec == std::errc())
      step.value = number;
    else
      step.value = value == "true";
    steps.push_back(std::move(step));
  }
  return steps;
}

}  // namespace

// -------------------------------------------------------------------------------------------- one panel

Panel::Panel(std::string path, std::vector<Control> controls, std::size_t size, Duration stale,
             std::vector<Step> script)
    : path_(std::move(path)),
      controls_(std::move(controls)),
      stale_(stale),
      script_(std::move(script)),
      neutral_(size) {
  for (const Control& one : controls_)
    if (one.type != "bool")
      put_number(one.type, std::clamp(0.0, one.minimum, one.maximum), neutral_.data() + one.offset);
  input_.bytes = neutral_;
  std::vector<std::byte> scratch = neutral_;
  for (const Step& one : script_)
    if (const std::optional<Problem> wrong = put(one.field, one.value, scratch))
      throw DriverError("the script: " + wrong->text);
}

void Panel::play(Time now) {
  const std::lock_guard lock(mutex_);
  for (; played_ < script_.size() && script_[played_].at <= now; ++played_) {
    static_cast<void>(put(script_[played_].field, script_[played_].value, input_.bytes));
    input_.given_ns = 0;
  }
}

std::optional<Problem> Panel::put(const std::string& field, const command::Panel::Value& value,
                                  std::vector<std::byte>& bytes) const {
  const auto found = std::ranges::find(controls_, field, &Control::field);
  if (found == controls_.end()) {
    std::vector<std::string> fields;
    for (const Control& one : controls_) fields.push_back(one.field);
    return Problem{with_hint(
        fmt::format("the panel {} has no control '{}'; it has {}", path_, field, fmt::join(fields, ", ")),
        did_you_mean(field, fields))};
  }
  std::byte* const at = bytes.data() + found->offset;
  if (found->type == "bool") {
    const bool* const flag = std::get_if<bool>(&value);
    if (flag == nullptr) return Problem{fmt::format("'{}' of the panel {} is true or false", field, path_)};
    *at = static_cast<std::byte>(*flag ? 1 : 0);
    return std::nullopt;
  }
  const double* const number = std::get_if<double>(&value);
  if (number == nullptr) return Problem{fmt::format("'{}' of the panel {} is a number", field, path_)};
  if (!std::isfinite(*number))
    return Problem{fmt::format("'{}' of the panel {} is not finite", field, path_)};
  if (!found->type.starts_with("float") && *number != std::floor(*number))
    return Problem{fmt::format("'{}' of the panel {} is a whole number, not {}", field, path_, *number)};
  if (*number < found->minimum || *number > found->maximum)
    return Problem{fmt::format("'{}' of the panel {} goes from {} to {}, and {} is out of this range", field,
                               path_, found->minimum, found->maximum, *number)};
  put_number(found->type, *number, at);
  return std::nullopt;
}

Offered::Panel Panel::offered(std::int64_t now_ns) const {
  const std::lock_guard lock(mutex_);
  Offered::Panel all{path_, std::chrono::duration<double>(stale_).count(), counts(input_, now_ns), {}};
  const std::vector<std::byte>& bytes = all.operated ? input_.bytes : neutral_;
  for (const Control& one : controls_) {
    const std::byte* const at = bytes.data() + one.offset;
    if (const NumberKind* const kind = kind_of(one.type))
      all.controls.push_back({one.field, kind->text(at), one.unit, one.minimum, one.maximum});
    else
      all.controls.push_back({one.field, *at == std::byte{0} ? "false" : "true", {}, {}, {}});
  }
  return all;
}

std::optional<Problem> Panel::feed(const command::Panel& input, std::int64_t now_ns) {
  if (!script_.empty()) return Problem{fmt::format("the script of the simulation has the panel {}", path_)};
  if (input.who.size() > longest_operator) return Problem{"the name of the operator is too long"};
  std::vector<std::byte> bytes = neutral_;
  if (input.values)
    for (const auto& [field, value] : *input.values)
      if (std::optional<Problem> wrong = put(field, value, bytes)) return wrong;
  const std::lock_guard lock(mutex_);
  const bool is_other = input.who != who_;
  if (!input.values) {  // only the operator who holds it can let go
    if (!is_other) input_.given_ns.reset();
    return std::nullopt;
  }
  if (is_other && counts(input_, now_ns))
    return Problem{fmt::format("another operator has the panel {}", path_)};
  who_ = input.who;
  input_.bytes.swap(bytes);
  input_.given_ns = now_ns;
  return std::nullopt;
}

void Panel::latest(Input& input) {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock.owns_lock()) return;
  input.bytes.assign(input_.bytes.begin(), input_.bytes.end());
  input.given_ns = input_.given_ns;
}

// -------------------------------------------------------------------------------------------- its driver

PanelReceptor::PanelReceptor(std::shared_ptr<Panel> panel, const ValueEncoding* encoding, Now now)
    : panel_(std::move(panel)), encoding_(encoding), now_(now) {
  input_.bytes = panel_->neutral();
}

bool PanelReceptor::read(std::span<std::byte> value) {
  if (clock_ != nullptr) panel_->play(clock_->now());
  panel_->latest(input_);
  const bool operated = panel_->counts(input_, now_());
  if (!operated && !std::exchange(operated_, false)) return false;
  operated_ = operated;
  return encoding_->take(value.data(), operated ? input_.bytes : panel_->neutral());
}

std::unique_ptr<RealReceptor> make_panel(const DriverSetup& setup, const ValueEncoding* encoding) {
  const std::string controls = setup.text("controls");
  const Duration stale = setup.duration("stale");
  std::vector<Panel::Step> script = steps_of(setup.text_or("script", ""));
  refuse_unknown_options(setup, true);
  const auto layout = encoding == nullptr ? std::nullopt : ValueLayout::parse(encoding->type());
  if (!layout) throw DriverError("the values of the real buffer have no fixed size");
  std::size_t size = 0;
  std::vector<Panel::Control> all = controls_of(controls, *layout, size);
  auto panel = std::make_shared<Panel>(setup.path(), std::move(all), size, stale, std::move(script));
  return std::make_unique<PanelReceptor>(std::move(panel), encoding, monotonic_ns);
}

// -------------------------------------------------------------------------------------------- all panels

void Panels::add(std::shared_ptr<Panel> panel) {
  const std::lock_guard lock(mutex_);
  std::string path = panel->path();
  panels_.insert_or_assign(std::move(path), std::move(panel));
}

std::vector<std::string> Panels::paths() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> all;
  for (const auto& [path, panel] : panels_) all.push_back(path);
  return all;
}

bool Panels::knows(const std::string& path) const {
  const std::lock_guard lock(mutex_);
  return panels_.contains(path);
}

std::vector<Offered::Panel> Panels::offered() const {
  const std::lock_guard lock(mutex_);
  std::vector<Offered::Panel> all;
  for (const auto& [path, panel] : panels_) all.push_back(panel->offered(monotonic_ns()));
  return all;
}

std::optional<Problem> Panels::feed(const command::Panel& input) const {
  std::shared_ptr<Panel> panel;
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = panels_.find(input.path); found != panels_.end()) panel = found->second;
  }
  if (panel != nullptr) return panel->feed(input, monotonic_ns());
  const std::vector<std::string> all = paths();
  return Problem{with_hint("there is no panel '" + input.path + "'", did_you_mean(input.path, all))};
}

}  // namespace tessera
