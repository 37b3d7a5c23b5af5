// SPDX-License-Identifier: Apache-2.0
// tact-mesh: what is in this mesh file, and is it sound?
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "model/io/command_line.h"
#include "model/io/program_end.h"
#include "model/io/within.h"
#include "model/mesh/obj.h"

namespace {

using nlohmann::json;
using tact::model::Vec3;
using tact::model::mesh::MeshSummary;
using tact::model::mesh::ObjMesh;

json to_json(const Vec3& p) { return json::array({p.x, p.y, p.z}); }

json to_json(const std::string& file, double unit_m, const ObjMesh& obj, const MeshSummary& sum) {
  const bool closed = sum.boundary_edges == 0;
  return {{"format", "tact-mesh"},
          {"version", 1},
          {"file", file},
          {"unit_m", unit_m},
          {"vertices", sum.vertices},
          {"triangles", sum.triangles},
          {"closed", closed},
          {"boundary_edges", sum.boundary_edges},
          {"area_m2", sum.area_m2},
          {"volume_m3", closed ? json(sum.volume_m3) : json(nullptr)},
          {"low_m", to_json(sum.low_m)},
          {"high_m", to_json(sum.high_m)},
          {"file_vertices", obj.file_vertices},
          {"welded_vertices", obj.welded_vertices},
          {"unused_vertices", obj.unused_vertices},
          {"flipped", obj.flipped}};
}

std::string range_mm(double low_m, double high_m) {
  return fmt::format("{:.6g} to {:.6g} mm ({:.6g} mm)", 1e3 * low_m, 1e3 * high_m,
                     1e3 * (high_m - low_m));
}

std::string to_text(const ObjMesh& obj, const MeshSummary& sum) {
  const bool closed = sum.boundary_edges == 0;
  std::string text = fmt::format("vertices   {}\n", sum.vertices);
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
  if (obj.flipped)
    text += "note       the file's normals point inwards; turned outwards on loading\n";
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  tact::model::io::watch_standard_output("tact-mesh");
  tact::model::io::tell_uncaught("tact-mesh");
  CLI::App app{
      "What is in this mesh file, and is it sound? Reads a Wavefront OBJ surface as tact does:\n"
      "cuts faces into triangles, welds equal vertices, and refuses what is no surface (an edge\n"
      "with more than two triangles, a face without area, a broken line) with the line of the "
      "file."};
  std::string path;
  double unit_m = 0.001;
  bool as_json = false;
  app.add_option("FILE", path, "OBJ file")->required();
  app.add_option("--unit-m", unit_m, "length of one file unit, m: 0.001 for mm, 0.01 for cm")
      ->check(tact::model::io::within(1e-9, 1e6))
      ->capture_default_str();
  app.add_flag("--json", as_json, "print one JSON object, SI units (m, m2, m3)");
  app.footer("Exit status: 0 the mesh is sound, 2 bad usage or a bad file.");
  if (const auto status = tact::model::io::parse_command_line(app, "tact-mesh", argc, argv))
    return *status;
  const auto obj = tact::model::mesh::load_obj(path, unit_m);
  if (!obj) {
    fmt::print(stderr, "tact-mesh: {}\n", obj.error().sentence);
    return 2;
  }
  const MeshSummary sum = tact::model::mesh::summarize(obj->mesh);
  // A path may hold bytes that are no UTF-8; JSON then shows them as replacement characters.
  fmt::print("{}", as_json ? to_json(path, unit_m, obj.value(), sum)
                                     .dump(2, ' ', false, json::error_handler_t::replace) +
                                 "\n"
                           : to_text(obj.value(), sum));
  return 0;
}
