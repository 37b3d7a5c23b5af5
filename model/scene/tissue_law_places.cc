// SPDX-License-Identifier: Apache-2.0
// A curve laid over the surface: one everywhere, or one for each place.
#include <algorithm>
#include <cmath>

#include "model/contact/fair_surface.h"
#include "model/indent/large_strain_law.h"
#include "model/law/law_bounds.h"
#include "model/law/series_law.h"
#include "model/law/tabulated_law.h"
#include "model/scene/tissue_law_builder.h"
#include "model/scene/tissue_map.h"
#include "model/tissue/compliance_family.h"
#include "model/tissue/indentation_tilt.h"
#include "model/tissue/vertex_compliance.h"

namespace tact::model::scene {
namespace {

// A place over the tip's law alone: what devices can render, and more than any 2 mm from the held
// side.
constexpr double kStiffestTip_ratio = 1.5;

/// NaN is the stiffest of all, so that what must bound it refuses it.
double stiffer_N_per_m(double a, double b) { return a >= b || std::isnan(a) ? a : b; }

}  // namespace

/// One law everywhere, or in series with the compliance of each place.
TissueLawBuilder::Step TissueLawBuilder::finish_curve(const law::Law& curve) {
  if (scene_.varies_by_place)
    return scene_.compliance.large_strain ? enlarge_strain(curve) : vary_by_place(curve);
  law_->curves_.push_back(&curve);
  if (draws_tissue_) return finish_field();
  auto shape = indent::half_space_under(scene_.tool.spheres[0].radius_m, curve.range().press_m);
  if (!shape) return blame(shape.error());
  return finish_field(&keep(std::move(*shape)));
}

// The law is the tip's own indentation, the same everywhere; each curve of the family adds its
// compliance, which is one of small strain.
TissueLawBuilder::Step TissueLawBuilder::vary_by_place(const law::Law& curve) {
  auto family = read_scene_family(scene_);
  if (!family) return family.error();
  const law::LawRange range = curve.range();
  const double least_m_per_N =
      (1.0 / kStiffestTip_ratio - 1.0) / law::stiffest_N_per_m(curve, range.pull_m, range.press_m);
  for (indent::ComplianceCurve& of_family : family->curve) {
    const indent::ComplianceCurve& place = keep(std::move(of_family));
    const double compliance_m_per_N = std::max(place.regular_m_per_N(), least_m_per_N);
    auto series = make_series_law(curve, compliance_m_per_N, place);
    if (!series) return blame(series.error());
    auto table = tabulate(keep(std::move(*series)), scene_.table_knots);
    if (!table) return blame(table.error());
    law_->memory_bytes_ += table->memory_bytes();
    law_->curves_.push_back(&keep(std::move(*table)));
  }
  law_->title_ += ", in series with the organ";
  law_->press_coordinate_ = std::move(family->press_coordinate);
  law_->pull_coordinate_ = std::move(family->pull_coordinate);
  law_->curve_rings_times_E_per_m_ = std::move(family->ring_times_E_per_m);
  return finish_field();
}

// The tip's indentation and the organ's bending are both of large strain.
TissueLawBuilder::Step TissueLawBuilder::enlarge_strain(const law::Law& curve) {
  if (is_measured_) return bend(curve, curve.range().press_m);
  const auto tip_radius_m = scene_tip_radius_m(scene_);
  if (!tip_radius_m) return blame(tip_radius_m.error());
  if (auto map = read_scene_map(scene_); !map) return map.error();
  auto large =
      indent::make_large_strain_law(curve,
                                    {.youngs_modulus_Pa = scene_.elastic->youngs_modulus_Pa,
                                     .poisson_ratio = scene_.elastic->poisson_ratio,
                                     .radius_m = *tip_radius_m},
                                    scene_.table_knots);
  if (!large) return blame(large.error());
  law_->memory_bytes_ += large->memory_bytes();
  return bend(keep(std::move(*large)), curve.range().press_m);
}

// The law is the tip's own indentation; the organ moves with its compliance, by finite rotations.
TissueLawBuilder::Step TissueLawBuilder::bend(const law::Law& curve, double organ_range_m) {
  const auto tip_radius_m = scene_tip_radius_m(scene_);
  if (!tip_radius_m) return blame(tip_radius_m.error());
  auto map = read_scene_map(scene_);
  if (!map) return map.error();
  const ElasticSettings& elastic = *scene_.elastic;
  const indent::ElasticTip ball{.youngs_modulus_Pa = elastic.youngs_modulus_Pa,
                                .poisson_ratio = elastic.poisson_ratio,
                                .radius_m = *tip_radius_m};
  const law::LawRange range = curve.range();
  const double stiffest_N_per_m = law::stiffest_N_per_m(curve, range.pull_m, range.press_m);
  const contact::SurfaceView surface = scene_.organ_mesh.view();
  const double modulus_Pa = elastic.youngs_modulus_Pa,
               held_N_per_m = ball.sideways_stiffness_N_per_m();
  law_->corner_ = contact::fair_corners(surface);
  law_->compliance_ = tissue::vertex_compliance(
      *map, surface, law_->corner_,
      {.min_normal_times_E_per_m = (1.0 / kStiffestTip_ratio - 1.0) * modulus_Pa / stiffest_N_per_m,
       .min_sideways_times_E_per_m =
           (1.0 / contact::kMaxStiffness_ratio - 1.0) * modulus_Pa / held_N_per_m});
  auto relaxation = make_relaxation(scene_.relaxation, 1.0 / scene_.rate_Hz);
  if (!relaxation) return blame(relaxation.error());
  law_->organ_ = {.surface = {surface, law_->corner_, law_->compliance_, modulus_Pa},
                  .contact_modulus_Pa = ball.contact_modulus_Pa(),
                  .poisson_ratio = elastic.poisson_ratio,
                  .held_N_per_m = held_N_per_m,
                  .range_m = organ_range_m,
                  .creep = law::Creep(*relaxation)};
  law_->title_ += ", on an organ that bends";
  law_->curves_.push_back(&curve);
  law_->memory_bytes_ += law_->corner_.size() * sizeof(contact::SurfaceCorner) +
                         law_->compliance_.size() * sizeof(contact::VertexCompliance);
  auto shape =
      indent::half_space_under(*tip_radius_m, range.press_m, map->ring_pitch_m, map->rings);
  if (!shape) return blame(shape.error());
  return finish_field(&keep(std::move(*shape)));
}

TissueLawBuilder::Step TissueLawBuilder::finish_field(const law::Law* shape) {
  auto relaxation = make_relaxation(scene_.relaxation, 1.0 / scene_.rate_Hz);
  if (!relaxation) return blame(relaxation.error());
  law_->memory_bytes_ +=
      (law_->press_coordinate_.size() + law_->pull_coordinate_.size()) * sizeof(float);
  // Before the field is made: it asks whether a curve damps.
  for (const law::Law* curve : law_->curves_) measure(*curve);
  if (law_->organ_) {
    law_->press_stiffness_N_per_m_ *= kStiffestTip_ratio;
    law_->pull_stiffness_N_per_m_ *= kStiffestTip_ratio;
  }
  law_->range_ = law_->curve()->range();
  law_->contact_law_ = std::make_unique<tissue::ElasticField>(
      tissue::ElasticFieldParts{.curves = law_->curves_,
                                .coordinate = law_->press_coordinate_,
                                .pull_coordinate = law_->pull_coordinate_,
                                .surface = scene_.organ_mesh.view(),
                                .relaxation = *relaxation,
                                .neighbours = neighbours(),
                                .curve_ring_times_E_per_m = law_->curve_rings_times_E_per_m_,
                                .damps = law_->damping_Ns_per_m_ > 0.0,
                                .indentation_shape = shape});
  return std::nullopt;
}

// The organ of [elastic], with its map where that belongs to this mesh; else the half-space whose
// force under the tip is the law's own at one radius or at the end of its range.
tissue::ElasticNeighbours TissueLawBuilder::neighbours() {
  tissue::ElasticNeighbours out;
  if (!scene_.elastic) {
    const double radius_m = scene_.tool.spheres[0].radius_m;
    const double depth_m = std::min(radius_m, law_->range_.press_m);
    if (const auto unit = indent::half_space_under(radius_m, depth_m))
      out.contact_modulus_Pa =
          law_->curve()->respond(depth_m).force_N / unit->respond(depth_m).force_N;
    return out;
  }
  const ElasticSettings& elastic = *scene_.elastic;
  out.youngs_modulus_Pa = elastic.youngs_modulus_Pa;
  out.contact_modulus_Pa =
      elastic.youngs_modulus_Pa / (1.0 - elastic.poisson_ratio * elastic.poisson_ratio);
  out.poisson_ratio = elastic.poisson_ratio;
  if (law_->press_coordinate_.empty() && !law_->organ_) return out;  // it knows no place
  auto map = read_scene_map(scene_);
  if (!map) return out;
  if (law_->organ_) {  // MovedContact computes the force: what follows is for telemetry
    law_->regular_times_E_per_m_ = std::move(map->regular_times_E_per_m);
    out.regular_times_E_per_m = law_->regular_times_E_per_m_;
    out.vertex_compliance = law_->compliance_;
  } else {
    // Nothing of the tip is wider: with it S is limited for every sphere.
    const double widest_m =
        std::ranges::max(scene_.tool.spheres, {}, &contact::ProbeSphere::radius_m).radius_m;
    law_->tangent_times_E_per_m_ =
        tissue::tangent_compliance(*map, scene_.organ_mesh.view().vertex_normal, widest_m);
    out.tangent_times_E_per_m = law_->tangent_times_E_per_m_;
    law_->tilt_times_E_per_m2_ = tissue::indentation_tilt(*map, scene_.organ_mesh.view());
    out.tilt_times_E_per_m2 = law_->tilt_times_E_per_m2_;
    law_->memory_bytes_ += map->ring_times_E_per_m.size() * sizeof(float) +
                           law_->tangent_times_E_per_m_.size() * sizeof(tissue::TangentTensors);
  }
  law_->rings_times_E_per_m_ = std::move(map->ring_times_E_per_m);
  out.ring_times_E_per_m = law_->rings_times_E_per_m_;
  out.rings = map->rings;
  out.ring_pitch_m = map->ring_pitch_m;
  return out;
}

// The stiffest curve decides what must be rendered.
void TissueLawBuilder::measure(const law::Law& curve) {
  const law::LawRange range = curve.range();
  law_->press_stiffness_N_per_m_ =
      stiffer_N_per_m(law_->press_stiffness_N_per_m_, stiffest_N_per_m(curve, 0.0, range.press_m));
  law_->damping_Ns_per_m_ = std::max(law_->damping_Ns_per_m_, most_damping_Ns_per_m(curve));
  if (range.pull_m < 0.0) {
    law_->pull_limit_N_ = std::max(law_->pull_limit_N_, -curve.respond(range.pull_m).force_N);
    const double torn_m = tear_depth_m(curve, scene_.contact.tear_force_N);
    law_->pull_stiffness_N_per_m_ =
        stiffer_N_per_m(law_->pull_stiffness_N_per_m_, stiffest_N_per_m(curve, torn_m, 0.0));
  }
}

}  // namespace tact::model::scene
