// SPDX-License-Identifier: Apache-2.0
#include "firmware/run/law_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <thread>
#include <vector>

#include "firmware/loop/clock.h"
#include "model/indent/compliance_law.h"
#include "model/indent/inertia.h"
#include "model/law/haptic_limit.h"
#include "model/scene/scene_strokes.h"

namespace tact::firmware::run {
namespace {

using model::Error;
using model::Result;
using model::Vec3;

constexpr std::size_t kTurnTicks = 500;   // one turn of the circle
constexpr std::size_t kMostTicks = 4000;  // enough for a p99.9
constexpr std::int64_t kLongest_ns = 150'000'000;
constexpr double kCircleEdges = 5.0;  // radius: further than a patch bears before it gathers anew

/// One turn about the middle of a triangle, in its plane, each point brought to the surface.
std::vector<model::contact::Site> circle(const model::mesh::SurfaceMesh& mesh,
                                         std::uint32_t start) {
  const auto& corner = mesh.triangle[start];
  const Vec3 a_m = mesh.vertex_m[corner[0]], b_m = mesh.vertex_m[corner[1]];
  const Vec3 middle_m = (1.0 / 3.0) * (a_m + b_m + mesh.vertex_m[corner[2]]);
  const Vec3 along = normalized(b_m - a_m);
  const Vec3 across = cross(mesh.face_normal[start], along);
  const double radius_m = kCircleEdges * norm(b_m - a_m);
  std::vector<model::contact::Site> way;
  std::uint32_t triangle = start;
  for (std::size_t i = 0; i < kTurnTicks; ++i) {
    const double angle_rad =
        2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(kTurnTicks);
    const Vec3 p_m =
        middle_m + radius_m * (std::cos(angle_rad) * along + std::sin(angle_rad) * across);
    way.push_back(follow(mesh.view(), triangle, p_m));
    triangle = way.back().place.triangle;
  }
  return way;
}

/// Where the blade stands when the tool touches there: it cuts nothing, but must be looked at.
model::contact::BladeSweep still(const model::contact::Blade& blade, const Vec3& tool_m) {
  const Vec3 a_m = tool_m + blade.a_m, b_m = tool_m + blade.b_m;
  return {.from_a_m = a_m, .from_b_m = b_m, .to_a_m = a_m, .to_b_m = b_m};
}

double at_share(const std::vector<double>& ascending, double share) {
  const auto last = static_cast<double>(ascending.size() - 1);
  return ascending[static_cast<std::size_t>(std::ceil(share * last))];
}

/// The key or section to change when the law is too stiff.
std::string stiff_key(const model::scene::Scene& scene, const model::scene::TissueLaw& law) {
  if (scene.law == model::scene::LawKind::kCompliance) return "elastic.youngs_modulus_Pa";
  if (scene.pull && law.pull_is_stiffer()) return "pull.stiffness_N_per_m";
  return fmt::format("[{}]", model::scene::name_of(scene.law));
}

/// Never above it, so that the number printed is one that is accepted.
double rounded_down(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 3.0);
  return value > 0.0 ? unit * std::floor(value / unit) : 0.0;
}

std::string spheres_in_words(std::size_t n) {
  return n == 1 ? "1 sphere" : fmt::format("{} spheres", n);
}

// Of a held sphere at the stiffest place; 0: the law does not tell.
double stiffest_sideways_N_per_m(const model::scene::Scene& scene,
                                 const model::contact::SiteLaw& law) {
  if (scene.contact.sliding_stiffness_N_per_m > 0.0) return scene.contact.sliding_stiffness_N_per_m;
  double most_N_per_m = 0.0;
  for (std::uint32_t t = 0; t < scene.organ_mesh.triangle.size(); ++t)
    for (const model::contact::ProbeSphere& sphere : scene.tool.spheres) {
      const double give_m_per_N =
          law.give_along({.triangle = t, .weight = {1.0, 0.0, 0.0}}, true,
                         model::contact::axes_of(scene.organ_mesh.face_normal[t]))
              .at(sphere.radius_m)
              .least_eigenvalue();
      if (give_m_per_N > 0.0) most_N_per_m = std::max(most_N_per_m, 1.0 / give_m_per_N);
    }
  return most_N_per_m;
}

/// The organ as a half-space under the first sphere: that of [elastic], or the incompressible one
/// whose force at a depth of one radius is the law's.
std::optional<model::indent::ElasticTip> half_space_of(const model::scene::Scene& scene,
                                                       const model::scene::TissueLaw& law) {
  const double radius_m = scene.tool.spheres[0].radius_m;
  if (scene.elastic)
    return model::indent::ElasticTip{.youngs_modulus_Pa = scene.elastic->youngs_modulus_Pa,
                                     .poisson_ratio = scene.elastic->poisson_ratio,
                                     .radius_m = radius_m};
  const double depth_m = std::min(radius_m, law.range().press_m);
  const auto unit = model::indent::half_space_under(radius_m, depth_m);
  if (!unit) return std::nullopt;
  constexpr double kIncompressible = 0.5;
  return model::indent::ElasticTip{.youngs_modulus_Pa = (1.0 - kIncompressible * kIncompressible) *
                                                        law.curve()->respond(depth_m).force_N /
                                                        unit->respond(depth_m).force_N,
                                   .poisson_ratio = kIncompressible,
                                   .radius_m = radius_m};
}

struct Press {
  double depth_m = 0.0;  // of the lowest sphere below the touched point
  double speed_mps = 0.0;
  double limit_mps = 0.0;  // IN-2
};

/// Where the hand's path is fastest against that limit: the slope of a minimum-jerk move is
/// 30 s^2 (1 - s)^2 of its mean, at most 15/8.
Press fastest_press(const model::scene::Scene& scene, const model::indent::ElasticTip& tip,
                    double share) {
  constexpr int kSamples = 100;
  const double least_m = 0.25 * tip.radius_m;  // lighter touches are hardly felt
  const double reach_m = model::scene::reach_m(scene.tool.spheres, scene.hand_inward);
  Press worst{.limit_mps = std::numeric_limits<double>::infinity()};
  for (std::size_t i = 1; i < scene.hand.path.size(); ++i) {
    const auto &from = scene.hand.path[i - 1], &to = scene.hand.path[i];
    const double start_m = dot(from.position_m - scene.hand_site_m, scene.hand_inward) + reach_m;
    const double way_m = dot(to.position_m - from.position_m, scene.hand_inward);
    for (int k = 1; k < kSamples && way_m > 0.0; ++k) {
      const double s = static_cast<double>(k) / kSamples, rest = 1.0 - s;
      Press at{.depth_m = start_m + way_m * s * s * s * (10.0 + s * (-15.0 + 6.0 * s)),
               .speed_mps = 30.0 * s * s * rest * rest * way_m / (to.time_s - from.time_s)};
      if (at.depth_m < least_m) continue;
      at.limit_mps = model::indent::inertia_speed_mps(tip, at.depth_m, share);
      if (at.speed_mps * worst.limit_mps > worst.speed_mps * at.limit_mps) worst = at;
    }
  }
  return worst;
}

}  // namespace

Result<StiffnessMargin> check_renderable(const model::scene::Scene& scene,
                                         const model::scene::Tissue& tissue,
                                         const hal::DeviceInfo& device) {
  if (!device.at_tool)
    return Error{fmt::format(
        "device {} does not tell its damping at the tool: fill DeviceInfo::at_tool", device.name)};
  const std::size_t spheres = scene.tool.spheres.size();
  const double law_N_per_m = tissue.law().stiffness_N_per_m();
  const double sliding_N_per_m = stiffest_sideways_N_per_m(scene, tissue.law().site_law());
  const double damping_Ns_per_m = tissue.law().damping_Ns_per_m();
  const auto limit_with = [&](double all_Ns_per_m) {
    return model::law::haptic_limit(*device.at_tool, scene.rate_Hz, all_Ns_per_m).grow_N_per_m;
  };
  const double limit_N_per_m = limit_with(static_cast<double>(spheres) * damping_Ns_per_m);
  const double needed_N_per_m =
      static_cast<double>(spheres) * std::max(law_N_per_m, sliding_N_per_m);
  const auto fits = [&](double one_N_per_m) {  // NaN does not
    return static_cast<double>(spheres) * one_N_per_m <= limit_N_per_m;
  };
  if (fits(law_N_per_m) && fits(sliding_N_per_m))
    return StiffnessMargin{.needed_N_per_m = needed_N_per_m, .limit_N_per_m = limit_N_per_m};
  const double undamped_N_per_m = limit_with(0.0);
  if (damping_Ns_per_m > 0.0 && needed_N_per_m <= undamped_N_per_m)
    // HL-1: B <= b - K (T/2 + t_d)
    return Error{fmt::format(
        "{}: law {} damps too much: {:.4g} N s/m on {}, where this device has {:.4g} N s/m of its "
        "own and {:.4g} N/m to show at {:g} Hz; lower the damping of [{}] to {:.4g} N s/m or less",
        scene.path, model::scene::name_of(scene.law), damping_Ns_per_m, spheres_in_words(spheres),
        device.at_tool->damping_Ns_per_m, needed_N_per_m, scene.rate_Hz,
        model::scene::name_of(scene.law),
        rounded_down(device.at_tool->damping_Ns_per_m * (1.0 - needed_N_per_m / undamped_N_per_m) /
                     static_cast<double>(spheres)))};
  const bool is_law = !(law_N_per_m < sliding_N_per_m);  // the stiffer one; NaN is the law's
  const std::string what = is_law ? fmt::format("law {}", model::scene::name_of(scene.law))
                                  : std::string("contact.sliding_stiffness_N_per_m");
  const double one_N_per_m = is_law ? law_N_per_m : sliding_N_per_m;
  return Error{fmt::format(
      "{}: {} is too stiff: {:.4g} N/m on {} is {:.4g} N/m, this device is stable to {:.4g} N/m at "
      "{:g} Hz; {} to {:.4g} N/m or less, raise rate_Hz{}",
      scene.path, what, one_N_per_m, spheres_in_words(spheres),
      static_cast<double>(spheres) * one_N_per_m, limit_N_per_m, scene.rate_Hz,
      is_law ? "soften " + stiff_key(scene, tissue.law()) : "lower it",
      rounded_down(limit_N_per_m / static_cast<double>(spheres)),
      device.damping_key.empty() ? std::string(", or take a device with more damping")
                                 : fmt::format(", or raise {}", device.damping_key))};
}

LawTime measure_law(const model::scene::Scene& scene, model::contact::SiteLaw& twin,
                    double deepest_m) {
  const std::size_t spheres = scene.tool.spheres.size();
  const std::size_t triangles = scene.organ_mesh.triangle.size();
  std::vector<std::vector<model::contact::Site>> ways;
  ways.reserve(spheres);
  for (std::size_t i = 0; i < spheres; ++i)
    ways.push_back(circle(scene.organ_mesh, static_cast<std::uint32_t>((triangles * i) / spheres)));
  loop::MonotonicClock clock;
  std::vector<double> tick_us;
  tick_us.reserve(kMostTicks);
  double unused_N = 0.0;
  const std::int64_t begin_ns = clock.now_ns();
  for (std::int64_t start_ns = begin_ns, end_ns = begin_ns;
       tick_us.size() < kMostTicks && start_ns - begin_ns < kLongest_ns; start_ns = end_ns) {
    const std::size_t tick = tick_us.size();
    const double wave = std::sin(0.02 * static_cast<double>(tick));
    for (std::size_t i = 0; i < spheres; ++i) {
      const model::contact::Site& site = ways[i][tick % kTurnTicks];
      unused_N += twin.respond({.sphere = i,
                                .place = site.place,
                                .normal = site.normal,
                                .depth_m = 0.25 * deepest_m * (1.0 + wave)})
                      .law.force_N;
    }
    if (scene.tool.blade) twin.cut(still(*scene.tool.blade, ways[0][tick % kTurnTicks].point_m));
    twin.advance();
    end_ns = clock.now_ns();
    tick_us.push_back(1e-3 * static_cast<double>(end_ns - start_ns));
  }
  constexpr double kNever = std::numeric_limits<double>::infinity();
  if (!std::isfinite(unused_N)) return {.median_us = kNever, .p999_us = kNever};
  std::sort(tick_us.begin(), tick_us.end());
  return {.median_us = at_share(tick_us, 0.5), .p999_us = at_share(tick_us, 0.999)};
}

Result<TimeMargin> check_budget(const model::scene::Scene& scene,
                                const std::optional<pc::RtSettings>& hard_real_time) {
  const auto twin = model::scene::make_tissue_law(scene, scene.law);
  if (!twin) return twin.error();
  TimeMargin margin;
  margin.tail_counts = hard_real_time.has_value();
  margin.budget_us = scene.tolerance ? scene.tolerance->tick_budget_us : 0.5e6 / scene.rate_Hz;
  std::thread([&] {
    std::vector<pc::Shortfall> known;
    if (hard_real_time) enter_rt_thread(*hard_real_time, known);
    pc::flush_denormals();
    margin.measured = measure_law(scene, (*twin)->site_law(), (*twin)->range().press_m);
  }).join();
  margin.judged_us = margin.tail_counts ? margin.measured.p999_us : margin.measured.median_us;
  if (margin.judged_us <= margin.budget_us) return margin;
  return Error{fmt::format(
      "{}: {} needs {:.1f} us a tick here ({}), {} {:g} us; choose a smaller model (tact-plan "
      "names one), {} or take a faster machine",
      scene.path, (*twin)->title(), margin.judged_us,
      margin.tail_counts ? "p99.9" : "median: without hard real time the tail is the kernel's",
      scene.tolerance ? "tolerance.tick_budget_us is" : "half a period of rate_Hz is",
      margin.budget_us, scene.tolerance ? "raise the budget" : "lower rate_Hz")};
}

std::string inertia_note(const model::scene::Scene& scene, const model::scene::TissueLaw& law) {
  constexpr double kFelt = 0.07;  // of a force: the least difference that people notice
  if (law.curve() == nullptr) return {};
  const auto tip = half_space_of(scene, law);
  if (!tip) return {};
  const Press press = fastest_press(scene, *tip, kFelt);
  if (!(press.speed_mps > press.limit_mps)) return {};
  return fmt::format(
      "{}: a stroke of the hand presses with {:.0f} mm/s at a depth of {:.1f} mm; from {:.0f} mm/s "
      "on the inertia of tissue, which this law leaves out, is more than {:.0f} % of the force "
      "there: give the stroke more time, or expect less force than tissue has",
      scene.path, 1e3 * press.speed_mps, 1e3 * press.depth_m, 1e3 * press.limit_mps, 100.0 * kFelt);
}

}  // namespace tact::firmware::run
