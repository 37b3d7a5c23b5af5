// SPDX-License-Identifier: Apache-2.0
#include "firmware/admission/stiffness_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "model/law/haptic_limit.h"
#include "model/scene/laws.h"

namespace tact::firmware::admission {
namespace {

using model::Error;

/// Rounds down, so that a printed limit is itself accepted.
double rounded_down(double value) {
  // Four digits, as {:.4g} prints them; a number of four digits stays, for any last bit.
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 3.0);
  return value > 0.0 ? unit * std::floor(value / unit * (1.0 + 1e-12)) : 0.0;
}

/// "a = 3" with each key times `ratio`, so that a scene that says so is taken.
std::string times_text(const model::scene::Scene& scene, std::string_view section,
                       std::span<const std::string_view> keys, double ratio) {
  model::scene::Scene changed = scene;  // its laws' numbers are asked by pointers
  const model::ParameterList list =
      model::scene::parameters_of(*model::scene::find_law(section), changed);
  std::string text;
  for (const std::string_view key : keys)
    text += fmt::format("{}{}.{} = {:.4g}", text.empty() ? "" : " and ", section, key,
                        rounded_down(ratio * list.find(key).value()));
  return text;
}

/// What to write where the law is 1 / `ratio` times too stiff: all that its force is proportional
/// to.
std::string softer_text(const model::scene::Scene& scene, bool is_pull, double ratio) {
  const model::scene::LawRow& row = *model::scene::find_law(scene.law);
  if (scene.pull && row.curve != nullptr && is_pull)
    return fmt::format("pull.stiffness_N_per_m = {:.4g}",
                       rounded_down(ratio * scene.pull->stiffness_N_per_m));
  std::string text = times_text(scene, scene.law, row.stiffness_keys, ratio);
  if (scene.elastic && (text.empty() || scene.varies_by_place))
    text += fmt::format("{}elastic.youngs_modulus_Pa = {:.4g}", text.empty() ? "" : " and ",
                        rounded_down(ratio * scene.elastic->youngs_modulus_Pa));
  if (scene.elastic && !scene.elastic->inclusions.empty())
    text += fmt::format(" and {:.3g} times each elastic.inclusion.youngs_modulus_Pa", ratio);
  // Its own pull stiffens up to there.
  if (row.curve != nullptr && is_pull)
    text += fmt::format(" and contact.tear_force_N = {:.4g}",
                        rounded_down(ratio * scene.contact.tear_force_N));
  return text;
}

/// HL-1: the rate from which on the device can render so much; empty where no rate is enough.
std::string rate_text(const hal::DeviceInfo& device, double damping_Ns_per_m,
                      double needed_N_per_m) {
  const double period_s =
      2.0 * ((device.at_tool->damping_Ns_per_m - damping_Ns_per_m) / needed_N_per_m -
             device.at_tool->delay_s);
  const double step_Hz = 100.0, rate_Hz = step_Hz * std::ceil((1.0 + 1e-9) / (period_s * step_Hz));
  const bool is_one = period_s > 0.0 && rate_Hz <= model::scene::kRate_Hz.high;
  return is_one ? fmt::format(", or rate_Hz = {:g}", rate_Hz) : std::string();
}

std::string device_text(const hal::DeviceInfo& device) {
  return fmt::format(
      "a device with more damping shows more{}, device.kind = \"sim-ideal\" shows it as no real "
      "one "
      "can",
      device.damping_key.empty() ? std::string()
                                 : fmt::format(" ({} says what this one has)", device.damping_key));
}

std::string spheres_text(std::size_t n) {
  return n == 1 ? "1 sphere" : fmt::format("{} spheres", n);
}

// Lateral stiffness of a held sphere at the stiffest point; 0: the law does not define it.
double stiffest_sideways_N_per_m(const model::scene::Scene& scene,
                                 const model::contact::ContactLaw& law) {
  // A value set in the scene replaces the tissue's own (contact/contact_scene.h).
  if (scene.contact.sliding_stiffness_N_per_m > 0.0) return scene.contact.sliding_stiffness_N_per_m;
  double most_N_per_m = 0.0;
  const auto visit_point = [&](const model::contact::SurfacePoint& point,
                               const model::contact::Axes& axes) {
    const model::contact::TangentCompliance compliance = law.tangent_compliance(point, true, axes);
    for (const model::contact::ProbeSphere& sphere : scene.tool.spheres) {
      const double compliance_m_per_N = compliance.at(sphere.radius_m).least_eigenvalue();
      if (compliance_m_per_N > 0.0) most_N_per_m = std::max(most_N_per_m, 1.0 / compliance_m_per_N);
    }
  };
  // At every vertex, from every triangle that meets there: in between, the compliance is a mean.
  for (std::uint32_t t = 0; t < scene.organ_mesh.triangle.size(); ++t) {
    const model::contact::Axes axes = model::contact::axes_of(scene.organ_mesh.face_normal[t]);
    for (std::size_t corner = 0; corner < 3; ++corner) {
      model::contact::SurfacePoint point{.triangle = t, .weight = {}};
      point.weight[corner] = 1.0;
      visit_point(point, axes);
    }
  }
  return most_N_per_m;
}

/// What the scene requires, and the most that the device can render, for all spheres together.
struct Demand {
  double law_N_per_m, sliding_N_per_m;  // of one sphere
  double damping_Ns_per_m;              // of one sphere
  double spheres;
  double limit_N_per_m, undamped_limit_N_per_m;

  double needed_N_per_m() const { return spheres * std::max(law_N_per_m, sliding_N_per_m); }
  bool fits(double one_N_per_m) const { return spheres * one_N_per_m <= limit_N_per_m; }  // no NaN
};

// HL-1: B <= b - K (T/2 + t_d)
Error damps_too_much(const model::scene::Scene& scene, const Demand& demand, double own_Ns_per_m) {
  const double needed_N_per_m = demand.needed_N_per_m();
  const double ratio = own_Ns_per_m * (1.0 - needed_N_per_m / demand.undamped_limit_N_per_m) /
                       demand.spheres / demand.damping_Ns_per_m;
  return Error{fmt::format(
      "{}: law {} damps too much: {:.4g} N s/m on {}, where this device has {:.4g} N s/m of its "
      "own and {:.4g} N/m to show at {:g} Hz; write {} or less",
      scene.path, scene.law, demand.damping_Ns_per_m, spheres_text(scene.tool.spheres.size()),
      own_Ns_per_m, needed_N_per_m, scene.rate_Hz,
      times_text(scene, scene.law, {{model::scene::find_law(scene.law)->damping_key}}, ratio))};
}

/// Names the spring that is too stiff, and the value to write.
Error too_stiff(const model::scene::Scene& scene, const model::scene::TissueLaw& law,
                const Demand& demand, const hal::DeviceInfo& device) {
  const bool is_law =
      !(demand.law_N_per_m < demand.sliding_N_per_m);  // the stiffer one; a NaN selects the law
  const bool is_set = scene.contact.sliding_stiffness_N_per_m > 0.0;
  const std::string what = is_law   ? fmt::format("law {}", scene.law)
                           : is_set ? std::string("contact.sliding_stiffness_N_per_m")
                                    : std::string("the tissue, held and pulled along its surface,");
  const double one_N_per_m = is_law ? demand.law_N_per_m : demand.sliding_N_per_m;
  const double allowed_N_per_m = demand.limit_N_per_m / demand.spheres;
  const std::string remedy =
      is_law ? softer_text(scene, law.pull_is_stiffer(), allowed_N_per_m / one_N_per_m)
             : fmt::format("contact.sliding_stiffness_N_per_m = {:.4g}",
                           rounded_down(allowed_N_per_m));
  return Error{fmt::format(
      "{}: {} is too stiff: {:.4g} N/m on {} is {:.4g} N/m, this device is stable to {:.4g} N/m at "
      "{:g} Hz; {}; write {} or less{}",
      scene.path, what, one_N_per_m, spheres_text(scene.tool.spheres.size()),
      demand.spheres * one_N_per_m, demand.limit_N_per_m, scene.rate_Hz, device_text(device),
      remedy,
      rate_text(device, demand.spheres * demand.damping_Ns_per_m, demand.needed_N_per_m()))};
}

// HL-1. All spheres may be on the stiffest point and damp at once.
double limit_with_N_per_m(const model::scene::Scene& scene, const hal::DeviceInfo& device,
                          double all_Ns_per_m) {
  return model::law::haptic_limit(*device.at_tool, scene.rate_Hz, all_Ns_per_m).grow_N_per_m;
}

constexpr std::size_t kSampled = 16;  // vertices each way; chosen: 50 ms

/// The vertex nearest to where the scene's own hand presses.
model::scene::PressPoint hand_place(const model::scene::Scene& scene) {
  const auto& vertices_m = scene.organ_mesh.vertex_m;
  const auto nearest = std::ranges::min_element(
      vertices_m, {}, [&](const model::Vec3& v) { return norm(v - scene.hand_site_m); });
  return {static_cast<std::uint32_t>(nearest - vertices_m.begin()),
          model::scene::PressWay::kUpright};
}

/// Names a place where the force has a flaw; the remedy concerns the mesh.
std::string note_of(const model::scene::Scene& scene, const model::scene::PressSweep& sweep) {
  const auto flawed = sweep.flawed();
  if (flawed.empty()) return {};
  return fmt::format(
      "{}: {} of {} presses of the whole tool are not sound, the worst at {}: {}; smooth or refine "
      "the organ's mesh there (tact-mesh), or keep the tool from it; tact-lab sweep tries every "
      "vertex",
      scene.path, flawed.size(), sweep.results.size(), name_of(flawed.front()->place),
      describe_flaws(*flawed.front(), sweep.settings));
}

}  // namespace

double stiffness_limit_N_per_m(const model::scene::Scene& scene, const model::scene::TissueLaw& law,
                               const hal::DeviceInfo& device) {
  if (!device.at_tool) return 0.0;
  const auto spheres = static_cast<double>(scene.tool.spheres.size());
  return limit_with_N_per_m(scene, device, spheres * law.damping_Ns_per_m());
}

model::Result<StiffnessMargin> check_renderable(const model::scene::Scene& scene,
                                                const model::scene::Tissue& tissue,
                                                const hal::DeviceInfo& device) {
  // A device that does not report its damping cannot be checked, so it is refused.
  if (!device.at_tool)
    return Error{
        fmt::format("device {} does not report its damping at the tool: fill DeviceInfo::at_tool",
                    device.name)};
  const auto spheres = static_cast<double>(scene.tool.spheres.size());
  const double damping_Ns_per_m = tissue.law().damping_Ns_per_m();
  const Demand demand{
      .law_N_per_m = tissue.law().stiffness_N_per_m(),
      .sliding_N_per_m = stiffest_sideways_N_per_m(scene, tissue.law().contact_law()),
      .damping_Ns_per_m = damping_Ns_per_m,
      .spheres = spheres,
      .limit_N_per_m = stiffness_limit_N_per_m(scene, tissue.law(), device),
      .undamped_limit_N_per_m = limit_with_N_per_m(scene, device, 0.0)};
  const double needed_N_per_m = demand.needed_N_per_m();
  if (demand.fits(demand.law_N_per_m) && demand.fits(demand.sliding_N_per_m))
    return StiffnessMargin{.needed_N_per_m = needed_N_per_m, .limit_N_per_m = demand.limit_N_per_m};
  // Renderable without the law's damping: then the damping must change.
  if (damping_Ns_per_m > 0.0 && needed_N_per_m <= demand.undamped_limit_N_per_m)
    return damps_too_much(scene, demand, device.at_tool->damping_Ns_per_m);
  return too_stiff(scene, tissue.law(), demand, device);
}

model::Result<PressCheck> check_sweep(const model::scene::Scene& scene,
                                      const model::scene::TissueLaw& law,
                                      const hal::DeviceInfo& device,
                                      const model::scene::PressSweep& sweep) {
  const double limit_N_per_m = sweep.settings.limit_N_per_m;
  const model::scene::PressResult& hand = sweep.results.front();
  if (!(hand.slope_N_per_m.value <= limit_N_per_m))  // NaN counts as too stiff
    return Error{fmt::format(
        "{}: the whole tool is too stiff where the hand presses: {:.4g} N/m at {}, {:.3g} mm deep; "
        "this device is stable to {:.4g} N/m at {:g} Hz; {}; write {} or less{}",
        scene.path, hand.slope_N_per_m.value, name_of(hand.place), 1e3 * hand.slope_N_per_m.depth_m,
        limit_N_per_m, scene.rate_Hz, device_text(device),
        softer_text(scene, false, limit_N_per_m / hand.slope_N_per_m.value),
        rate_text(device, static_cast<double>(scene.tool.spheres.size()) * law.damping_Ns_per_m(),
                  hand.slope_N_per_m.value))};
  PressCheck out{.presses = sweep.results.size(), .note = note_of(scene, sweep)};
  if (const model::scene::PressResult* stiffest = sweep.stiffest()) {
    out.slope_N_per_m = stiffest->slope_N_per_m.value;
    out.place = name_of(stiffest->place);
  }
  return out;
}

model::Result<PressCheck> check_presses(const model::scene::Scene& scene,
                                        const model::scene::Tissue& tissue,
                                        const hal::DeviceInfo& device, double limit_N_per_m) {
  const model::scene::TissueLaw& law = tissue.law();
  std::vector<model::scene::PressPoint> places{hand_place(scene)};
  if (law.curve() != nullptr) {
    const auto others = press_points(scene, kSampled, true, true);
    places.insert(places.end(), others.begin(), others.end());
  }
  const auto pressed = tissue_for_check(scene, tissue);
  if (!pressed) return pressed.error();
  const auto sweep = sweep_presses(
      scene, places, {.limit_N_per_m = limit_N_per_m, .checks_energy = false}, {}, pressed->tissue);
  if (!sweep) return sweep.error();
  return check_sweep(scene, law, device, *sweep);
}

}  // namespace tact::firmware::admission
