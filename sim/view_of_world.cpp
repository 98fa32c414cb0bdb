#include "sim/view_of_world.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/devices/device_error.hpp"
#include "sim/engine/elements.hpp"
#include "sim/engine/shapes.hpp"

namespace tessera::sim {
namespace {

class ViewOfWorld final : public WorldState {
 public:
  ViewOfWorld(std::shared_ptr<Simulation> simulation, std::string agent)
      : simulation_(std::move(simulation)), agent_(std::move(agent)) {}

  [[nodiscard]] Duration time() const override {
    Duration now{};
    use([&](const Physics& physics) { now = physics.time(); });
    return now;
  }
  [[nodiscard]] Pose body(const std::string& name) const override {
    Pose pose;
    use([&](const Physics& physics) {
      const int id = find(physics, mjOBJ_BODY, name);
      const mjData& now = physics.positions();
      std::copy_n(now.xpos + 3 * id, 3, pose.position_m.begin());
      std::copy_n(now.xquat + 4 * id, 4, pose.quaternion.begin());
    });
    return pose;
  }
  [[nodiscard]] Pose site(const std::string& name) const override {
    Pose pose;
    use([&](const Physics& physics) {
      const int id = find(physics, mjOBJ_SITE, name);
      const mjData& now = physics.positions();
      std::copy_n(now.site_xpos + 3 * id, 3, pose.position_m.begin());
      mju_mat2Quat(pose.quaternion.data(), now.site_xmat + 9 * id);
    });
    return pose;
  }
  [[nodiscard]] std::vector<double> sensor(const std::string& name) const override {
    std::vector<double> values;
    use([&](const Physics& physics) {
      const int id = find(physics, mjOBJ_SENSOR, name);
      const mjtNum* const from = physics.state().sensordata + physics.model().sensor_adr[id];
      values.assign(from, from + physics.model().sensor_dim[id]);
    });
    return values;
  }
  [[nodiscard]] std::vector<double> joint_position(const std::string& name) const override {
    std::vector<double> values;
    use([&](const Physics& physics) {
      const int id = find(physics, mjOBJ_JOINT, name);
      const mjtNum* const from = physics.positions().qpos + physics.model().jnt_qposadr[id];
      values.assign(from, from + position_size(physics.model(), id));
    });
    return values;
  }
  [[nodiscard]] std::vector<double> joint_velocity(const std::string& name) const override {
    std::vector<double> values;
    use([&](const Physics& physics) {
      const int id = find(physics, mjOBJ_JOINT, name);
      const mjtNum* const from = physics.positions().qvel + physics.model().jnt_dofadr[id];
      values.assign(from, from + velocity_size(physics.model(), id));
    });
    return values;
  }
  [[nodiscard]] bool touch(const std::string& body, const std::string& other) const override {
    bool found = false;
    use([&](const Physics& physics) {
      const mjModel& model = physics.model();
      const int one = find(physics, mjOBJ_BODY, body), two = find(physics, mjOBJ_BODY, other);
      const mjData& now = physics.state();
      const auto part = [&](int geom, int of) { return is_part_of(model, model.geom_bodyid[geom], of); };
      found = std::any_of(now.contact, now.contact + now.ncon, [&](const mjContact& contact) {
        return contact.dist <= 0 && ((part(contact.geom1, one) && part(contact.geom2, two)) ||
                                     (part(contact.geom2, one) && part(contact.geom1, two)));
      });
    });
    return found;
  }
  void command(const std::string& actuator, double value) override {
    if (!std::isfinite(value)) throw WorldError("a command to '" + actuator + "' is not finite");
    use([&](Physics& physics) { physics.command(find(physics, mjOBJ_ACTUATOR, actuator), value); });
  }
  void push(const std::string& body, const std::array<double, 3>& force_n) override {
    if (!std::ranges::all_of(force_n, [](double part) { return std::isfinite(part); }))
      throw WorldError("a force on '" + body + "' is not finite");
    use([&](Physics& physics) {
      const int id = find(physics, mjOBJ_BODY, body);
      physics.before_next_step([id, force_n](mjModel&, mjData& state, const mjData&) {
        std::ranges::copy(force_n, state.xfrc_applied + 6 * id);
      });
    });
  }

 private:
  /// The other errors of a simulation become errors of a world, too.
  template <class Use>
  void use(Use&& what) const try {
    simulation_->use(std::forward<Use>(what));
  } catch (const WorldError&) {
    throw;
  } catch (const std::exception& error) {
    throw WorldError(error.what());
  }

  [[nodiscard]] int find(const Physics& physics, mjtObj type, const std::string& name) const {
    if (const auto id = find_element(physics.model(), type, agent_, name)) return *id;
    const DriverProblem problem =
        unknown_name(word_for(type), name, names_for(physics.model(), type, agent_));
    throw WorldError(problem.text + "; " + problem.hint);
  }

  std::shared_ptr<Simulation> simulation_;
  std::string agent_;
};

}  // namespace

std::shared_ptr<WorldState> view_of_world(std::shared_ptr<Simulation> simulation, std::string agent) {
  return std::make_shared<ViewOfWorld>(std::move(simulation), std::move(agent));
}

}  // namespace tessera::sim
