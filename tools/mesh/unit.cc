// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/unit.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/mesh/repair_file.h"

namespace tact::tools::mesh {
namespace {

double longest(const model::mesh::SurfaceMesh& mesh) {
  const auto sum = model::mesh::summarize(mesh);
  const model::Vec3 size = sum.high_m - sum.low_m;
  return std::max({size.x, size.y, size.z});
}

}  // namespace

std::map<std::string, double> units_m() {
  return {{"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"um", 1e-6}, {"in", 0.0254}};
}

double likely_unit_m(double size_in_file_units) {
  if (size_in_file_units >= 25.0) return 0.001;
  return size_in_file_units >= 1.0 ? 0.01 : 1.0;
}

Unit unit_of(const std::string& path, double named_m,
             const model::mesh::SurfaceMesh& in_file_units) {
  if (named_m > 0.0) return {.unit_m = named_m, .from = UnitFrom::kNamed};
  if (is_gltf(path)) return {.unit_m = 1.0, .from = UnitFrom::kFormat};
  return {.unit_m = likely_unit_m(longest(in_file_units)), .from = UnitFrom::kSize};
}

std::string name_of(double unit_m) {
  for (const auto& [name, length_m] : units_m())
    if (length_m == unit_m) return name;
  return fmt::format("{:g} m", unit_m);
}

std::string to_text(const Unit& unit, const model::mesh::SurfaceMesh& mesh) {
  const std::string name = name_of(unit.unit_m);
  if (unit.from == UnitFrom::kNamed) return name + ", as named";
  const std::string remedy = "--unit sets another";
  if (unit.from == UnitFrom::kFormat)
    return fmt::format("{}, as glTF is in metres; {}", name, remedy);
  return fmt::format("taken as {}: {:.4g} mm across; {}", name, 1e3 * longest(mesh), remedy);
}

std::string to_text(UnitFrom from) {
  if (from == UnitFrom::kNamed) return "named";
  return from == UnitFrom::kFormat ? "format" : "size";
}

}  // namespace tact::tools::mesh
