// tact-make-meshes: writes the meshes that the scenes use, the same bytes on every run.
#include "tools/make_meshes.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>

namespace {

namespace fs = std::filesystem;
using tact::model::Error;
using tact::model::Result;
using tact::model::Vec3;
using tact::tools::Shape;

constexpr std::size_t kLiverVertices = 3116;  // as in the published tests of the rhombus chain
constexpr std::size_t kMostVertices = 9'000'000;

struct Wanted {
  std::string name;
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
  for (const auto& t : shape.triangle) {
    fmt::format_to(out, "f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  }
  return fmt::to_string(text);
}

std::optional<Error> write_shape(const std::string& directory, const std::string& name,
                                 const Shape& shape) {
  const auto mesh = tact::model::make_surface_mesh(shape.vertex_mm, shape.triangle);
  if (!mesh) return Error{name + ": " + mesh.error().sentence};
  const fs::path path =
      fs::path(directory) / fmt::format("{}_{}.obj", name, shape.vertex_mm.size());
  std::ofstream file(path, std::ios::binary);
  file << obj_text(name, shape);
  file.close();
  if (!file) {
    return Error{path.string() +
                 ": cannot be written; check that the directory exists and has "
                 "room"};
  }
  const auto sum = tact::model::summarize(*mesh);  // of millimetres, so its "m" are mm here
  const Vec3 size_mm = sum.high_m - sum.low_m;
  fmt::print("{}: {} vertices, {} triangles, {:.1f} x {:.1f} x {:.1f} mm, least angle {:.1f} deg\n",
             path.string(), sum.vertices, sum.triangles, size_mm.x, size_mm.y, size_mm.z,
             tact::tools::least_angle_deg(shape));
  return std::nullopt;
}

}  // namespace

// The libraries throw when memory or standard output is gone; then the program may as well end.
int main(int argc, char** argv) {
  CLI::App app{"Write the meshes that tact ships: OBJ, unit mm, the same bytes on every run."};
  std::string directory = ".";
  bool liver = false, forceps = false;
  std::size_t liver_vertices = kLiverVertices;
  app.add_option("--out", directory, "directory to write to")->required();
  app.add_flag("--liver", liver, "only the meshes named: liver");
  app.add_flag("--forceps", forceps, "only the meshes named: forceps");
  app.add_option("--liver-vertices", liver_vertices,
                 "vertices of the liver, 50 to 9000000; the shape stays")
      ->capture_default_str()
      ->check(CLI::Range(tact::tools::kFewestVertices, kMostVertices));
  app.footer("Exit status: 0 written, 2 bad usage or the directory cannot be written.");
  app.failure_message([](const CLI::App*, const CLI::Error& e) {
    return fmt::format("tact-make-meshes: {}; see tact-make-meshes --help\n", e.what());
  });
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  const bool all = !liver && !forceps;
  std::vector<Wanted> wanted;
  if (liver || all) wanted.push_back({"liver", tact::tools::make_liver_shape(liver_vertices)});
  if (forceps || all) wanted.push_back({"forceps", tact::tools::make_forceps_shape()});
  for (const Wanted& w : wanted) {
    std::optional<Error> error;
    if (!w.shape) error = w.shape.error();
    if (w.shape) error = write_shape(directory, w.name, w.shape.value());
    if (!error) continue;
    fmt::print(stderr, "tact-make-meshes: {}\n", error->sentence);
    return 2;
  }
  return 0;
}
