// SPDX-License-Identifier: Apache-2.0
// falcon_calibration.h - what a Falcon's motor words are worth, from weights that they hold up.
//
//     -w_i = g_i t_i + d_i sign t_i,     K^T t = (m + m_0) g up
//
//     w_i  motor word of axis i at balance       t_i  torque of the load there, N m
//     g_i  gain, words per N m                   d_i  dead band, words
//     m    mass hung on the grip, kg             m_0  moving mass of the device at the grip, kg
//
// For one m_0 this is linear in (g_i, d_i): least squares, axis by axis; m_0 is the one that leaves
// the least squares of all axes together. It takes several masses and several poses: at one pose a
// dead band and a moving mass look the same (FK-5). K: falcon_kinematics.h.
#pragma once

#include <array>
#include <span>
#include <string>

#include "hal/falcon/falcon_kinematics.h"
#include "model/result.h"

namespace tact::hal::falcon {

struct FalconBalance {
  model::Vec3 position_m;  // frame of the device
  double mass_kg = 0.0;
  std::array<double, 3> words{};
};

struct FalconCalibration {
  std::array<double, 3> gain_words_per_Nm{}, dead_band_words{};  // of axis 1, 2, 3
  double moving_mass_kg = 0.0;
  double residual_words = 0.0;  // root of the mean square
};

inline constexpr double kMaxMovingMass_kg = 0.5;

/// An error says what to measure besides, or what went wrong.
model::Result<FalconCalibration> fit_falcon(std::span<const FalconBalance> samples);

/// The lines of [device.falcon] that a scene takes.
std::string scene_lines(const FalconCalibration& calibration);

}  // namespace tact::hal::falcon
