// SPDX-License-Identifier: Apache-2.0
// own_law - a custom law, F = k d + c d^3, on a scene's organ; the scene's tool presses it at
// 10 mm/s. Prints depth, force of the law and force after the gate.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "firmware/loop/controller.h"
#include "model/law/law.h"
#include "model/scene/scene.h"
#include "model/tissue/elastic_field.h"

using namespace tact::model;
namespace loop = tact::firmware::loop;

namespace {

/// F = k d + c d^3 = dU/dd, U = k d^2 / 2 + c d^4 / 4; up to 10 mm. Press only.
class Stiffening final : public law::Law {
 public:
  law::LawResponse respond(double depth_m) const RT_SAFE override {
    if (std::isnan(depth_m)) return {.status = law::LawStatus::kInvalid};
    if (depth_m <= 0.0) return {.status = law::LawStatus::kNoContact};
    const double d = std::min(depth_m, kRange_m);
    return law::beyond_limit(
        {.force_N = kLinear_N_per_m * d + kCubic_N_per_m3 * d * d * d,
         .stiffness_N_per_m = kLinear_N_per_m + 3 * kCubic_N_per_m3 * d * d,
         .energy_J = kLinear_N_per_m * d * d / 2 + kCubic_N_per_m3 * d * d * d * d / 4,
         .status = law::LawStatus::kOk},
        d, depth_m);
  }
  law::LawRange range() const RT_SAFE override { return {.pull_m = 0.0, .press_m = kRange_m}; }
  /// The shape of the indentation, which a viewer shows.
  std::size_t profile(double depth_m, std::span<double> ring_m) const RT_SAFE override {
    if (ring_m.size() < 2) return 0;
    ring_m[0] = std::clamp(depth_m, 0.0, kRange_m);
    ring_m[1] = 0.0;
    return 2;
  }
  double ring_pitch_m() const RT_SAFE override { return kRange_m; }

 private:
  static constexpr double kRange_m = 0.010;
  static constexpr double kLinear_N_per_m = 30.0;  // k
  static constexpr double kCubic_N_per_m3 = 5e5;   // c
};

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return std::fputs("usage: own_law SCENE.toml\n", stderr), 2;
  const auto scene = scene::load_scene(arguments[1], {});
  if (!scene) return std::fprintf(stderr, "%s\n", scene.error().message.c_str()), 2;
  const double period_s = 1.0 / scene->rate_Hz;

  const Stiffening law;
  const std::array<const law::Law*, 1> curves{&law};
  const auto surface = scene->organ_mesh.view();
  const auto tree = contact::make_triangle_tree(surface);
  tissue::ElasticField tissue({.curves = curves, .surface = surface, .relaxation = {}});
  loop::Controller controller({.law = &tissue,
                               .parameters = scene->contact,
                               .spheres = scene->tool.spheres,
                               .surface = surface,
                               .tree = tree.view(),
                               .period_s = period_s},
                              tact::firmware::gate::Gate(scene->limits, period_s, 1.0), false);

  double reach_m = 0.0;  // of the tool, along the way in
  for (const contact::ProbeSphere& sphere : scene->tool.spheres)
    reach_m = std::max(reach_m, dot(sphere.offset_m, scene->hand_inward) + sphere.radius_m);
  std::puts("depth of the jaws, mm   force of the law, N   force after the gate, N");
  for (int tick = 0; tick <= 1000; ++tick) {
    const double depth_m = 0.010 * tick * period_s - 0.004;
    loop::TickInput input;
    input.sample = {
        .tool = {.position_m = scene->hand_site_m + (depth_m - reach_m) * scene->hand_inward},
        .stamp_ns = static_cast<std::int64_t>(1e9 * tick * period_s),
        .fresh = true};
    input.commands.arm = tick > 0;
    const loop::TickOutput out = controller.tick(input);
    if (tick % 100 == 0)
      std::printf("%21.1f %21.3f %25.3f\n", 1e3 * depth_m, norm(out.wanted.force_N),
                  norm(out.written.force_N));
  }
}
