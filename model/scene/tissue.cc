// SPDX-License-Identifier: Apache-2.0
#include "model/scene/tissue.h"

#include <fmt/format.h>

namespace tact::model::scene {

Result<std::unique_ptr<Tissue>> make_tissue(const Scene& scene) {
  auto law = make_tissue_law(scene, scene.law);
  if (!law) return law.error();
  const double pull_limit_N = (*law)->pull_limit_N();
  // Else the tool would hang on the tissue, however hard the hand pulls.
  if (pull_limit_N > 0.0 && !(scene.contact.tear_force_N < pull_limit_N))
    return Error{
        fmt::format("{}: contact.tear_force_N = {:g} is never reached: the law pulls with {:g} N "
                    "at most; write "
                    "contact.tear_force_N = {:.2g} or less",
                    scene.path, scene.contact.tear_force_N, pull_limit_N, 0.94 * pull_limit_N)};

  const std::vector<std::uint32_t>& fans = scene.organ_mesh.fan_start;
  for (std::size_t v = 0; v + 1 < fans.size(); ++v)
    // A corner is left over all its triangles in one step: their number bounds the tick.
    if (fans[v + 1] - fans[v] > contact::kMaxFan)
      return Error{fmt::format("{}: {} triangles meet in one vertex; allowed: {}, remesh it there",
                               scene.organ.mesh_path, fans[v + 1] - fans[v], contact::kMaxFan)};

  std::unique_ptr<Tissue> tissue(new Tissue(std::move(*law)));
  tissue->tree_ = contact::make_triangle_tree(scene.organ_mesh.view());
  tissue->contact_ = {.law = &tissue->law_->contact_law(),
                      .parameters = scene.contact,
                      .spheres = scene.tool.spheres,
                      .surface = scene.organ_mesh.view(),
                      .tree = tissue->tree_.view(),
                      .organ = tissue->law_->organ(),
                      .blade = scene.tool.blade,
                      .period_s = 1.0 / scene.rate_Hz};
  return tissue;
}

Result<CheckTissue> tissue_for_check(const Scene& scene, const Tissue& tissue) {
  if (!tissue.law().has_net()) return CheckTissue{.tissue = &tissue};
  auto other = make_tissue(scene);
  if (!other) return other.error();
  const Tissue* const made = other->get();
  return CheckTissue{.tissue = made, .own = std::move(*other)};
}

}  // namespace tact::model::scene
