// SPDX-License-Identifier: Apache-2.0
#include "tools/fit/fit_answer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "model/scene/laws.h"
#include "model/scene/tissue_law.h"

namespace tact::tools::fit {
namespace {

using model::Result;
using model::Vec3;
using model::contact::ContactLaw;
using model::contact::Indentation;

// More than a law of a scene has.
constexpr std::size_t kMaxRings = 128;
constexpr int kMaxTicks = 4000;       // for a body with inertia to come to rest
constexpr int kRestTicks = 25;        // the force is constant for so long
constexpr double kRest_ratio = 1e-6;  // a tick, of the force

Indentation indentation_at(const FitSite& site, const FitSample& sample) {
  Indentation in{.indentation_m = sample.depth_m, .held = sample.depth_m < 0.0};
  if (site.at) in.surface_point = site.at->surface_point, in.normal = site.at->normal;
  return in;
}

double settled_force_N(ContactLaw& law, const Indentation& in) {
  double force_N = 0.0;
  // Still for many ticks: a body that swings is at rest for one tick at its turning points.
  for (int tick = 0, still = 0; tick < kMaxTicks && still < kRestTicks; ++tick) {
    const double now_N = law.respond(in).law.force_N;
    law.advance();
    still = std::abs(now_N - force_N) <= kRest_ratio * std::abs(now_N) ? still + 1 : 0;
    force_N = now_N;
  }
  return force_N;
}

/// `own`: the rings that the law gives, `pitch_m` apart.
void read_profile(std::span<const double> own, double pitch_m, std::span<const double> radius_m,
                  std::vector<double>& ring_m) {
  const std::size_t rings = own.size();
  const auto at = [&](std::size_t j) { return j < rings ? own[j] : 0.0; };
  for (const double r_m : radius_m) {
    // Far out the quotient would not fit the cast; beyond the last ring the shape is 0 anyway.
    const double x = std::min(r_m / pitch_m, static_cast<double>(kMaxRings));
    const auto j = static_cast<std::size_t>(x);
    const double t = x - static_cast<double>(j);
    ring_m.push_back((1.0 - t) * at(j) + t * at(j + 1));
  }
}

/// Vertices within a ring pitch of a radius, the nearer the heavier.
void read_shape(ContactLaw& law, const model::mesh::SurfaceMesh& surface, const Indentation& in,
                std::span<const double> radius_m, std::vector<double>& ring_m) {
  model::contact::PatchShape shape{};
  law.shape(shape);
  Vec3 centre{};
  for (std::size_t i = 0; i < 3; ++i)
    centre += in.surface_point.weight[i] *
              surface.vertex_m[surface.triangle[in.surface_point.triangle][i]];
  for (const double r_m : radius_m) {
    double sum = 0.0, weights = 0.0;
    for (std::uint32_t i = 0; i < shape.node_count; ++i) {
      const double away_m = norm(surface.vertex_m[shape.vertex[i]] - centre);
      // At radius 0 the one vertex that is pressed: a mean with its neighbours would flatten the
      // indentation.
      const double weight = r_m > 0.0 ? 1.0 - std::abs(away_m - r_m) / law.ring_pitch_m()
                                      : (away_m == 0.0 ? 1.0 : 0.0);
      if (!(weight > 0.0)) continue;
      const auto& u = shape.displacement_m[i];
      // Minus: outward is the normal, into the tissue is positive (fit_data.h).
      sum -= weight * dot(Vec3{static_cast<double>(u[0]), static_cast<double>(u[1]),
                               static_cast<double>(u[2])},
                          in.normal);
      weights += weight;
    }
    ring_m.push_back(weights > 0.0 ? sum / weights : std::nan(""));
  }
}

/// A closed form, solved once for every depth.
Result<std::vector<FitAnswer>> solved_answers(const model::law::Law& press,
                                              const model::scene::Scene& scene,
                                              const FitData& data) {
  const model::law::Law* law = &press;
  std::optional<model::law::LinearPull> pulled;
  if (scene.pull) {
    auto made = make_linear_pull(press, *scene.pull);
    if (!made) return made.error();
    law = &pulled.emplace(std::move(*made));
  }
  // Sites of a law without a place share their depths: each is solved once.
  std::map<double, FitAnswer> known;
  std::vector<FitAnswer> out;
  for (const FitSite& site : data.sites) {
    for (const FitSample& sample : site.samples) {
      const auto [at, is_new] = known.try_emplace(sample.depth_m);
      FitAnswer& answer = at->second;
      if (is_new) answer.force_N = law->respond(sample.depth_m).force_N;
      if (answer.ring_m.empty() && !sample.ring_m.empty()) {
        std::array<double, kMaxRings> own{};
        const std::size_t rings = std::min(law->profile(sample.depth_m, own), kMaxRings);
        read_profile({own.data(), rings}, law->ring_pitch_m(), data.ring_radius_m, answer.ring_m);
      }
      out.push_back(answer);
    }
  }
  return out;
}

}  // namespace

Result<std::vector<FitAnswer>> answers_of(const model::scene::Scene& scene,
                                          std::string_view law_name, const FitData& data,
                                          AnswerBy by) {
  const model::scene::LawRow* row = model::scene::find_law(law_name);
  // Not in series with an organ: there tables take less time, and the place shows in the shape.
  const bool is_one_curve = row && row->curve && !scene.varies_by_place && !scene.exact_tip;
  if (by == AnswerBy::kSolving && is_one_curve) {
    const auto curve = row->curve(scene);
    return curve ? solved_answers(*curve->law, scene, data) : curve.error();
  }
  auto made = make_tissue_law(scene, law_name);
  if (!made) return made.error();
  ContactLaw& law = (*made)->contact_law();
  const bool is_stepped = (*made)->curve() == nullptr;
  // Springs in a row are drawn as a half-space; their parameters show in their own displacements.
  const model::law::Law* springs = is_one_curve ? (*made)->curve() : nullptr;
  std::vector<FitAnswer> out;
  for (const FitSite& site : data.sites) {
    for (const FitSample& sample : site.samples) {
      const Indentation in = indentation_at(site, sample);
      FitAnswer& answer = out.emplace_back();
      // From rest: what the sample before left behind must not act on this one.
      law.leave(0);
      law.advance();
      answer.force_N = is_stepped ? settled_force_N(law, in) : law.respond(in).law.force_N;
      if (sample.ring_m.empty()) continue;
      if (is_stepped) {
        read_shape(law, scene.organ_mesh, in, data.ring_radius_m, answer.ring_m);
      } else {
        std::array<double, kMaxRings> own{};
        const std::size_t rings =
            springs != nullptr ? springs->profile(in.indentation_m, own) : law.profile(in, own);
        const double pitch_m = springs != nullptr ? springs->ring_pitch_m() : law.ring_pitch_m();
        read_profile({own.data(), std::min(rings, kMaxRings)}, pitch_m, data.ring_radius_m,
                     answer.ring_m);
      }
    }
  }
  return out;
}

}  // namespace tact::tools::fit
