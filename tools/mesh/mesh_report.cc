// SPDX-License-Identifier: Apache-2.0
#include "tools/mesh/mesh_report.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace tact::tools::mesh {
namespace {

using model::Vec3;
using model::mesh::MeshSummary;
using model::mesh::ObjMesh;
using nlohmann::json;

json to_json(const Vec3& p) { return json::array({p.x, p.y, p.z}); }

std::string range_mm(double low_m, double high_m) {
  return fmt::format("{:.6g} to {:.6g} mm ({:.6g} mm)", 1e3 * low_m, 1e3 * high_m,
                     1e3 * (high_m - low_m));
}

}  // namespace

std::string to_text(const RepairStep& step) {
  return fmt::format("{:<15}  {}\n", step.name, step.text);
}

void show_percent(const std::string& step, int percent) {
  if (isatty(STDERR_FILENO) == 0) return;
  fmt::print(stderr, "\r{:<15}  {} %\r", step, percent);
  std::fflush(stderr);
}

std::string to_text(const ObjMesh& obj, const Unit& unit) {
  const MeshSummary sum = model::mesh::summarize(obj.mesh);
  const bool closed = sum.boundary_edges == 0;
  std::string text = fmt::format("unit       {}\n", to_text(unit, obj.mesh));
  text += fmt::format("vertices   {}\n", sum.vertices);
  text += fmt::format("           {} in the file, {} welded, {} unused\n", obj.file_vertices,
                      obj.welded_vertices, obj.unused_vertices);
  text += fmt::format("triangles  {}\n", sum.triangles);
  text += closed ? "surface    closed\n"
                 : fmt::format("surface    open, {} boundary edges\n", sum.boundary_edges);
  text += fmt::format("area       {:.6g} cm2\n", 1e4 * sum.area_m2);
  text += closed ? fmt::format("volume     {:.6g} cm3\n", 1e6 * sum.volume_m3)
                 : "volume     none, the surface is open\n";
  text += "x          " + range_mm(sum.low_m.x, sum.high_m.x) + "\n";
  text += "y          " + range_mm(sum.low_m.y, sum.high_m.y) + "\n";
  text += "z          " + range_mm(sum.low_m.z, sum.high_m.z) + "\n";
  if (const std::size_t parts = model::mesh::count_parts(obj.mesh); parts > 1)
    text += fmt::format(
        "note       {} parts that share no edge: only one is the organ? --largest keeps that with "
        "most faces\n",
        parts);
  if (obj.flipped)
    text += "note       the file's normals point inwards; turned outwards on loading\n";
  return text;
}

json to_json(const std::string& file, const Unit& unit, const ObjMesh& obj,
             const std::vector<RepairStep>& steps, const std::string& out) {
  const MeshSummary sum = model::mesh::summarize(obj.mesh);
  const bool closed = sum.boundary_edges == 0;
  const auto& p_m = obj.mesh.vertex_m;
  const auto top = std::ranges::max_element(p_m, {}, &Vec3::z);
  json reported{{"format", "tact-mesh"},
                {"version", 1},
                {"file", file},
                {"unit_m", unit.unit_m},
                {"unit_from", to_text(unit.from)},
                {"vertices", sum.vertices},
                {"triangles", sum.triangles},
                {"parts", model::mesh::count_parts(obj.mesh)},
                {"closed", closed},
                {"boundary_edges", sum.boundary_edges},
                {"area_m2", sum.area_m2},
                {"volume_m3", closed ? json(sum.volume_m3) : json(nullptr)},
                {"low_m", to_json(sum.low_m)},
                {"high_m", to_json(sum.high_m)},
                {"top", {{"vertex", top - p_m.begin()}, {"point_m", to_json(*top)}}},
                {"colors", !obj.vertex_color.empty()},
                {"file_vertices", obj.file_vertices},
                {"welded_vertices", obj.welded_vertices},
                {"unused_vertices", obj.unused_vertices},
                {"flipped", obj.flipped}};
  for (const RepairStep& step : steps)
    reported["steps"].push_back(
        {{"step", step.name}, {"count", step.count}, {"faces", step.faces}, {"text", step.text}});
  if (!out.empty()) reported["out"] = out;
  return reported;
}

std::string to_text(const Misfit& misfit) {
  return fmt::format("note       {}: {}\n", misfit.keys, misfit.text);
}

json to_json(const Placement& placement) {
  json misfits = json::array();
  for (const Misfit& misfit : placement.misfits)
    misfits.push_back({{"keys", misfit.keys}, {"text", misfit.text}});
  return {{"mesh", placement.mesh_path},
          {"mesh_unit_m", placement.unit_m},
          {"orientation_deg", to_json(placement.orientation_deg)},
          {"position_m", to_json(placement.position_m)},
          {"site_m", to_json(placement.site_m)},
          {"misfits", misfits}};
}

}  // namespace tact::tools::mesh
