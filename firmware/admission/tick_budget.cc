// SPDX-License-Identifier: Apache-2.0
#include "firmware/admission/tick_budget.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "firmware/loop/clock.h"
#include "firmware/loop/controller.h"
#include "hal/threads/thread.h"
#include "model/scene/scene_strokes.h"
#include "model/time_ns.h"

namespace tact::firmware::admission {
namespace {

using model::Vec3;

// All chosen. p99.9 of 4000 ticks is the fourth longest. A scene too slow for 4000 ticks in 150 ms
// is checked with fewer.
constexpr std::size_t kTurnTicks = 4000;  // one turn of the circle: some 20 mm/s, as a hand
constexpr std::size_t kMaxTicks = 4000;   // enough for a p99.9
constexpr std::int64_t kLongest_ns = 150'000'000;
constexpr double kCircleEdges = 5.0;  // radius: beyond what a patch covers without a new gathering
constexpr std::size_t kApproachTicks = 50;  // a contact begins from outside
constexpr double kApproach_m = 0.01;

/// One turn around the middle of a triangle, in its plane, each point projected onto the surface.
std::vector<model::contact::ContactPoint> circle(const model::mesh::SurfaceMesh& mesh,
                                                 std::uint32_t start) {
  const auto& corner = mesh.triangle[start];
  const Vec3 a_m = mesh.vertex_m[corner[0]], b_m = mesh.vertex_m[corner[1]];
  const Vec3 middle_m = (1.0 / 3.0) * (a_m + b_m + mesh.vertex_m[corner[2]]);
  const Vec3 along = normalized(b_m - a_m);
  const Vec3 across = cross(mesh.face_normal[start], along);
  const double radius_m = kCircleEdges * norm(b_m - a_m);
  std::vector<model::contact::ContactPoint> way;
  std::uint32_t triangle = start;
  for (std::size_t i = 0; i < kTurnTicks; ++i) {
    const double angle_rad =
        2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(kTurnTicks);
    const Vec3 p_m =
        middle_m + radius_m * (std::cos(angle_rad) * along + std::sin(angle_rad) * across);
    // Each search starts in the triangle where the last one ended, as in contact.
    way.push_back(follow(mesh.view(), triangle, p_m));
    triangle = way.back().surface_point.triangle;
  }
  return way;
}

/// From outside to half of the deepest and back, in 1257 ticks, along the circle.
std::vector<model::Tool> contact_path(const model::scene::Scene& scene,
                                      const model::contact::ContactScene& contact,
                                      double deepest_m) {
  const auto start = nearest_contact_point(contact.tree, contact.surface, scene.hand_site_m,
                                           model::contact::kAnywhere_m, 0);
  const auto way = circle(scene.organ_mesh, start.surface_point.triangle);
  const double reach_m = model::scene::reach_m(contact.spheres, scene.hand_inward);
  std::vector<model::Tool> path(kMaxTicks);
  for (std::size_t k = 0; k < kMaxTicks; ++k) {
    const std::size_t pressed = k < kApproachTicks ? 0 : k - kApproachTicks;
    const double approach = static_cast<double>(std::min(k, kApproachTicks)) / kApproachTicks;
    const double depth_m =
        0.25 * deepest_m * (1.0 - std::cos(0.005 * static_cast<double>(pressed))) -
        (1.0 - approach) * kApproach_m;
    path[k].position_m =
        way[pressed % kTurnTicks].point_m + (depth_m - reach_m) * scene.hand_inward;
    if (k > 0) path[k].velocity_mps = scene.rate_Hz * (path[k].position_m - path[k - 1].position_m);
  }
  return path;
}

bool is_in_contact(const loop::Controller& controller) {
  return std::ranges::any_of(controller.contacts(), [](const model::contact::SphereContact& c) {
    return c.force_N != Vec3{};
  });
}

/// Rounded up to a sample, so that a p99.9 is never reported too low.
double at_share(const std::vector<double>& ascending, double share) {
  const auto last = static_cast<double>(ascending.size() - 1);
  return ascending[static_cast<std::size_t>(std::ceil(share * last))];
}

}  // namespace

TickTime measure_tick(const model::scene::Scene& scene, const model::contact::ContactScene& contact,
                      double deepest_m) {
  const std::vector<model::Tool> path = contact_path(scene, contact, deepest_m);
  const auto controller = std::make_unique<loop::Controller>(
      contact, gate::Gate(scene.limits, contact.period_s, 1.0), /*hard_real_time=*/true);
  loop::MonotonicClock clock;
  std::vector<double> all_us, contact_us;
  double unused_N = 0.0;
  const std::int64_t begin_ns = clock.now_ns(), period_ns = model::period_ns(scene.rate_Hz);
  for (std::size_t k = 0; k < kMaxTicks && clock.now_ns() - begin_ns < kLongest_ns; ++k) {
    const loop::TickInput input{.sample = {.tool = path[k],
                                           .stamp_ns = static_cast<std::int64_t>(k) * period_ns,
                                           .sequence = k + 1,
                                           .fresh = true},
                                .commands = {.arm = k == 1}};
    const std::int64_t start_ns = clock.now_ns();
    unused_N += norm(controller->tick(input).wanted.force_N);  // a diverged law is detected
    all_us.push_back(1e-3 * static_cast<double>(clock.now_ns() - start_ns));
    if (is_in_contact(*controller)) contact_us.push_back(all_us.back());
  }
  constexpr double kNever = std::numeric_limits<double>::infinity();
  // A diverged law is never fast enough.
  if (!std::isfinite(unused_N))
    return {.median_us = kNever, .p999_us = kNever, .longest_us = kNever};
  std::vector<double>& us = contact_us.empty() ? all_us : contact_us;
  std::ranges::sort(us);
  return {.median_us = at_share(us, 0.5), .p999_us = at_share(us, 0.999), .longest_us = us.back()};
}

model::Result<TimeMargin> check_budget(const model::scene::Scene& scene,
                                       const model::scene::Tissue& tissue,
                                       const std::optional<pc::RtSettings>& hard_real_time) {
  const auto measured = tissue_for_check(scene, tissue);
  if (!measured) return measured.error();
  const model::scene::TissueLaw& law = measured->tissue->law();
  TimeMargin margin;
  margin.tail_counts = hard_real_time.has_value();
  margin.budget_us = scene.tolerance ? scene.tolerance->tick_budget_us : 0.5e6 / scene.rate_Hz;
  // In a separate thread, which keeps its priority, core and flushed denormals to itself.
  auto thread = hal::threads::start_thread("tact-budget", [&] {
    std::vector<pc::Shortfall> known;  // probe_rt_threads has reported them
    if (hard_real_time) pc::enter_rt_thread(*hard_real_time, known);
    pc::flush_denormals();
    margin.measured = measure_tick(scene, measured->tissue->contact_scene(), law.range().press_m);
  });
  if (!thread) return thread.error();
  thread->join();
  margin.checked_us = margin.tail_counts ? margin.measured.p999_us : margin.measured.median_us;
  if (margin.checked_us <= margin.budget_us) return margin;
  return model::Error{fmt::format(
      "{}: {} needs {:.1f} us a tick here ({}), {} {:g} us; choose a smaller model (tact-lab plan "
      "names one), {} or take a faster machine",
      scene.path, law.title(), margin.checked_us,
      margin.tail_counts ? "p99.9" : "median: without hard real time the tail is the kernel's",
      scene.tolerance ? "tolerance.tick_budget_us is" : "half a period of rate_Hz is",
      margin.budget_us, scene.tolerance ? "raise the budget" : "lower rate_Hz")};
}

}  // namespace tact::firmware::admission
