#pragma once

#include <cstdint>
#include <random>
#include <string>

#include "sim/engine/seeds.hpp"

namespace tessera::sim {

/// Normally distributed numbers that depend only on the seed and the path of the device.
class Noise {
 public:
  Noise(std::uint64_t seed, const std::string& path) : random_(seed_of(path, seed)) {}
  [[nodiscard]] double draw(double deviation) { return deviation * normal_(random_); }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

}  // namespace tessera::sim
