// SPDX-License-Identifier: Apache-2.0
#include "firmware/admission/tick_budget.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <thread>
#include <vector>

#include "firmware/loop/clock.h"

namespace tact::firmware::admission {
namespace {

using model::Vec3;

// All chosen. p99.9 of 4000 ticks is the fourth longest. A law too slow for 4000 ticks in 150 ms is
// checked with fewer.
constexpr std::size_t kTurnTicks = 500;  // one turn of the circle
constexpr std::size_t kMaxTicks = 4000;  // enough for a p99.9
constexpr std::int64_t kLongest_ns = 150'000'000;
constexpr double kCircleEdges = 5.0;  // radius: beyond what a patch covers without a new gathering

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

/// A blade at rest where the tool touches: it cuts nothing, but takes the time of the check.
model::contact::BladeSweep still(const model::contact::Blade& blade, const Vec3& tool_m) {
  const Vec3 a_m = tool_m + blade.a_m, b_m = tool_m + blade.b_m;
  return {.from_a_m = a_m, .from_b_m = b_m, .to_a_m = a_m, .to_b_m = b_m};
}

/// Rounded up to a sample, so that a p99.9 is never reported too low.
double at_share(const std::vector<double>& ascending, double share) {
  const auto last = static_cast<double>(ascending.size() - 1);
  return ascending[static_cast<std::size_t>(std::ceil(share * last))];
}

}  // namespace

LawTime measure_law(const model::scene::Scene& scene, model::contact::ContactLaw& twin,
                    double deepest_m) {
  const std::size_t spheres = scene.tool.spheres.size();
  const std::size_t triangles = scene.organ_mesh.triangle.size();
  std::vector<std::vector<model::contact::ContactPoint>> ways;
  ways.reserve(spheres);
  for (std::size_t i = 0; i < spheres; ++i)
    ways.push_back(circle(scene.organ_mesh, static_cast<std::uint32_t>((triangles * i) / spheres)));
  loop::MonotonicClock clock;
  std::vector<double> tick_us;
  tick_us.reserve(kMaxTicks);
  double unused_N = 0.0;
  const std::int64_t begin_ns = clock.now_ns();
  for (std::int64_t start_ns = begin_ns, end_ns = begin_ns;
       tick_us.size() < kMaxTicks && start_ns - begin_ns < kLongest_ns; start_ns = end_ns) {
    const std::size_t tick = tick_us.size();
    // From no depth to half of the deepest and back, in 314 ticks.
    const double wave = std::sin(0.02 * static_cast<double>(tick));
    for (std::size_t i = 0; i < spheres; ++i) {
      const model::contact::ContactPoint& site = ways[i][tick % kTurnTicks];
      // Summed, so that the compiler keeps every call, and a diverged law is detected.
      unused_N += twin.respond({.sphere = i,
                                .surface_point = site.surface_point,
                                .normal = site.normal,
                                .indentation_m = 0.25 * deepest_m * (1.0 + wave)})
                      .law.force_N;
    }
    if (scene.tool.blade) twin.cut(still(*scene.tool.blade, ways[0][tick % kTurnTicks].point_m));
    twin.advance();
    // One clock reading per tick: the end of one is the start of the next.
    end_ns = clock.now_ns();
    tick_us.push_back(1e-3 * static_cast<double>(end_ns - start_ns));
  }
  constexpr double kNever = std::numeric_limits<double>::infinity();
  // A diverged law is never fast enough.
  if (!std::isfinite(unused_N)) return {.median_us = kNever, .p999_us = kNever};
  std::sort(tick_us.begin(), tick_us.end());
  return {.median_us = at_share(tick_us, 0.5), .p999_us = at_share(tick_us, 0.999)};
}

model::Result<TimeMargin> check_budget(const model::scene::Scene& scene,
                                       const std::optional<pc::RtSettings>& hard_real_time) {
  const auto twin = model::scene::make_tissue_law(scene, scene.law);
  if (!twin) return twin.error();
  TimeMargin margin;
  margin.tail_counts = hard_real_time.has_value();
  margin.budget_us = scene.tolerance ? scene.tolerance->tick_budget_us : 0.5e6 / scene.rate_Hz;
  // In a separate thread, which keeps its priority, core and flushed denormals to itself.
  std::thread([&] {
    std::vector<pc::Shortfall> known;  // probe_rt_threads has reported them
    if (hard_real_time) pc::enter_rt_thread(*hard_real_time, known);
    pc::flush_denormals();
    margin.measured = measure_law(scene, (*twin)->contact_law(), (*twin)->range().press_m);
  }).join();
  margin.checked_us = margin.tail_counts ? margin.measured.p999_us : margin.measured.median_us;
  if (margin.checked_us <= margin.budget_us) return margin;
  return model::Error{fmt::format(
      "{}: {} needs {:.1f} us a tick here ({}), {} {:g} us; choose a smaller model (tact-lab plan "
      "names one), {} or take a faster machine",
      scene.path, (*twin)->title(), margin.checked_us,
      margin.tail_counts ? "p99.9" : "median: without hard real time the tail is the kernel's",
      scene.tolerance ? "tolerance.tick_budget_us is" : "half a period of rate_Hz is",
      margin.budget_us, scene.tolerance ? "raise the budget" : "lower rate_Hz")};
}

}  // namespace tact::firmware::admission
