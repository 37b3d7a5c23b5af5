// SPDX-License-Identifier: Apache-2.0
#include "tools/new_scene/organ.h"

#include <fmt/format.h>

#include <algorithm>

#include "model/io/file_writer.h"
#include "tools/mesh/solid.h"

namespace tact::tools::new_scene {
namespace {

using model::Error;
using model::Result;
using model::Vec3;
using model::mesh::SurfaceMesh;

// Chosen: a lymph node, and a whole person.
constexpr double kMinSize_m = 0.005, kMaxSize_m = 2.5;

std::vector<std::string> repair_options(const OrganOrder& order) {
  std::vector<std::string> options{"--weld", "--drop-degenerate", "--largest", "--hollow-refused",
                                   "--close-holes"};
  if (order.smooth) options.emplace_back("--smooth");
  options.push_back(fmt::format("--decimate={}", order.faces));
  return options;
}

}  // namespace

bool is_sound(const OrganOrder& order) {
  if (order.smooth || !mesh::is_obj(order.source)) return false;
  const auto obj = model::mesh::load_obj(order.source, 1.0);
  if (!obj || obj->mesh.triangle.size() > order.faces) return false;
  return summarize(obj->mesh).boundary_edges == 0 && model::mesh::count_parts(obj->mesh) == 1;
}

Result<Organ> read_organ(const OrganOrder& order, const std::string& folder,
                         const std::function<void(const mesh::RepairStep&)>& on_step,
                         const std::function<void(const std::string&, int)>& on_percent) {
  Organ organ;
  std::string path = order.source;
  if (!is_sound(order)) {
    auto repaired = mesh::repair_file({.source = order.source, .options = repair_options(order)},
                                      on_step, on_percent);
    if (!repaired) return repaired.error();
    organ.obj_text = std::move(repaired->obj_text);
    path = folder + "/organ.obj";
    if (const auto error = model::io::write_file(path, organ.obj_text)) return *error;
  }
  auto obj = model::mesh::load_obj(path, 1.0);
  if (!obj) return obj.error();
  organ.unit = mesh::unit_of(order.source, order.unit_m, obj->mesh);
  model::mesh::scale(obj->mesh, organ.unit.unit_m);
  organ.mesh = std::move(obj->mesh);
  organ.has_colors = !obj->vertex_color.empty();
  const auto sum = summarize(organ.mesh);
  if (sum.boundary_edges > 0)
    return Error{fmt::format(
        "{}: {} edges stay open after the repair, so it has no inside; close it in a mesh editor",
        order.source, sum.boundary_edges)};
  if (auto error = mesh::check_solid(order.source, organ.mesh)) return *error;
  const Vec3 extent_m = sum.high_m - sum.low_m;
  const double size_m = std::max({extent_m.x, extent_m.y, extent_m.z});
  if (size_m < kMinSize_m || size_m > kMaxSize_m)
    return Error{fmt::format("{}: {:.3g} m long, and an organ is {:g} to {:g} m; name its --unit",
                             order.source, size_m, kMinSize_m, kMaxSize_m)};
  return organ;
}

}  // namespace tact::tools::new_scene
