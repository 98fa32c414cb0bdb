#pragma once

#include <Eigen/Dense>
#include <array>

namespace approach {

/// A Kalman filter of distance and speed, for a cart that gets noisy distances.
class Filter {
 public:
  /// Both stay where they are: they are arrays in the memory of the control subsystem.
  Filter(std::array<double, 2>& state, std::array<double, 4>& covariance)
      : x_(state.data()), p_(covariance.data()) {}

  /// The time that has passed, in s, and the acceleration that is possible, in m/s^2.
  void predict(double time_s, double acceleration) {
    Eigen::Matrix2d step;
    step << 1, time_s, 0, 1;
    const Eigen::Vector2d push(time_s * time_s / 2, time_s);
    x_ = step * x_;
    p_ = step * p_ * step.transpose() + acceleration * acceleration * push * push.transpose();
  }

  /// A measured distance in m, and its standard deviation in m.
  void correct(double distance_m, double deviation_m) {
    const double variance = p_(0, 0) + deviation_m * deviation_m;
    const Eigen::Vector2d gain = p_.col(0) / variance;
    x_ += gain * (distance_m - x_(0));
    p_ -= gain * p_.row(0).eval();
  }

 private:
  Eigen::Map<Eigen::Vector2d> x_;
  Eigen::Map<Eigen::Matrix2d> p_;
};

}  // namespace approach
