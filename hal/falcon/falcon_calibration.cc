// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon/falcon_calibration.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "model/units.h"

namespace tact::hal::falcon {
namespace {

using model::Error;
using model::Result;

constexpr double kStep_kg = 0.005;  // of the first look; then finer
constexpr int kRefinements = 40;    // each keeps 0.618 of the range
constexpr double kFlatness = 1e-3;  // relative: below it every moving mass fits as well
constexpr double kParallel = 1e-6;  // 1 - cos^2 between torque and sign: not identifiable

struct Axis {
  double gain = 0.0, dead = 0.0, squares = 0.0;
  bool known = false;
};

/// Torques that hold 1 kg at the grip, by sample.
std::vector<delta::Joints> unit_torques_Nm(std::span<const FalconBalance> samples) {
  const FalconKinematics falcon;
  std::vector<delta::Joints> out;
  for (const FalconBalance& s : samples) {
    const FalconInverse legs = falcon.inverse(s.position_m);
    out.push_back(
        legs.reachable
            // Up is y of the device's frame (falcon_kinematics.h).
            ? falcon_torques_Nm(falcon.joint_rate_matrix(legs), {0.0, model::kGravity_mps2, 0.0})
            : delta::Joints{});
  }
  return out;
}

enum class DeadBand { kAny, kNotNegative };

/// min over (g, d) of sum (y - g t - d s)^2 with y = -w, s = sign t.
Axis fit_axis(std::span<const FalconBalance> samples, std::span<const delta::Joints> unit_Nm,
              std::size_t i, double moving_kg, DeadBand sign) {
  double tt = 0.0, ts = 0.0, ss = 0.0, ty = 0.0, sy = 0.0, yy = 0.0;
  for (std::size_t n = 0; n < samples.size(); ++n) {
    const double t = (samples[n].mass_kg + moving_kg) * unit_Nm[n][i];
    // The dead band adds words in the direction of the torque.
    const double s = t > 0.0 ? 1.0 : t < 0.0 ? -1.0 : 0.0;
    const double y = -samples[n].words[i];
    tt += t * t, ts += t * s, ss += s * s, ty += t * y, sy += s * y, yy += y * y;
  }
  Axis axis;
  // Normal equations of two unknowns, by Cramer.
  const double determinant = tt * ss - ts * ts;
  axis.known = determinant > kParallel * tt * ss;
  if (!axis.known) return axis;
  axis.gain = (ty * ss - sy * ts) / determinant;
  axis.dead = (sy * tt - ty * ts) / determinant;
  // A motor has no dead band below zero: then the best at zero, which is a line through 0.
  if (sign == DeadBand::kNotNegative && axis.dead < 0.0) axis.gain = ty / tt, axis.dead = 0.0;
  axis.squares = yy - 2.0 * (axis.gain * ty + axis.dead * sy) + axis.gain * axis.gain * tt +
                 2.0 * axis.gain * axis.dead * ts + axis.dead * axis.dead * ss;
  return axis;
}

struct Fit {
  std::array<Axis, 3> axis;
  double squares = 0.0;
  bool known = true;
};

Fit fit_all(std::span<const FalconBalance> samples, std::span<const delta::Joints> unit_Nm,
            double moving_kg, DeadBand sign = DeadBand::kNotNegative) {
  Fit fit;
  for (std::size_t i = 0; i < 3; ++i) {
    fit.axis[i] = fit_axis(samples, unit_Nm, i, moving_kg, sign);
    fit.squares += fit.axis[i].squares;
    fit.known = fit.known && fit.axis[i].known;
  }
  return fit;
}

/// The least of `squares` between two masses, by golden section.
template <typename Squares>
double least_between_kg(double low_kg, double high_kg, const Squares& squares) {
  const double ratio = 0.5 * (std::sqrt(5.0) - 1.0);
  for (int i = 0; i < kRefinements; ++i) {
    const double a_kg = high_kg - ratio * (high_kg - low_kg);
    const double b_kg = low_kg + ratio * (high_kg - low_kg);
    if (squares(a_kg) < squares(b_kg))
      high_kg = b_kg;
    else
      low_kg = a_kg;
  }
  return 0.5 * (low_kg + high_kg);
}

bool is_one_mass(std::span<const FalconBalance> samples) {
  return std::ranges::all_of(samples,
                             [&](const auto& s) { return s.mass_kg == samples[0].mass_kg; });
}

std::optional<Error> check_balances(std::span<const FalconBalance> samples) {
  if (samples.size() < 4 || is_one_mass(samples))
    return Error{"four balances with two masses are the least: hang other masses, at other poses"};
  for (const FalconBalance& s : samples)
    if (!is_finite(s.position_m) ||
        !std::isfinite(s.mass_kg + s.words[0] + s.words[1] + s.words[2]))
      return Error{"a balance holds no numbers: measure it again"};
  return std::nullopt;
}

std::optional<Error> check_axes(const std::array<Axis, 3>& axis) {
  for (std::size_t i = 0; i < 3; ++i)
    // libnifalcon's 10 000 words per N m (FK-5), a hundred times less or more; a quarter of 4095.
    if (!(axis[i].gain >= 100.0 && axis[i].gain <= 1e6 && axis[i].dead <= 1000.0))
      return Error{
          fmt::format("axis {} comes out at {:.0f} words per N m with a dead band of {:.0f} words: "
                      "something else carried the load; leave the grip free and measure again",
                      i + 1, axis[i].gain, axis[i].dead)};
  return std::nullopt;
}

double sum_of_squares(std::span<const FalconBalance> samples) {
  double sum = 0.0;
  for (const FalconBalance& s : samples)
    for (const double word : s.words) sum += word * word;
  return sum;
}

}  // namespace

Result<FalconCalibration> fit_falcon(std::span<const FalconBalance> samples) {
  if (auto error = check_balances(samples)) return *error;
  const std::vector<delta::Joints> unit_Nm = unit_torques_Nm(samples);
  const auto squares = [&](double kg) { return fit_all(samples, unit_Nm, kg).squares; };
  double best_kg = 0.0, least = 1e300, most = 0.0;  // of any dead band: is there a least at all?
  for (double kg = 0.0; kg <= kMaxMovingMass_kg; kg += kStep_kg) {
    if (!fit_all(samples, unit_Nm, kg + 0.5 * kStep_kg).known)
      return Error{"the loads of an axis are all alike: hang more different masses"};
    if (squares(kg) < squares(best_kg)) best_kg = kg;
    // If these stay flat, every mass fits with some dead band: the two are not identifiable.
    const double free = fit_all(samples, unit_Nm, kg, DeadBand::kAny).squares;
    least = std::min(least, free);
    most = std::max(most, free);
  }
  const double moving_kg =
      least_between_kg(std::max(0.0, best_kg - kStep_kg), best_kg + kStep_kg, squares);
  const Fit fit = fit_all(samples, unit_Nm, moving_kg);
  if (most - least <= kFlatness * kFlatness * sum_of_squares(samples))
    return Error{
        "dead band and moving mass cannot be separated: balance the same masses at other poses, "
        "some centimetres away"};
  const auto& axis = fit.axis;
  if (auto error = check_axes(axis)) return *error;
  return FalconCalibration{
      .gain_words_per_Nm = {axis[0].gain, axis[1].gain, axis[2].gain},
      .dead_band_words = {axis[0].dead, axis[1].dead, axis[2].dead},
      .moving_mass_kg = moving_kg,
      .residual_words =
          // Rounding can leave a perfect fit a little below zero.
      std::sqrt(std::max(fit.squares, 0.0) / (3.0 * static_cast<double>(samples.size())))};
}

std::string scene_lines(const FalconCalibration& c) {
  const auto &gain = c.gain_words_per_Nm, &dead = c.dead_band_words;
  return fmt::format(
      "[device.falcon]\n"
      "gain_words_per_Nm = [{:.0f}.0, {:.0f}.0, {:.0f}.0]\n"
      "dead_band_words = [{:.0f}.0, {:.0f}.0, {:.0f}.0]\n"
      "moving_mass_kg = {:.3f}\n",
      gain[0], gain[1], gain[2], dead[0], dead[1], dead[2], c.moving_mass_kg);
}

}  // namespace tact::hal::falcon
