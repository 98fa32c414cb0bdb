#include "server/runs/sweep_results.hpp"

#include <algorithm>

#include "project/files/files.hpp"
#include "server/http/json_text.hpp"

namespace tessera::server {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

std::optional<double> number_of(const json& from, const char* name) {
  const auto found = from.find(name);
  return found != from.end() && found->is_number() ? std::optional(found->get<double>()) : std::nullopt;
}

}  // namespace

json SweepRow::shown() const {
  json row{
      {"value", value}, {"seed", seed}, {"failed", failed}, {"ended", ended}, {"numbers", json::object()},
      {"units", units}};
  for (const auto& [name, number] : numbers) row["numbers"][name] = number ? json(*number) : json(nullptr);
  return row;
}

std::optional<SweepRow> SweepRow::read(const json& row) {
  try {
    SweepRow read{row.at("value"), row.at("seed"), row.at("failed"), row.at("ended"), {}, {}};
    for (const auto& [name, number] : row.at("numbers").items())
      read.numbers[name] = number.is_null() ? std::nullopt : std::optional(number.get<double>());
    read.units = row.at("units").get<std::map<std::string, std::string>>();
    return read;
  } catch (const json::exception&) {
    return std::nullopt;
  }
}

SweepRow SweepRow::of_summary(const json& summary) {
  SweepRow row;
  row.failed = summary.value("failed", false);
  row.ended = summary.value("ended", "");
  const json measures = summary.value("measures", json::object());
  for (const auto& [name, measure] : measures.items()) {
    for (const char* part : {"mean", "least", "greatest", "last"}) {
      const std::string whole = name + ", " + part;
      row.numbers[whole] = measure.is_object() ? number_of(measure, part) : std::nullopt;
      if (measure.is_object() && measure.contains("unit")) row.units[whole] = measure.value("unit", "");
    }
  }
  const json checks = summary.value("checks", json::array());
  for (const json& check : checks) {
    // A check that waits for something was decided when it came.
    const std::string name = "time of: " + check.value("name", "");
    row.numbers[name] = check.value("verdict", "") == "open" ? std::nullopt : number_of(check, "time_s");
    row.units[name] = "s";
  }
  double overruns = 0, errors = 0;
  const json subsystems = summary.value("subsystems", json::array());
  for (const json& subsystem : subsystems) {
    overruns += number_of(subsystem, "overruns").value_or(0);
    errors += number_of(subsystem, "errors").value_or(0);
  }
  row.numbers["overruns"] = overruns;
  row.numbers["errors"] = errors;
  row.numbers["firings"] = number_of(summary, "firings");
  row.numbers["simulated time"] = number_of(summary, "simulated_s");
  row.units["simulated time"] = "s";
  row.numbers["failed"] = row.failed ? 1 : 0;
  return row;
}

SweepFile::SweepFile(fs::path file) : file_(std::move(file)) {
  std::error_code ignored;
  // Another program may have put a link there.
  if (fs::symlink_status(file_, ignored).type() != fs::file_type::regular) return;
  const std::string text = project::content_of(file_);
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = text.find('\n', start);
    if (end == std::string::npos) break;
    const json row = json::parse(text.substr(start, end - start), nullptr, /*allow_exceptions=*/false);
    if (std::optional<SweepRow> read = SweepRow::read(row))
      rows_.insert_or_assign({read->value, read->seed}, std::move(*read));
    start = end + 1;
  }
}

const SweepRow* SweepFile::find(const std::string& value, std::uint64_t seed) const {
  const auto found = rows_.find({value, seed});
  return found == rows_.end() ? nullptr : &found->second;
}

bool SweepFile::add(SweepRow row) {
  if (!out_.is_open()) {
    std::error_code ignored;
    fs::create_directories(file_.parent_path(), ignored);
    const fs::file_type type = fs::symlink_status(file_, ignored).type();
    if (type == fs::file_type::regular || type == fs::file_type::not_found)
      out_.open(file_, std::ios::app | std::ios::binary);
    // An interrupted write may have left a line without its end.
    out_ << '\n';
  }
  out_ << text_of(row.shown()) << '\n' << std::flush;
  rows_.insert_or_assign({row.value, row.seed}, std::move(row));
  return out_.good();
}

}  // namespace tessera::server
