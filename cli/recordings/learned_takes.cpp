#include "cli/recordings/learned_takes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "language/edits/edits.hpp"
#include "language/language.hpp"
#include "spec/model/chain_ways.hpp"
#include "tessera/printable.hpp"

namespace tessera::cli {
namespace {

using TakenTime = decltype(spec::Takes::shortest);

struct TimeUnit {
  std::int64_t ns;
  const char* name;
};

TimeUnit unit_of(std::int64_t ns) {
  for (const TimeUnit unit : {TimeUnit{1'000'000'000, "s"}, TimeUnit{1'000'000, "ms"}, TimeUnit{1'000, "us"}})
    if (ns >= unit.ns) return unit;
  return {1, "ns"};
}

/// Rounded to two digits.
std::int64_t rounded(std::int64_t ns, bool up) {
  std::int64_t step = 1;
  while (ns / step >= 100) step *= 10;
  return (up ? (ns + step - 1) / step : ns / step) * step;
}

std::string number_in(std::int64_t ns, const TimeUnit& unit) {
  std::string text = fmt::format("{:.9f}", static_cast<double>(ns) / static_cast<double>(unit.ns));
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text;
}

/// Exactly what the specification says, or was measured: "1.5..9 ms", "1.7 us..7 ms".
std::string range_text(std::int64_t shortest_ns, std::int64_t longest_ns) {
  const TimeUnit unit = unit_of(longest_ns);
  const std::string longest = number_in(longest_ns, unit) + " " + unit.name;
  if (shortest_ns == longest_ns) return longest;
  if (shortest_ns == 0 || shortest_ns * 10 >= unit.ns) return number_in(shortest_ns, unit) + ".." + longest;
  const TimeUnit own = unit_of(shortest_ns);
  return number_in(shortest_ns, own) + " " + own.name + ".." + longest;
}

/// To the path of the entry whose key stands at that byte.
bool find_entry(const language::Node& node, std::size_t begin, language::Path& path) {
  for (const language::Entry& entry : node.entries) {
    path.emplace_back(entry.key);
    if (entry.whole.begin == begin || entry.extent.begin == begin) return true;
    if (!entry.is_alias && entry.value != nullptr && find_entry(*entry.value, begin, path)) return true;
    path.pop_back();
  }
  for (std::size_t index = 0; index < node.items.size(); ++index) {
    const language::Entry& item = node.items[index];
    path.emplace_back(index);
    if (!item.is_alias && item.value != nullptr && find_entry(*item.value, begin, path)) return true;
    path.pop_back();
  }
  return false;
}

void propose(LearnedTakes& one, double margin) {
  if (one.measured.count == 0) return;
  const std::int64_t declared_least = one.declared.shortest.count(),
                     declared_most = one.declared.longest.count();
  const bool is_declared = one.declared.is_declared();
  one.proposed = one.declared;
  if (is_declared && declared_least <= one.measured.least_ns && one.measured.most_ns <= declared_most) return;
  auto least =
      static_cast<std::int64_t>(std::floor(static_cast<double>(one.measured.least_ns) * (1 - margin)));
  auto most = static_cast<std::int64_t>(std::ceil(static_cast<double>(one.measured.most_ns) * (1 + margin)));
  if (is_declared && declared_least <= one.measured.least_ns) least = declared_least;
  if (is_declared && one.measured.most_ns <= declared_most) most = declared_most;
  if (is_declared) least = std::min(least, declared_least);
  one.text = takes_text(least, most);
  one.proposed = {TakenTime{least}, TakenTime{most}};
}

std::string joined_names(const LearnedTakes& one) {
  std::string text = one.names.front();
  if (one.names.size() > 1) text += fmt::format(" (and {} more)", one.names.size() - 1);
  return text;
}

/// The proposals for the behaviours that stand in the file.
void write_takes(const diagnostics::Diagnostics& specification, const std::vector<LearnedTakes>& all,
                 TakesEdit::File& file, TakesEdit& result) {
  const language::Grammar grammar("{}");  // which keys are allowed is not asked
  const language::Document document(file.before, grammar, file.name.empty() ? specification.folder() : "");
  std::vector<language::Edit> edits;
  for (const LearnedTakes& one : all) {
    const diagnostics::SourceLine at = specification.sources().at(one.span.line);
    if (one.text.empty() || at.file != file.name) continue;
    language::Path path;
    if (!find_entry(document.outline().root(), document.lines().start_of(at.line - 1) + one.span.column - 1,
                    path)) {
      result.elsewhere.push_back(fmt::format("{}: takes: {} ({})", joined_names(one), one.text,
                                             specification.sources().words(one.span.line)));
      continue;
    }
    language::Edit& set = edits.emplace_back();
    set.kind = language::Edit::Kind::set;
    set.at = std::move(path);
    set.key = "takes";
    set.text = one.text;
    // A distribution stays; its bounds change.
    if (!one.declared.points.empty() || one.declared.measured) {
      set.at.emplace_back("takes");
      set.key = "within";
    }
  }
  if (edits.empty()) return;
  const language::Renaming done = language::edit(document, edits, {});
  if (!done.problem)
    file.after = language::edited(document, done.edits);
  else if (result.problem.empty())
    result.problem = *done.problem;
}

}  // namespace

std::string takes_text(std::int64_t& shortest_ns, std::int64_t& longest_ns) {
  longest_ns = rounded(std::max<std::int64_t>(longest_ns, 1), /*up=*/true);
  shortest_ns = std::min(rounded(shortest_ns, /*up=*/false), longest_ns);
  return range_text(shortest_ns, longest_ns);
}

std::vector<LearnedTakes> learned_takes(const spec::Model& model,
                                        const replay::DurationsOfBehaviours& measured, double margin) {
  std::vector<LearnedTakes> all;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> written;  // line and column
  for (const spec::InstanceId instance : model.instances.ids()) {
    const std::string path = model.instance_path(instance);
    for (const spec::Behaviour& behaviour : model.subsystem(instance).behaviours) {
      if (behaviour.is_group()) continue;
      const auto [at, is_new] = written.try_emplace({behaviour.span.line, behaviour.span.column}, all.size());
      if (is_new) all.push_back({{}, behaviour.span, behaviour.takes, {}});
      LearnedTakes& one = all[at->second];
      const std::string name = spec::fleet_name_of(path) + "." + behaviour.name;
      if (std::ranges::find(one.names, name) == one.names.end()) one.names.push_back(name);
      if (const auto found = measured.find({path, behaviour.name}); found != measured.end())
        one.measured = replay::joined(one.measured, found->second);
    }
  }
  for (LearnedTakes& one : all) propose(one, margin);
  return all;
}

TakesEdit with_takes(const diagnostics::Diagnostics& specification, const std::vector<LearnedTakes>& all) {
  TakesEdit result;
  result.files.push_back({{}, specification.text(), specification.text()});
  for (const std::string& name : specification.sources().included()) {
    const std::string& text = specification.included_text(result.files.size() - 1);
    result.files.push_back({name, text, text});
  }
  for (TakesEdit::File& file : result.files) write_takes(specification, all, file, result);
  return result;
}

std::string takes_table(const std::vector<LearnedTakes>& all) {
  std::string text, never;
  for (const LearnedTakes& one : all) {
    const replay::CallDurations& calls = one.measured;
    if (calls.count == 0) {
      never += (never.empty() ? "" : ", ") + joined_names(one);
      if (calls.failed > 0) never += fmt::format(" ({} calls, all of which failed)", calls.failed);
      continue;
    }
    std::int64_t least = calls.least_ns, most = calls.most_ns;
    text +=
        fmt::format("{}: {} {}, {} to {}", printable(joined_names(one)), calls.count,
                    calls.count == 1 ? "call" : "calls", range_text(least, least), range_text(most, most));
    if (!one.text.empty()) text += ": takes: " + one.text;
    if (one.declared.is_declared())
      text += fmt::format("{} takes: {}{}", one.text.empty() ? ": within" : " (now",
                          range_text(one.declared.shortest.count(), one.declared.longest.count()),
                          one.text.empty() ? "" : ")");
    text += "\n";
    if (calls.failed > 0) text += fmt::format("  {} calls that failed are left out\n", calls.failed);
    if (calls.count < LearnedTakes::few_calls)
      text += fmt::format("  fewer than {} calls: longer ones are likely to come\n", LearnedTakes::few_calls);
  }
  if (!never.empty()) text += "never called, so nothing is known: " + printable(never) + "\n";
  return text;
}

nlohmann::json takes_json(const std::vector<LearnedTakes>& all) {
  nlohmann::json list = nlohmann::json::array();
  for (const LearnedTakes& one : all) {
    nlohmann::json row{
        {"behaviours", one.names}, {"count", one.measured.count}, {"failed", one.measured.failed}};
    if (one.measured.count > 0)
      row.update({{"least_ns", one.measured.least_ns},
                  {"most_ns", one.measured.most_ns},
                  {"most_at_ns", one.measured.most_at_ns}});
    if (one.declared.is_declared())
      row["declared"] = {{"shortest_ns", one.declared.shortest.count()},
                         {"longest_ns", one.declared.longest.count()}};
    if (!one.text.empty())
      row["proposed"] = {{"shortest_ns", one.proposed.shortest.count()},
                         {"longest_ns", one.proposed.longest.count()},
                         {"text", one.text}};
    list.push_back(std::move(row));
  }
  return list;
}

}  // namespace tessera::cli
