// SPDX-License-Identifier: Apache-2.0
// press_sweep.h - presses (press.h) at many vertices of an organ. Set-up code.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "model/result.h"
#include "model/scene/press.h"
#include "model/scene/scene.h"

namespace tact::model::scene {

/// Up to `count` vertices of the organ (0: all), spread over their numbers, pressed the ways that
/// are asked for. Upright: of those that face the hand.
std::vector<PressPoint> press_points(const Scene& scene, std::size_t count, bool square,
                                     bool upright);

struct PressSweep {
  PressSettings settings;
  std::vector<PressResult> results;  // in the order of the places

  const PressResult* stiffest() const;             // of those that were pressed; null: none
  std::vector<const PressResult*> flawed() const;  // the worst first
  std::size_t count(PressState state) const;
};

/// Every place in turn; `goes_on` is asked after each press, with how many are done. An error if
/// the scene's law has no meaning or it was stopped. `tissue`: as Presser takes it.
Result<PressSweep> sweep_presses(
    const Scene& scene, std::span<const PressPoint> places, const PressSettings& settings,
    const std::function<bool(std::size_t done, std::size_t all)>& goes_on = {},
    const Tissue* tissue = nullptr);

}  // namespace tact::model::scene
