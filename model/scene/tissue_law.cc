// SPDX-License-Identifier: Apache-2.0
#include "model/scene/tissue_law.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "model/law/series_law.h"
#include "model/law/tabulated_law.h"
#include "model/scene/tissue_law_builder.h"
#include "model/scene/tissue_map.h"
#include "model/springs/spring_patch.h"
#include "model/tissue/compliance_family.h"

namespace tact::model::scene {
namespace {

constexpr double kPastTear_ratio = 1.1;  // so that the tear force lies within the range

}  // namespace

TissueLawBuilder::Step TissueLawBuilder::add_curve(const LawRow& row) {
  auto curve = row.curve(scene_);
  if (!curve) return blame(curve.error());
  law_->title_ = curve->title;
  draws_tissue_ = curve->draws_tissue;
  is_measured_ = curve->is_measured;
  law_->owned_.push_back(std::move(curve->law));
  const law::Law* press = law_->owned_.back().get();
  if (scene_.exact_tip) {
    const auto pair = on_organ(*press);
    if (!pair) return pair.error();
    press = *pair;
    curve->untabled_bytes = 0;
  }
  const auto pulled = with_pull(*press);
  if (!pulled) return pulled.error();
  law_->memory_bytes_ += curve->untabled_bytes;
  if (curve->untabled_bytes > 0) return finish_curve(**pulled);
  auto table = tabulate(**pulled, scene_.table_knots);
  if (!table) return blame(table.error());
  law_->memory_bytes_ += table->memory_bytes();
  return finish_curve(keep(std::move(*table)));
}

/// At large strain the tip's own indentation is a curve, too, on the organ that bends.
TissueLawBuilder::Step TissueLawBuilder::add_compliance() {
  if (!scene_.compliance.large_strain) return add_small_compliance();
  law_->title_ = "elastic compliance, large strain under the tip";
  const auto tip_radius_m = scene_tip_radius_m(scene_);
  if (!tip_radius_m) return blame(tip_radius_m.error());
  if (auto map = read_scene_map(scene_); !map) return map.error();
  const indent::ElasticTip tip{.youngs_modulus_Pa = scene_.elastic->youngs_modulus_Pa,
                               .poisson_ratio = scene_.elastic->poisson_ratio,
                               .radius_m = *tip_radius_m,
                               .large_strain = true};
  // A pull is linear (CL-2). Its range reaches the force that tears, at any place.
  const double torn_m = scene_.contact.tear_force_N / tip.pulled_stiffness_N_per_m();
  const double working_depth_m = scene_.compliance.working_depth_m;
  auto curve = indent::make_compliance_curve(
      {.tip = tip,
       .working_depth_m = working_depth_m,
       .pull_depth_m = std::max(working_depth_m, kPastTear_ratio * torn_m),
       .ring_pitch_m = *tip_radius_m,
       .ring_m_per_N = std::array{0.0},
       .table_knots = scene_.table_knots});
  if (!curve) return blame(curve.error());
  law_->memory_bytes_ += curve->memory_bytes();
  return bend(keep(std::move(*curve)), working_depth_m);
}

// The organ's bending is of small strain, so the tip is, too.
TissueLawBuilder::Step TissueLawBuilder::add_small_compliance() {
  law_->title_ = fmt::format("elastic compliance, small strain under the tip, {} curves",
                             scene_.compliance.curves);
  auto family = read_scene_family(scene_);
  if (!family) return family.error();
  for (indent::ComplianceCurve& curve : family->curve) {
    law_->memory_bytes_ += curve.memory_bytes();
    law_->curves_.push_back(&keep(std::move(curve)));
  }
  law_->press_coordinate_ = std::move(family->press_coordinate);
  law_->pull_coordinate_ = std::move(family->pull_coordinate);
  law_->curve_rings_times_E_per_m_ = std::move(family->ring_times_E_per_m);
  return finish_field();
}

// Without a map the hand meets no more than the virtual spring, however the nodes move in a tick.
TissueLawBuilder::Step TissueLawBuilder::add_spring_patch() {
  const auto& own = scene_.laws.of<springs::SpringPatchParameters>();
  // As the patch does: a mesh may have fewer vertices.
  const std::size_t nodes = std::min(own.nodes, scene_.organ_mesh.vertex_m.size());
  law_->title_ =
      fmt::format("mass-spring patch, {} nodes, {}", nodes, name_of(own.method.integrator));
  springs::SpringPatchParameters parameters = own;
  // What the scene says elsewhere: rate, tool, relaxation.
  parameters.tick_s = 1.0 / scene_.rate_Hz;
  parameters.spheres = scene_.tool.spheres.size();
  auto relaxation = make_relaxation(scene_.relaxation, parameters.tick_s);
  if (!relaxation) return blame(relaxation.error());
  parameters.relaxation = *relaxation;
  if (scene_.varies_by_place) {
    const std::string net = law_->title_;
    if (auto failed = add_small_compliance()) return failed;
    law_->title_ = net + ", under the tool " + law_->title_;
    law_->organ_law_ = std::move(law_->contact_law_);
    parameters.organ = law_->organ_law_.get();
  } else {
    law_->range_ = {-parameters.working_depth_m, parameters.working_depth_m};
    law_->press_stiffness_N_per_m_ = parameters.coupling_stiffness_N_per_m;
  }
  auto patch = make_spring_patch(scene_.organ_mesh.view(), parameters);
  if (!patch) return blame(patch.error());
  law_->memory_bytes_ += (*patch)->memory_bytes();
  law_->contact_law_ = std::move(*patch);
  return std::nullopt;
}

/// The tip's own indentation on top of an organ that moves as the law says.
Result<const law::Law*> TissueLawBuilder::on_organ(const law::Law& organ) {
  if (!scene_.elastic)
    return blame({"exact_tip = true needs a section [elastic]; write it or leave the key out"});
  if (is_measured_)
    return blame({"a measured press has its tip's indentation already; leave exact_tip out"});
  const auto tip_radius_m = scene_tip_radius_m(scene_);
  if (!tip_radius_m) return blame(tip_radius_m.error());
  auto tip = indent::make_compliance_curve(
      {.tip = {.youngs_modulus_Pa = scene_.elastic->youngs_modulus_Pa,
               .poisson_ratio = scene_.elastic->poisson_ratio,
               .radius_m = *tip_radius_m,
               .large_strain = scene_.compliance.large_strain},
       // As far as CT-8 is valid.
       .working_depth_m = indent::kDeepestIndentation_ratio * *tip_radius_m,
       .ring_pitch_m = *tip_radius_m,
       .ring_m_per_N = std::array{0.0},
       .table_knots = law::kMaxKnots});
  if (!tip) return blame(tip.error());
  auto pair = make_series_law(keep(std::move(*tip)), organ);
  if (!pair) return blame(pair.error());
  law_->title_ += ", under an exact tip";
  draws_tissue_ = false;
  return &keep(std::move(*pair));
}

/// Press as the law gives it, pull as [pull] says.
Result<const law::Law*> TissueLawBuilder::with_pull(const law::Law& press) {
  // Without [pull] the law's own pull counts, if it has one.
  if (!scene_.pull) return &press;
  auto pulled = make_linear_pull(press, *scene_.pull);
  if (!pulled) return blame(pulled.error());
  return &keep(std::move(*pulled));
}

Result<std::unique_ptr<TissueLaw>> make_tissue_law(const Scene& scene, std::string_view name) {
  const LawRow* row = find_law(name);
  if (row == nullptr)
    return Error{fmt::format("{}: law \"{}\" cannot be felt; choose another", scene.path, name)};
  if (scene.exact_tip && !row->curve)
    return Error{
        fmt::format("{}: law \"{}\" has its own tip; leave exact_tip out", scene.path, name)};
  TissueLawBuilder builder(scene);
  if (auto failed = row->curve ? builder.add_curve(*row) : (builder.*row->build)()) return *failed;
  return builder.take();
}

}  // namespace tact::model::scene
