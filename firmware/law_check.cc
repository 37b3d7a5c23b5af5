#include "firmware/law_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "firmware/clock.h"

namespace tact::firmware {
namespace {

constexpr std::size_t kBatches = 101;
constexpr std::size_t kTicksInBatch = 20;

}  // namespace

std::optional<model::Error> check_renderable(const model::Scene& scene, const model::Tissue& tissue,
                                             const hal::DeviceInfo& device) {
  const auto spheres = static_cast<double>(scene.tool.spheres.size());
  const double one_N_per_m =
      std::max(tissue.law().stiffness_N_per_m(), scene.contact.sliding_stiffness_N_per_m);
  const auto problem = model::check_stiffness(device.at_tool, scene.rate_Hz, spheres * one_N_per_m);
  if (!problem) return std::nullopt;
  return model::Error{fmt::format("{}: {} spheres of up to {:.3g} N/m each: {}", scene.path,
                                  scene.tool.spheres.size(), one_N_per_m, problem->sentence)};
}

double measure_law_us(const model::Scene& scene, const model::TissueLaw& twin) {
  model::SiteLaw& law = twin.site_law();
  const double deepest_m = twin.range().press_m;
  const std::size_t spheres = scene.tool.spheres.size();
  const auto triangles = scene.organ_mesh.triangle.size();
  MonotonicClock clock;
  std::vector<double> batch_us;
  double unused_N = 0.0;
  for (std::size_t batch = 0; batch < kBatches; ++batch) {
    const std::int64_t start_ns = clock.now_ns();
    for (std::size_t tick = 0; tick < kTicksInBatch; ++tick) {
      const double wave = std::sin(0.02 * static_cast<double>(batch * kTicksInBatch + tick));
      for (std::size_t i = 0; i < spheres; ++i) {
        const auto triangle = static_cast<std::uint32_t>((triangles * i) / spheres);
        unused_N += law.respond({.sphere = i,
                                 .place = {.triangle = triangle, .weight = {0.4, 0.3, 0.3}},
                                 .normal = scene.organ_mesh.face_normal[triangle],
                                 .depth_m = 0.25 * deepest_m * (1.0 + wave)})
                        .law.force_N;
      }
      law.advance();
    }
    const auto spent_ns = static_cast<double>(clock.now_ns() - start_ns);
    batch_us.push_back(1e-3 * spent_ns / static_cast<double>(kTicksInBatch));
  }
  std::nth_element(batch_us.begin(), batch_us.begin() + kBatches / 2, batch_us.end());
  return std::isfinite(unused_N) ? batch_us[kBatches / 2] : std::numeric_limits<double>::infinity();
}

std::optional<model::Error> check_budget(const model::Scene& scene) {
  if (!scene.tolerance) return std::nullopt;
  const auto twin = model::make_tissue_law(scene, scene.law);
  if (!twin) return twin.error();
  const double budget_us = scene.tolerance->tick_budget_us;
  const double median_us = measure_law_us(scene, **twin);
  if (median_us <= budget_us) return std::nullopt;
  return model::Error{fmt::format(
      "{}: {} needs {:.1f} us a tick here (median), tolerance.tick_budget_us is {:g}; choose a "
      "smaller model (tact-plan names one), raise the budget or take a faster machine",
      scene.path, (*twin)->title(), median_us, budget_us)};
}

std::optional<model::Error> check_law(const model::Scene& scene, const model::Tissue& tissue,
                                      const hal::DeviceInfo& device) {
  if (auto problem = check_renderable(scene, tissue, device)) return problem;
  return check_budget(scene);
}

}  // namespace tact::firmware
