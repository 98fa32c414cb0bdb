#include "codegen/codegen.hpp"

#include <utility>

#include "codegen/cpp_text.hpp"
#include "codegen/emit.hpp"
#include "codegen/local_net.hpp"
#include "codegen/project.hpp"

namespace tessera::codegen {

std::vector<File> generate(const verify::VerifiedNet& net, const spec::Model& model,
                           const std::string& spec_path) {
  Project project{model, net, spec_path, spec_path.substr(spec_path.rfind('/') + 1), units_of(model), {}};
  LocalNets nets = take_apart(net, model, project.units);
  project.nets = std::move(nets.of_unit);

  std::vector<File> files{format_style(), cmake_lists(project), types_header(project),
                          subsystems_header(project)};
  for (std::size_t unit = 0; unit < project.units.size(); ++unit) {
    files.push_back(subsystem_header(project, project.units[unit]));
    files.push_back(subsystem_source(project, project.units[unit], project.nets[unit]));
  }
  files.push_back(system_header(project));
  files.push_back(system_source(project, nets.of_channel));
  files.push_back(testing_header(project));
  files.push_back(main_source(project));
  for (File& file : files)
    if (file.path.ends_with("pp")) file.text = keep_formatter_off_long_lines(std::move(file.text));
  return files;
}

}  // namespace tessera::codegen
