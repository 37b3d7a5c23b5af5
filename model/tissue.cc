#include "model/tissue.h"

#include <algorithm>

namespace tact::model {

Result<std::unique_ptr<Tissue>> make_tissue(const Scene& scene) {
  auto chain = make_rhombus_chain(scene.rhombus);
  if (!chain) return Error{scene.path + ": " + chain.error().sentence};
  auto owned = std::make_unique<RhombusChain>(std::move(*chain));
  auto table = tabulate(*owned, scene.table_knots);
  if (!table) return Error{scene.path + ": " + table.error().sentence};

  const double pull_limit_N = -table->respond(table->range().pull_m).force_N;
  if (!(scene.contact.tear_force_N < pull_limit_N))
    return Error{scene.path +
                 ": contact.tear_force_N = " + std::to_string(scene.contact.tear_force_N) +
                 " is never reached: the law pulls with " + std::to_string(pull_limit_N) +
                 " N at most; allowed: less than that"};

  const std::vector<std::uint32_t>& fans = scene.organ_mesh.fan_start;
  for (std::size_t v = 0; v + 1 < fans.size(); ++v)
    if (fans[v + 1] - fans[v] > kMaxFan)
      return Error{scene.organ.mesh_path + ": " + std::to_string(fans[v + 1] - fans[v]) +
                   " triangles meet in one vertex; allowed: " + std::to_string(kMaxFan) +
                   ", remesh it there"};

  std::unique_ptr<Tissue> tissue(new Tissue(std::move(owned), *table));
  double reach_m = 0.0;
  for (const ProbeSphere& sphere : scene.tool.spheres)
    reach_m = std::max(reach_m, 2.0 * sphere.radius_m);
  tissue->seeds_ = make_seed_grid(scene.organ_mesh.view(), reach_m);
  tissue->contact_ = {.law = &tissue->table_,
                      .parameters = scene.contact,
                      .spheres = scene.tool.spheres,
                      .surface = scene.organ_mesh.view(),
                      .seeds = tissue->seeds_.view()};
  return tissue;
}

}  // namespace tact::model
