#include "codegen/codegen.hpp"

#include <utility>

#include "codegen/conditions.hpp"
#include "codegen/cpp_text.hpp"
#include "codegen/driver_tables.hpp"
#include "codegen/emit.hpp"
#include "codegen/local_net.hpp"
#include "codegen/project.hpp"

namespace tessera::codegen {

std::vector<File> generate(const verify::VerifiedNet& net, const spec::Model& model,
                           const std::string& spec_path, Lines lines) {
  Project project{model,           net, spec_path, lines, spec_path.substr(spec_path.rfind('/') + 1),
                  units_of(model), {}};
  LocalNets nets = take_apart(net, model, project.units);
  project.nets = std::move(nets.of_unit);

  std::vector<File> files{format_style(), types_header(project), subsystems_header(project)};
  for (std::size_t unit = 0; unit < project.units.size(); ++unit) {
    const Conditions conditions(project, project.units[unit]);
    for (File& header : subsystem_headers(project, project.units[unit])) files.push_back(std::move(header));
    files.push_back(subsystem_source(project, project.units[unit], project.nets[unit], conditions));
    if (!conditions.empty()) {
      files.push_back(conditions.header());
      files.push_back(conditions.source());
    }
  }
  files.push_back(system_header(project));
  const DriverTables drivers = driver_tables(project);
  files.push_back(system_source(project, nets.of_channel, drivers));
  if (!drivers.empty()) {
    files.push_back(drivers_source(project, drivers));
    files.push_back(driver_lines_source(project, drivers));
  }
  files.push_back(testing_header(project));
  files.push_back(main_source(project));
  files.push_back(cmake_lists(project, files));
  for (File& file : files)
    if (file.path.ends_with("pp")) file.text = keep_formatter_off_long_lines(std::move(file.text));
  return files;
}

}  // namespace tessera::codegen
