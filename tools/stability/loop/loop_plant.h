// SPDX-License-Identifier: Apache-2.0
// loop_plant.h - device and hand as one mass: exact motion under a force that is held.
//
//     M y'' + B y' + k y + c sgn(y') = f        f constant during one move
//
//     y  from the point of balance, m           M  of device and hand together, kg
//     B  of device and hand, N s/m              k  of the hand, N/m;   c  Coulomb friction, N
//
// Between two events the motion is linear, so its Taylor series is summed until rounding; the
// moment in which the velocity comes to zero is found on that series. No time step of an integrator
// adds or takes energy, which is what the stability maps are about.
#pragma once

#include <array>
#include <cstddef>

namespace tact::tools::stability {

struct PlantParameters {
  double mass_kg = 0.0;           // M, > 0
  double damping_Ns_per_m = 0.0;  // B
  double stiffness_N_per_m = 0.0;
  double friction_N = 0.0;
};

class LoopPlant {
 public:
  explicit LoopPlant(const PlantParameters& parameters);

  void place(double position_m) { position_m_ = position_m, velocity_mps_ = 0.0; }
  void move(double force_N, double duration_s);

  double position_m() const { return position_m_; }
  double velocity_mps() const { return velocity_mps_; }
  /// Held by friction during the whole of the last move.
  bool is_stuck() const { return stuck_; }

 private:
  static constexpr std::size_t kTerms = 12;

  void expand(double force_N);
  double position_at(double t_s) const;
  double velocity_at(double t_s) const;
  double stop_time_s(double direction, double step_s) const;

  PlantParameters p_;
  double longest_step_s_;  // of one series
  double position_m_ = 0.0, velocity_mps_ = 0.0;
  bool stuck_ = false;
  std::array<double, kTerms> y_{};  // y(t) = sum y_n t^n
};

}  // namespace tact::tools::stability
