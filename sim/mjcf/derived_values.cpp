#include <algorithm>
#include <array>
#include <string_view>

#include "sim/mjcf/preparation.hpp"
#include "sim/mjcf/xml.hpp"

namespace tessera::sim {
namespace {

const char* truth(bool value) { return value ? "true" : "false"; }

int id_of(const mjModel& model, mjtObj type, pugi::xml_node element) {
  return mj_name2id(&model, type, element.attribute("name").value());
}

void write_joint(pugi::xml_node joint, const mjModel& alone) {
  const int id = id_of(alone, mjOBJ_JOINT, joint);
  if (id < 0) return;
  const int type = alone.jnt_type[id], at = alone.jnt_qposadr[id];
  if (type == mjJNT_HINGE || type == mjJNT_SLIDE) {
    set_attribute(joint, "ref", numbers_text(alone.qpos0 + at, 1));
    set_attribute(joint, "springref", numbers_text(alone.qpos_spring + at, 1));
  }
  if (type != mjJNT_FREE) set_attribute(joint, "range", numbers_text(alone.jnt_range + 2 * id, 2));
  set_attribute(joint, "limited", truth(alone.jnt_limited[id] != 0));
}

void remove_orientation(pugi::xml_node element) {
  for (const char* attribute : {"euler", "axisangle", "xyaxes", "zaxis", "fullinertia"})
    element.remove_attribute(attribute);
}

/// Many settings change masses, so the masses are written out; the engine prefers written ones to derived
/// ones.
void write_inertia(pugi::xml_node body, const mjModel& alone) {
  const int id = id_of(alone, mjOBJ_BODY, body);
  if (id < 0) return;
  pugi::xml_node inertial = body.child("inertial");
  if (!inertial) inertial = body.prepend_child("inertial");
  remove_orientation(inertial);
  set_attribute(inertial, "pos", numbers_text(alone.body_ipos + 3 * id, 3));
  set_attribute(inertial, "quat", numbers_text(alone.body_iquat + 4 * id, 4));
  set_attribute(inertial, "mass", numbers_text(alone.body_mass + id, 1));
  set_attribute(inertial, "diaginertia", numbers_text(alone.body_inertia + 3 * id, 3));
}

/// A box or a capsule that was fitted to a mesh (in one of two ways, `fitaabb`) is written with its final
/// shape.
void write_fitted_geom(pugi::xml_node geom, const mjModel& alone, int id) {
  if (!geom.attribute("mesh") || alone.geom_type[id] == mjGEOM_MESH) return;
  for (const char* attribute : {"mesh", "fitscale", "fromto"}) geom.remove_attribute(attribute);
  remove_orientation(geom);
  set_attribute(geom, "size", numbers_text(alone.geom_size + 3 * id, 3));
  set_attribute(geom, "pos", numbers_text(alone.geom_pos + 3 * id, 3));
  set_attribute(geom, "quat", numbers_text(alone.geom_quat + 4 * id, 4));
}

/// `discardvisual` makes the engine drop geoms while it reads; they are removed from the document as well.
void write_geoms(pugi::xml_node body, const mjModel& alone) {
  for (pugi::xml_node geom = body.child("geom"); geom;) {
    const pugi::xml_node next = geom.next_sibling("geom");
    const int id = id_of(alone, mjOBJ_GEOM, geom);
    if (id < 0) {
      body.remove_child(geom);
    } else {
      write_fitted_geom(geom, alone, id);
    }
    geom = next;
  }
}

/// Joints of a rope or a cloth turn; those of the other composites slide.
void write_composite(pugi::xml_node composite, const CompilerSettings& settings) {
  const std::string_view type = composite.attribute("type").value();
  const bool turns = type == "rope" || type == "loop" || type == "cloth";
  for (pugi::xml_node part : composite.children()) {
    if (!part.attribute("range")) continue;
    const bool slides = std::string_view(part.attribute("kind").value()) == "stretch";
    if (std::string_view(part.name()) != "joint" || !settings.angles_in_degrees || !turns || slides) continue;
    std::vector<double> range = numbers_in(part.attribute("range").value());
    for (double& angle : range) angle = angle / 180.0 * mjPI;
    set_attribute(part, "range", numbers_text(range));
  }
}

void write_bodies(pugi::xml_node body, const CompilerSettings& settings, const mjModel& alone) {
  if (std::string_view(body.name()) == "body") write_inertia(body, alone);
  write_geoms(body, alone);
  for (const pugi::xml_node joint : body.children("joint")) write_joint(joint, alone);
  for (const pugi::xml_node composite : body.children("composite")) write_composite(composite, settings);
  for (const pugi::xml_node child : body.children("body")) write_bodies(child, settings, alone);
}

void write_actuator(pugi::xml_node actuator, const mjModel& alone) {
  const int id = id_of(alone, mjOBJ_ACTUATOR, actuator);
  if (id < 0) return;
  const std::string_view kind = actuator.name();
  if (kind != "adhesion" && kind != "damper")
    set_attribute(actuator, "ctrllimited", truth(alone.actuator_ctrllimited[id] != 0));
  set_attribute(actuator, "forcelimited", truth(alone.actuator_forcelimited[id] != 0));
  if (kind == "general") set_attribute(actuator, "actlimited", truth(alone.actuator_actlimited[id] != 0));
  // Without a written range, the engine finds the range of a muscle by moving the whole world.
  const mjtNum* range = alone.actuator_lengthrange + 2 * id;
  if (range[0] < range[1]) set_attribute(actuator, "lengthrange", numbers_text(range, 2));
}

void write_bone(const mjModel& alone, int skin, int bone_of_skin, pugi::xml_node element) {
  const int bone = alone.skin_boneadr[skin] + bone_of_skin;
  const auto count = static_cast<std::size_t>(alone.skin_bonevertnum[bone]);
  pugi::xml_node written = element.append_child("bone");
  set_attribute(written, "body", mj_id2name(&alone, mjOBJ_BODY, alone.skin_bonebodyid[bone]));
  set_attribute(written, "bindpos", numbers_text(alone.skin_bonebindpos + 3 * bone, 3));
  set_attribute(written, "bindquat", numbers_text(alone.skin_bonebindquat + 4 * bone, 4));
  set_attribute(written, "vertid", numbers_text(alone.skin_bonevertid + alone.skin_bonevertadr[bone], count));
  set_attribute(written, "vertweight",
                numbers_text(alone.skin_bonevertweight + alone.skin_bonevertadr[bone], count));
}

/// The file of a skin contains names of bodies, which change; so its content is written out.
void write_skin(pugi::xml_node skin, const mjModel& alone) {
  const int id = id_of(alone, mjOBJ_SKIN, skin);
  if (id < 0 || !skin.attribute("file")) return;
  skin.remove_attribute("file");
  const auto vertices = static_cast<std::size_t>(alone.skin_vertnum[id]);
  const auto faces = static_cast<std::size_t>(alone.skin_facenum[id]);
  set_attribute(skin, "vertex", numbers_text(alone.skin_vert + 3 * alone.skin_vertadr[id], 3 * vertices));
  set_attribute(skin, "face", numbers_text(alone.skin_face + 3 * alone.skin_faceadr[id], 3 * faces));
  if (alone.skin_texcoordadr[id] >= 0)
    set_attribute(skin, "texcoord",
                  numbers_text(alone.skin_texcoord + 2 * alone.skin_texcoordadr[id], 2 * vertices));
  for (int bone = 0; bone < alone.skin_bonenum[id]; ++bone) write_bone(alone, id, bone, skin);
}

}  // namespace

void write_derived_values(pugi::xml_node root, const CompilerSettings& settings, const mjModel& alone) {
  for (const pugi::xml_node world : root.children("worldbody")) write_bodies(world, settings, alone);
  for (const pugi::xml_node section : root.children("actuator")) {
    for (const pugi::xml_node actuator : section.children()) write_actuator(actuator, alone);
  }
  for (const pugi::xml_node section : root.children("tendon")) {
    for (const pugi::xml_node tendon : section.children()) {
      const int id = id_of(alone, mjOBJ_TENDON, tendon);
      if (id >= 0) set_attribute(tendon, "limited", truth(alone.tendon_limited[id] != 0));
    }
  }
  for (const pugi::xml_node section : root.children("asset")) {
    for (const pugi::xml_node skin : section.children("skin")) write_skin(skin, alone);
  }
}

}  // namespace tessera::sim
