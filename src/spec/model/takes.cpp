#include "spec/model/takes.hpp"

#include <algorithm>

#include "spec/model/model.hpp"

namespace tessera::spec {

std::vector<Resource> resources_of(const Model& model) {
  std::vector<Resource> all;
  for (const Definition& definition : model.definitions)
    for (const Subsystem& subsystem : definition.subsystems)
      for (const Behaviour& behaviour : subsystem.behaviours)
        for (const ResourceUse& use : behaviour.uses)
          if (std::ranges::find(all, use.resource, &Resource::name) == all.end())
            all.push_back({use.resource, use.unit});
  return all;
}

}  // namespace tessera::spec
