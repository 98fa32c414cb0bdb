#include "sim/compose/composer.hpp"

#include <array>
#include <sstream>
#include <string_view>
#include <utility>

#include "sim/compose/default_classes.hpp"
#include "sim/mjcf/xml.hpp"

namespace tessera::sim {
namespace {

constexpr std::array<const char*, 6> sections{"custom", "contact",  "equality",
                                              "tendon", "actuator", "sensor"};

Naming naming_of(const ModelFile& file, const std::string& instance, const std::string& id) {
  // Only the classes of the world are renamed: its outermost class would be that of all files.
  if (id.empty()) return {"", "", "/", main_class_of(file.root())};
  return {instance + "/", id + "/", id + "/", main_class_of(file.root())};
}

int id_in(const ModelFile& file, mjtObj type, pugi::xml_node element) {
  return mj_name2id(file.alone.get(), type, element.attribute("name").value());
}

bool is_endless(const mjModel& model, int geom) {
  return model.geom_type[geom] == mjGEOM_PLANE || model.geom_type[geom] == mjGEOM_HFIELD;
}

bool is_sky(pugi::xml_node asset) { return std::string_view(asset.attribute("type").value()) == "skybox"; }

}  // namespace

Composer::Composer(bool exact_mesh_inertia) {
  root_ = document_.append_child("mujoco");
  set_attribute(root_, "model", "composed");
  pugi::xml_node compiler = root_.append_child("compiler");
  set_attribute(compiler, "angle", "radian");
  // All limits are explicit, except for parts of composites, which can have limits only in this way.
  set_attribute(compiler, "autolimits", "true");
  set_attribute(compiler, "exactmeshinertia", exact_mesh_inertia ? "true" : "false");
  defaults_ = root_.append_child("default");
  assets_ = root_.append_child("asset");
  world_ = root_.append_child("worldbody");
  for (const char* section : sections) root_.append_child(section);
}

void Composer::add_world(const ModelFile& world) {
  const Naming naming = naming_of(world, "", "");
  for (const char* section : {"option", "size", "visual", "statistic"}) {
    for (const pugi::xml_node part : world.root().children(section)) root_.append_copy(part);
  }
  // Models may need more of each than the world sets; without a setting the engine counts right.
  for (pugi::xml_node size : root_.children("size")) {
    for (const char* count : {"nkey", "nuser_body", "nuser_jnt", "nuser_geom", "nuser_site", "nuser_cam",
                              "nuser_tendon", "nuser_actuator", "nuser_sensor"})
      size.remove_attribute(count);
  }
  add_shared(world, naming);
  add_elements({world, naming, nullptr, {}, {}});
}

void Composer::add_file(const ModelFile& file, const std::string& id) {
  add_shared(file, naming_of(file, "", id));
}

void Composer::add_instance(const ModelFile& file, const std::string& id, const Placement& placement) {
  add_elements({file, naming_of(file, placement.name, id), &placement, frame_of(placement), {}});
}

void Composer::add_shared(const ModelFile& file, const Naming& naming) {
  copy_default_classes(file.root(), naming, defaults_);
  const bool is_world = naming.element("").empty();
  for (const pugi::xml_node section : file.root().children("asset")) {
    for (const pugi::xml_node asset : section.children()) {
      // Only the sky of the world is kept.
      if (!is_shared_asset(asset) || (!is_world && is_sky(asset))) continue;
      const pugi::xml_node copy = assets_.append_copy(asset);
      naming.give_main_class(copy);
      naming.rename(copy);
    }
  }
}

void Composer::add_elements(Instance instance) {
  const pugi::xml_node root = instance.file.root();
  for (const pugi::xml_node world : root.children("worldbody")) {
    for (const pugi::xml_node element : world.children()) put_in_world(instance, element);
  }
  for (const pugi::xml_node section : root.children("asset")) {
    for (const pugi::xml_node skin : section.children("skin"))
      instance.naming.rename(assets_.append_copy(skin));
  }
  for (const char* section : sections) put_section(instance, section);
}

/// Adds a child of the file's worldbody. Planes and height fields go to the world as well: in any other body,
/// the engine compares them with all bodies, and cannot hold that many pairs.
void Composer::put_in_world(Instance& instance, pugi::xml_node element) {
  if (!is_element(element)) return;
  const mjModel& alone = *instance.file.alone;
  const std::string_view kind = element.name();
  const int body = kind == "body" ? id_in(instance.file, mjOBJ_BODY, element) : -1;
  const int geom = kind == "geom" ? id_in(instance.file, mjOBJ_GEOM, element) : -1;
  if (instance.placement != nullptr && body >= 0 && moves_freely(alone, body)) {
    put_free(instance, element, instance.frame.of(alone.body_pos + 3 * body, alone.body_quat + 4 * body));
  } else if (instance.placement != nullptr && geom >= 0 && is_endless(alone, geom)) {
    put_free(instance, element, instance.frame.of(alone.geom_pos + 3 * geom, alone.geom_quat + 4 * geom));
  } else {
    pugi::xml_node parent = instance.placement == nullptr ? world_ : fixed_body(instance);
    const pugi::xml_node copy = parent.append_copy(element);
    instance.naming.give_main_class(copy);
    instance.naming.rename(copy);
  }
}

void Composer::put_free(const Instance& instance, pugi::xml_node element, const Frame& frame) {
  pugi::xml_node copy = world_.append_copy(element);
  for (const char* attribute : {"euler", "axisangle", "xyaxes", "zaxis"}) copy.remove_attribute(attribute);
  set_attribute(copy, "pos", numbers_text(frame.position.data(), 3));
  set_attribute(copy, "quat", numbers_text(frame.quaternion.data(), 4));
  instance.naming.give_main_class(copy);
  instance.naming.rename(copy);
}

pugi::xml_node Composer::fixed_body(Instance& instance) {
  if (instance.fixed) return instance.fixed;
  instance.fixed = world_.append_child("body");
  set_attribute(instance.fixed, "name", instance.placement->name);
  set_attribute(instance.fixed, "pos", numbers_text(instance.frame.position.data(), 3));
  set_attribute(instance.fixed, "quat", numbers_text(instance.frame.quaternion.data(), 4));
  // Geoms of the world have no mass either.
  pugi::xml_node inertial = instance.fixed.append_child("inertial");
  set_attribute(inertial, "pos", "0 0 0");
  set_attribute(inertial, "mass", "0");
  set_attribute(inertial, "diaginertia", "0 0 0");
  return instance.fixed;
}

void Composer::put_section(Instance& instance, const char* section) {
  pugi::xml_node target = root_.child(section);
  const bool is_actuators = std::string_view(section) == "actuator";
  for (const pugi::xml_node part : instance.file.root().children(section)) {
    for (const pugi::xml_node element : part.children()) {
      if (!is_element(element)) continue;
      const int id = is_actuators ? id_in(instance.file, mjOBJ_ACTUATOR, element) : -1;
      const bool has_state = id >= 0 && instance.file.alone->actuator_dyntype[id] != mjDYN_NONE;
      pugi::xml_node copy = has_state ? with_state_.append_copy(element) : target.append_copy(element);
      instance.naming.give_main_class(copy);
      instance.naming.rename(copy);
      if (instance.placement != nullptr) hold_to_instance(instance, copy);
    }
  }
}

/// Elements that are welded or connected to the world move with the placement. Elements that are not to
/// collide with the world do not collide with the fixed part of its file either.
void Composer::hold_to_instance(Instance& instance, pugi::xml_node element) {
  const std::string_view kind = element.name();
  const auto is_world = [&](const char* key) {
    const std::string_view body = element.attribute(key).value();
    return body.empty() || body == "world";
  };
  if (kind == "weld" || kind == "connect") {
    if (!is_world("body1") && !is_world("body2")) return;
    const std::string name = fixed_body(instance).attribute("name").value();
    for (const char* key : {"body1", "body2"}) {
      if (is_world(key)) set_attribute(element, key, name);
    }
  } else if (kind == "exclude" && instance.fixed && (is_world("body1") || is_world("body2"))) {
    pugi::xml_node copy = element.parent().append_copy(element);
    copy.remove_attribute("name");
    for (const char* key : {"body1", "body2"}) {
      if (is_world(key)) set_attribute(copy, key, instance.fixed.attribute("name").value());
    }
  }
}

std::string Composer::text() {
  pugi::xml_node actuators = root_.child("actuator");
  for (const pugi::xml_node actuator : with_state_.children()) actuators.append_copy(actuator);
  with_state_.reset();
  std::ostringstream text;
  document_.save(text, " ");
  return std::move(text).str();
}

}  // namespace tessera::sim
