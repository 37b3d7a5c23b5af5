// SPDX-License-Identifier: Apache-2.0
// tact-mesh keeps the colours of vertices, of every format that has them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "model/mesh/obj.h"
#include "tests/support/mesh_files.h"

namespace tact::tests::mesh_colors_test {

using model::Vec3;
using model::mesh::Rgb;
using nlohmann::json;

/// A cube of 10 units whose corner (x, y, z) is as red as x says, as green as y, as blue as z.
class MeshColors : public testing::Test {
 protected:
  static std::uint8_t level(double x) { return x > 5.0 ? 255 : 128; }
  static Rgb color_at(const Vec3& p) { return {level(p.x), level(p.y), level(p.z)}; }

  /// A line of each vertex: `begin`, its place if asked for, its colour.
  std::string vertices(const std::string& begin, bool place, bool bytes) const {
    std::string text;
    for (const Vec3& p : cube_.vertex_m) {
      text += begin;
      if (place) text += fmt::format("{} {} {} ", p.x, p.y, p.z);
      for (const std::uint8_t c : color_at(p))
        text += bytes ? fmt::format("{} ", c) : fmt::format("{:.4f} ", c / 255.0);
      text += "\n";
    }
    return text;
  }
  std::string places() const {
    std::string text;
    for (const Vec3& p : cube_.vertex_m) text += fmt::format("{} {} {}\n", p.x, p.y, p.z);
    return text;
  }
  std::string faces(const std::string& begin, std::uint32_t first = 0) const {
    std::string text;
    for (const auto& t : cube_.triangle)
      text += fmt::format("{}{} {} {}\n", begin, t[0] + first, t[1] + first, t[2] + first);
    return text;
  }
  Ran run(const std::string& name, const std::string& text) const {
    return run_apart(temp_, "tact-mesh",
                     temp_.write(name, text) + " --weld --largest --out " + out_);
  }
  void expect_kept(const std::string& name, const std::string& text) const {
    SCOPED_TRACE(name);
    const Ran ran = run(name, text);
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_NE(ran.out.find("color            8 vertices have the colour"), std::string::npos)
        << ran.out;
    const auto made = model::mesh::load_obj(out_, 1.0);
    ASSERT_TRUE(made);
    ASSERT_EQ(made->vertex_color.size(), 8u);
    const double low = std::min_element(made->mesh.vertex_m.begin(), made->mesh.vertex_m.end(),
                                        [](auto& a, auto& b) { return a.x < b.x; })
                           ->x;
    for (std::size_t v = 0; v < 8; ++v)
      EXPECT_EQ(made->vertex_color[v], color_at(made->mesh.vertex_m[v] - Vec3{low, low, low}));
    std::filesystem::remove(out_);
  }
  void expect_none(const std::string& name, const std::string& text, bool reported = true) const {
    SCOPED_TRACE(name);
    const Ran ran = run(name, text);
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(ran.out.find("color            none: ") != std::string::npos, reported) << ran.out;
    EXPECT_TRUE(model::mesh::load_obj(out_, 1.0)->vertex_color.empty());
    std::filesystem::remove(out_);
  }

  TempDirectory temp_;
  const std::string out_ = temp_.path() + "/out.obj";
  const model::mesh::SurfaceMesh cube_ =
      model::mesh::load_obj(temp_.write("cube.obj", kCubeVertices + kCubeFaces), 1.0)->mesh;
};

const std::string kPlyHead =
    "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\n"
    "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
    "element face 12\nproperty list uchar int vertex_indices\nend_header\n";
const std::string kVtkHead =
    "# vtk DataFile Version 3.0\ncube\nASCII\nDATASET POLYDATA\nPOINTS 8 double\n";

TEST_F(MeshColors, StayWithTheirVerticesInTexts) {
  expect_kept("a.obj", vertices("v ", true, false) + faces("f ", 1));
  expect_kept("a.ply", kPlyHead + vertices("", true, true) + faces("3 "));
  expect_kept("a.off", "COFF\n8 12 0\n" + vertices("", true, true) + faces("3 "));
  expect_kept("b.off", "COFF\n8 12 0\n" + vertices("", true, false) + faces("3 "));
  // Shares in the file are bytes to VTK.
  const std::string vtk = kVtkHead + places() + "POLYGONS 12 48\n" + faces("3 ") + "POINT_DATA 8\n";
  expect_kept("a.vtk", vtk + "COLOR_SCALARS color 3\n" + vertices("", false, false));
  expect_kept("b.vtk",
              vtk + "SCALARS RGB int 3\nLOOKUP_TABLE default\n" + vertices("", false, true));
}

TEST_F(MeshColors, GltfColoursAreReadAsLinear) {
  std::string bytes;
  const auto put = [&bytes](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  for (const Vec3& p : cube_.vertex_m)
    for (const double x : {p.x, p.y, p.z}) put(static_cast<float>(x));
  for (const auto& t : cube_.triangle)
    for (const std::uint32_t v : t) put(v);
  // 128 of sRGB.
  for (const Vec3& p : cube_.vertex_m)
    for (const std::uint8_t c : color_at(p)) put(c == 255 ? 1.0F : 0.21586F);
  temp_.write("cube.bin", bytes);
  const auto view = [](int at, int length) {
    return json{{"buffer", 0}, {"byteOffset", at}, {"byteLength", length}};
  };
  const json three{{"componentType", 5126}, {"count", 8}, {"type", "VEC3"}};
  json place = three, color = three;
  place["bufferView"] = 0, place["min"] = {0, 0, 0}, place["max"] = {10, 10, 10};
  color["bufferView"] = 2;
  const json file{
      {"asset", {{"version", "2.0"}}},
      {"scene", 0},
      {"scenes", {{{"nodes", {0}}}}},
      {"nodes", {{{"mesh", 0}}}},
      {"meshes",
       {{{"primitives", {{{"attributes", {{"POSITION", 0}, {"COLOR_0", 2}}}, {"indices", 1}}}}}}},
      {"buffers", {{{"byteLength", bytes.size()}, {"uri", "cube.bin"}}}},
      {"bufferViews", {view(0, 96), view(96, 144), view(240, 96)}},
      {"accessors",
       {place,
        {{"bufferView", 1}, {"componentType", 5125}, {"count", 36}, {"type", "SCALAR"}},
        color}}};
  expect_kept("a.gltf", file.dump());
}

TEST_F(MeshColors, IncompleteOrInvalidColoursAreDropped) {
  const std::string off = "COFF\n8 12 0\n";
  const std::string all = vertices("", true, true);
  expect_none("a.off", off + "0 0 0\n" + all.substr(all.find('\n') + 1) + faces("3 "), false);
  const std::string vtk = kVtkHead + places() + "POLYGONS 12 48\n" + faces("3 ") + "POINT_DATA 8\n";
  expect_none("a.vtk", vtk + "SCALARS RGB float 1\nLOOKUP_TABLE default\n1 2 3 4 5 6 7 8\n", false);
  expect_none("b.vtk", vtk + "FIELD f 1\nRGB 3 4 unsigned_char\n1 2 3 4 5 6 7 8 9 10 11 12\n");
  expect_none("c.vtk", vtk + "FIELD f 1\nRGB 3 8 float\n" + std::string("-1 2 3\n") +
                           "1 2 3\n1 2 3\n1 2 3\n1 2 3\n1 2 3\n1 2 3\n1 2 3\n");
}

TEST_F(MeshColors, PlyColoursAsFloatsAreDroppedAndNotReadAsBlack) {
  std::string head = kPlyHead;
  for (const char* name : {"uchar red", "uchar green", "uchar blue"})
    head.replace(head.find(name), 5, "float");
  expect_none("a.ply", head + vertices("", true, false) + faces("3 "));
}

TEST_F(MeshColors, ChannelSlightlyAboveOneIsClampedToOne) {
  std::string text = vertices("", true, false);
  text.replace(text.find("1.0000"), 6, "1.0004");
  expect_kept("a.off", "COFF\n8 12 0\n" + text + faces("3 "));
}

}  // namespace tact::tests::mesh_colors_test
