// SPDX-License-Identifier: Apache-2.0
// press.h - the whole tool pressed into an organ at one of its vertices: is the force sound?
//
//     p(d) = x_v - along (reach - d)     as a press stroke of the hand has it (scene_strokes.h)
//     F    = -along . force on the tool  along the way, N
//     A = int F dd                       work of the hand, J;   W = sum of the spheres' energy_J
//
// From free outside in small steps to the working range of the law (or depth_m), less deep where a
// sphere leaves the range before. In every step, with friction and memory as the scene has them:
//
//     F >= -tolerance                    nothing draws the tool in
//     |step of the force vector| <= k K step_m, k = 1     nothing jumps; K is the device's (HL-1)
//     dF/dd <= K                         dF/dd: the median of three steps, which a jump is not in
//     no sphere comes into the organ unfelt
//
// and, in a second press without friction and relaxation:
//
//     |W - A| <= 2 % A + largest force * step_m           potential and work agree
//
// F may fall along the way: on a steep flank the true force does, too. Set-up code.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>

#include "model/contact/contact.h"
#include "model/result.h"
#include "model/scene/scene.h"
#include "model/scene/tissue.h"

namespace tact::model::scene {

enum class PressWay : std::uint8_t {
  kSquare,   // along the inward normal of the vertex, the tool turned with it
  kUpright,  // along hand.inward, the tool as at rest
};

struct PressPoint {
  std::uint32_t vertex = 0;
  PressWay way = PressWay::kSquare;
};

struct PressSettings {
  double step_m = 2e-5;
  double depth_m = 0.0;  // 0: the working range of the law
  double limit_N_per_m = std::numeric_limits<double>::infinity();  // K
  bool checks_energy = true;  // never of a law that is stepped: it has no potential of the depth
};

enum class PressState : std::uint8_t {
  kPressed,
  kMissed,   // the tool passes the organ
  kBlocked,  // could not start: another part of the tool is in the organ
};

/// Largest or least of a quantity along the way, and where.
struct PressExtreme {
  double value = 0.0;
  double depth_m = 0.0;
};

struct PressResult {
  PressPoint place;
  PressState state = PressState::kBlocked;
  double deepest_m = 0.0;  // of the tool's lowest point
  double force_N = 0.0;    // F there
  PressExtreme slope_N_per_m;
  PressExtreme change_N;         // of the force vector in one step
  PressExtreme least_N;          // F
  PressExtreme energy_ratio;     // W / A - 1, less what rounding to steps explains; 0: not checked
  bool is_not_rendered = false;  // a sphere came into the organ and has no force
  bool is_unsettled = false;     // its force would have jumped and was slowed down
};

inline constexpr double kDrawTolerance_N = 1e-3;  // of F below 0; chosen: below what a hand notices
inline constexpr double kEnergyTolerance_ratio = 0.02;  // chosen

struct PressFlaws {
  bool draws_in = false, changes_too_fast = false, is_too_stiff = false, is_not_rendered = false;
  bool energy_differs = false;

  bool any() const {
    return draws_in || changes_too_fast || is_too_stiff || is_not_rendered || energy_differs;
  }
};

PressFlaws flaws_of(const PressResult& result, const PressSettings& settings);
/// "vertex 1586, upright"
std::string name_of(const PressPoint& place);
/// What is wrong there, by quantity, size and depth; empty where all is sound.
std::string describe_flaws(const PressResult& result, const PressSettings& settings);

/// One step of a press.
struct PressStep {
  double depth_m = 0.0;
  Vec3 force_N{};        // on the tool
  double along_N = 0.0;  // F
  double stored_J = 0.0, work_J = 0.0;
};

/// One press by the contact of any law. The energy is that of this press, friction and all.
PressResult press_once(const contact::ContactScene& contact, const Vec3& inward,
                       const PressPoint& place, const PressSettings& settings,
                       const std::function<void(const PressStep&)>& on_step = {});

/// Presses the tool of a scene.
class Presser {
 public:
  /// `scene` and `tissue` must outlive it; tissue: that of the scene which is pressed
  /// (tissue_for_check), or null for one of its own.
  static Result<std::unique_ptr<Presser>> make(const Scene& scene, const PressSettings& settings,
                                               const Tissue* tissue = nullptr);
  /// Independent of earlier presses.
  PressResult press(const PressPoint& place);
  /// With the depth that is pressed, and whether the energy is checked.
  const PressSettings& settings() const { return settings_; }

 private:
  Presser(const Scene& scene, const PressSettings& settings)
      : inward_(scene.hand_inward), settings_(settings) {}

  Vec3 inward_;
  PressSettings settings_;
  const Tissue* tissue_ = nullptr;
  std::unique_ptr<Tissue> own_tissue_;
  Scene elastic_scene_;  // without friction and relaxation
  std::unique_ptr<Tissue> elastic_tissue_;
};

/// By how much a press fails its worst check; 1: just not.
double severity(const PressResult& result, const PressSettings& settings);

}  // namespace tact::model::scene
