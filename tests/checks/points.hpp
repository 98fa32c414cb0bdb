#pragma once

#include <array>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "checks/scene.hpp"

namespace tessera::checks_test {

/// A world of points that a test moves. A zone is the ball of 1 m around its point. Sensors have the name of
/// a point and give its coordinates.
class Points final : public checks::Scene {
 public:
  std::map<std::string, std::array<double, 3>> at;
  std::map<std::string, double> speeds;
  std::set<std::pair<std::string, std::string>> touching;

  [[nodiscard]] std::vector<std::int64_t> indices_of(std::string_view name) const override;
  [[nodiscard]] std::vector<std::string> groups() const override { return {"robot[*]"}; }
  [[nodiscard]] Result<std::size_t> find(As as, const std::string& name) override;
  [[nodiscard]] std::size_t dimension_of(std::size_t sensor) const override;
  [[nodiscard]] std::array<double, 3> position(std::size_t point) override;
  [[nodiscard]] double speed(std::size_t point) override;
  [[nodiscard]] bool touched(std::size_t solid, std::size_t other) override;
  [[nodiscard]] bool touched_anything(std::size_t solid) override;
  [[nodiscard]] bool inside(std::size_t point, std::size_t zone) override;
  [[nodiscard]] checks::OnLine on_line(std::size_t) override { return {}; }
  [[nodiscard]] double sensor(std::size_t sensor, std::size_t component) override;

 private:
  std::vector<std::string> names_;
};

}  // namespace tessera::checks_test
