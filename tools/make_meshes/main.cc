// SPDX-License-Identifier: Apache-2.0
// tact-make-meshes: writes the meshes that the scenes use, the same bytes on every run.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <system_error>

#include "model/io/file_writer.h"
#include "model/io/program/command_line.h"
#include "model/io/program/program_end.h"
#include "model/io/program/within.h"
#include "tools/make_meshes/meshes.h"

namespace {

namespace fs = std::filesystem;
using tact::model::Error;
using tact::model::Result;
using tact::model::Vec3;
using tact::tools::make_meshes::Shape;

constexpr std::size_t kLiverVertices = 3116;  // as in the published tests of the rhombus chain
constexpr std::size_t kMaxVertices = 9'000'000;

struct Mesh {
  const char* name;
  bool counted;  // its file name tells the number of vertices
  Result<Shape> (*make)();
};

// The liver comes in any size and has its own row in main().
constexpr std::array<Mesh, 9> kMeshes{
    {{"forceps", true, tact::tools::make_meshes::make_forceps_shape},
     {"heart", true, tact::tools::make_meshes::make_heart_shape},
     {"hand", true, tact::tools::make_meshes::make_hand_shape},
     {"skin", false, tact::tools::make_meshes::make_skin_shape},
     {"injector", false, tact::tools::make_meshes::make_injector_shape},
     {"gum", false, tact::tools::make_meshes::make_gum_shape},
     {"blade", false, tact::tools::make_meshes::make_blade_shape},
     {"cover", false, tact::tools::make_meshes::make_cover_shape},
     {"press", false, tact::tools::make_meshes::make_press_shape}}};

struct Wanted {
  std::string name;
  bool counted = false;
  Result<Shape> shape;
};

// 1e-4 mm steps: finer than any edge, coarser than the last bits of a math library. No "-0.0000".
double rounded_mm(double x_mm) { return std::round(x_mm * 1e4) / 1e4 + 0.0; }

std::string obj_text(const std::string& name, const Shape& shape) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "# {}, made by tact-make-meshes; unit mm\n# {} vertices, {} triangles\n",
                 name, shape.vertex_mm.size(), shape.triangle.size());
  for (const Vec3& p : shape.vertex_mm) {
    fmt::format_to(out, "v {:.4f} {:.4f} {:.4f}\n", rounded_mm(p.x), rounded_mm(p.y),
                   rounded_mm(p.z));
  }
  for (const auto& t : shape.triangle)
    fmt::format_to(out, "f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return fmt::to_string(text);
}

std::optional<Error> write_shape(const std::string& directory, const Wanted& wanted) {
  const std::string& name = wanted.name;
  const Shape& shape = wanted.shape.value();
  const auto mesh = tact::model::mesh::make_surface_mesh(shape.vertex_mm, shape.triangle);
  if (!mesh) return Error{name + ": " + mesh.error().sentence};
  const std::string count = wanted.counted ? fmt::format("_{}", shape.vertex_mm.size()) : "";
  const fs::path path = fs::path(directory) / fmt::format("{}{}.obj", name, count);
  if (auto error = tact::model::io::write_file(path.string(), obj_text(name, shape))) return error;
  const auto sum = tact::model::mesh::summarize(*mesh);  // of millimetres, so its "m" are mm here
  const Vec3 size_mm = sum.high_m - sum.low_m;
  fmt::print("{}: {} vertices, {} triangles, {:.1f} x {:.1f} x {:.1f} mm, least angle {:.1f} deg\n",
             path.string(), sum.vertices, sum.triangles, size_mm.x, size_mm.y, size_mm.z,
             tact::tools::make_meshes::least_angle_deg(shape));
  return std::nullopt;
}

}  // namespace

int main(int argc, char** argv) {
  tact::model::io::watch_standard_output("tact-make-meshes");
  tact::model::io::tell_uncaught("tact-make-meshes");
  CLI::App app{"Write the meshes that tact ships: OBJ, unit mm, the same bytes on every run."};
  std::string directory = ".";
  bool liver = false;
  std::array<bool, kMeshes.size()> asked{};
  std::size_t liver_vertices = kLiverVertices;
  app.add_option("--out", directory, "directory to write to")->required();
  app.add_flag("--liver", liver, "only the meshes named: liver");
  for (std::size_t i = 0; i < kMeshes.size(); ++i) {
    const std::string name = kMeshes[i].name;
    app.add_flag("--" + name, asked[i], "only the meshes named: " + name);
  }
  app.add_option("--liver-vertices", liver_vertices,
                 "vertices of the liver, 50 to 9000000; the shape stays")
      ->capture_default_str()
      ->check(tact::model::io::within(tact::tools::make_meshes::kMinVertices, kMaxVertices));
  app.footer("Exit status: 0 written, 2 bad usage or the directory cannot be written.");
  if (const auto status = tact::model::io::parse_command_line(app, "tact-make-meshes", argc, argv))
    return *status;
  std::error_code ignored;
  if (!fs::is_directory(directory, ignored)) {  // said before the work, not after
    fmt::print(stderr, "tact-make-meshes: {}: no such directory; make it first\n", directory);
    return 2;
  }
  const bool all = !liver && std::find(asked.begin(), asked.end(), true) == asked.end();
  std::vector<Wanted> wanted;
  if (liver || all)
    wanted.push_back({"liver", true, tact::tools::make_meshes::make_liver_shape(liver_vertices)});
  for (std::size_t i = 0; i < kMeshes.size(); ++i)
    if (asked[i] || all) wanted.push_back({kMeshes[i].name, kMeshes[i].counted, kMeshes[i].make()});
  for (const Wanted& w : wanted) {
    std::optional<Error> error;
    if (!w.shape) error = Error{w.name + ": " + w.shape.error().sentence};
    if (w.shape) error = write_shape(directory, w);
    if (!error) continue;
    fmt::print(stderr, "tact-make-meshes: {}\n", error->sentence);
    return 2;
  }
  return 0;
}
