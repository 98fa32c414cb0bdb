#include <algorithm>

#include "sim/devices/reading.hpp"
#include "sim/engine/shapes.hpp"

namespace tessera::sim {
namespace {

/// One side of a contact: for each geom whether it counts.
using Geoms = std::vector<bool>;

void add_body(const mjModel& model, int body, Geoms& geoms) {
  for (int geom = 0; geom < model.ngeom; ++geom)
    if (is_part_of(model, model.geom_bodyid[geom], body)) geoms[static_cast<std::size_t>(geom)] = true;
}

/// The geoms of these bodies with everything attached to them, or these geoms; without names, every geom.
Geoms geoms_named(const Physics& physics, const DriverRequest& request,
                  const std::vector<std::string>& names) {
  const mjModel& model = physics.model();
  const std::string agent = request.agent();
  Geoms geoms(static_cast<std::size_t>(model.ngeom), names.empty());
  for (const std::string& name : names) {
    if (const auto body = find_element(model, mjOBJ_BODY, agent, name)) {
      add_body(model, *body, geoms);
    } else if (const auto geom = find_element(model, mjOBJ_GEOM, agent, name)) {
      geoms[static_cast<std::size_t>(*geom)] = true;
    } else {
      std::vector<std::string> known = names_for(model, mjOBJ_BODY, agent);
      for (std::string& one : names_for(model, mjOBJ_GEOM, agent)) known.push_back(std::move(one));
      DriverProblem problem = unknown_name("body or geom", name, known);
      problem.subject = "with";
      throw DeviceError(std::move(problem));
    }
  }
  return geoms;
}

struct Bumper {
  FrameTarget frame;
  Geoms own, others;
};

bool touches(const Physics& physics, const Bumper& bumper) {
  const mjData& now = physics.state();
  for (int index = 0; index < now.ncon; ++index) {
    const mjContact& contact = now.contact[index];
    if (contact.dist > 0) continue;
    const auto a = static_cast<std::size_t>(contact.geom1), b = static_cast<std::size_t>(contact.geom2);
    const auto meets = [&](std::size_t mine, std::size_t other) {
      return bumper.own[mine] && !bumper.own[other] && bumper.others[other];
    };
    if (!meets(a, b) && !meets(b, a)) continue;
    if (bumper.frame.type == mjOBJ_BODY || is_inside_site(physics.model(), now, bumper.frame.id, contact.pos))
      return true;
  }
  return false;
}

}  // namespace

std::unique_ptr<RealReceptor> contact(const DeviceContext& context, const DriverRequest& request) {
  Buffer buffer(request);
  buffer.require_flag("a contact is");
  Options options(request);
  const std::vector<std::string> with = options.names("with");
  options.refuse_others();
  Bumper bumper;
  context.simulation->use([&](const Physics& physics) {
    const mjModel& model = physics.model();
    bumper.frame = frame_target(physics, request, only_target(request));
    bumper.own.resize(static_cast<std::size_t>(model.ngeom));
    add_body(model, bumper.frame.type == mjOBJ_BODY ? bumper.frame.id : model.site_bodyid[bumper.frame.id],
             bumper.own);
    bumper.others = geoms_named(physics, request, with);
  });
  return reading(context.simulation, std::move(buffer),
                 [bumper = std::move(bumper)](const Physics& physics, std::span<double> numbers) {
                   numbers[0] = touches(physics, bumper) ? 1 : 0;
                 });
}

}  // namespace tessera::sim
