// SPDX-License-Identifier: Apache-2.0
// tact-mesh reads every format that it names, and refuses a file that is none in one message.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "model/mesh/obj.h"
#include "tests/support/mesh_files.h"
#include "tests/tools/mesh/scanned_organ.h"

namespace tact::tests::mesh_formats_test {

using model::contact::TriangleCorners;
using model::mesh::SurfaceMesh;
using nlohmann::json;

class MeshFormats : public testing::Test {
 protected:
  MeshFormats() {
    const auto cube =
        model::mesh::load_obj(temp_.write("cube.obj", kCubeVertices + kCubeFaces), 1.0);
    soup_ = {.vertex = cube->mesh.vertex_m, .triangle = cube->mesh.triangle};
  }

  Ran run(const std::string& arguments) const { return run_apart(temp_, "tact-mesh", arguments); }
  /// A cube of 10 units, in each format; 10 units of an organ are centimetres.
  void expect_cube(const std::string& name, const std::string& text, double unit_m = 0.01) {
    SCOPED_TRACE(name);
    const Ran ran = run("--json " + temp_.write(name, text));
    ASSERT_EQ(ran.status, 0) << ran.err;
    const json reported = json::parse(ran.out);
    EXPECT_EQ(reported["vertices"], 8);
    EXPECT_EQ(reported["triangles"], 12);
    EXPECT_EQ(reported["closed"], true);
    EXPECT_NEAR(reported["volume_m3"].get<double>() / std::pow(10.0 * unit_m, 3), 1.0, 1e-9);
    EXPECT_EQ(reported["steps"][0]["step"], "read");
  }
  void expect_refused(const std::string& name, const std::string& text, const std::string& words) {
    SCOPED_TRACE(name);
    const std::string path = temp_.write(name, text);
    const Ran ran = run(path);
    EXPECT_EQ(ran.status, 2);
    EXPECT_EQ(ran.out, "");
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
    EXPECT_EQ(ran.err.find("tact-mesh: " + path), 0u) << ran.err;
    EXPECT_NE(ran.err.find(words), std::string::npos) << ran.err;
  }

  /// `vertex` and `face` are what one of them is in the text.
  std::string lines(const std::string& face) const {
    std::string text;
    for (const auto& p : soup_.vertex) text += fmt::format("{} {} {}\n", p.x, p.y, p.z);
    return text + faces(face);
  }
  std::string faces(const std::string& before) const {
    std::string text;
    for (const auto& t : soup_.triangle)
      text += fmt::format("{}{} {} {}\n", before, t[0], t[1], t[2]);
    return text;
  }
  std::string ascii_stl() const {
    std::string text = "solid cube\n";
    for (const auto& t : soup_.triangle) {
      text += "facet normal 0 0 0\nouter loop\n";
      for (const std::uint32_t v : t)
        text += fmt::format("vertex {} {} {}\n", soup_.vertex[v].x, soup_.vertex[v].y,
                            soup_.vertex[v].z);
      text += "endloop\nendfacet\n";
    }
    return text + "endsolid cube\n";
  }
  std::string vtk() const {
    return "# vtk DataFile Version 3.0\ncube\nASCII\nDATASET POLYDATA\nPOINTS 8 double\n" +
           lines_of_points() + "POLYGONS 12 48\n" + faces("3 ");
  }
  std::string lines_of_points() const {
    return lines("").substr(0, lines("").size() - faces("").size());
  }
  std::string vtp() const {
    std::string offsets;
    for (int i = 1; i <= 12; ++i) offsets += fmt::format("{} ", 3 * i);
    return "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" "
           "byte_order=\"LittleEndian\">\n"
           "<PolyData><Piece NumberOfPoints=\"8\" NumberOfVerts=\"0\" NumberOfLines=\"0\" "
           "NumberOfStrips=\"0\" "
           "NumberOfPolys=\"12\">\n<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" "
           "format=\"ascii\">\n" +
           lines_of_points() +
           "</DataArray></Points>\n<Polys><DataArray type=\"Int64\" Name=\"connectivity\" "
           "format=\"ascii\">\n" +
           faces("") +
           "</DataArray><DataArray type=\"Int64\" Name=\"offsets\" "
           "format=\"ascii\">" +
           offsets + "</DataArray></Polys>\n</Piece></PolyData></VTKFile>\n";
  }
  std::string ply() const {
    return "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty "
           "float z\n"
           "element face 12\nproperty list uchar int vertex_indices\nend_header\n" +
           lines("3 ");
  }
  /// Places as float, then corners as 32 bit numbers.
  std::string buffer() const {
    std::string bytes;
    const auto put = [&bytes](const auto& value) {
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    for (const auto& p : soup_.vertex)
      for (const double x : {p.x, p.y, p.z}) put(static_cast<float>(x));
    for (const auto& t : soup_.triangle)
      for (const std::uint32_t v : t) put(v);
    return bytes;
  }
  /// The cube half as large, in a node that doubles it.
  json gltf() const {
    return {{"asset", {{"version", "2.0"}}},
            {"scene", 0},
            {"scenes", {{{"nodes", {0}}}}},
            {"nodes", {{{"mesh", 0}, {"translation", {1, 2, 3}}}}},
            {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}}},
            {"buffers", {{{"byteLength", 240}}}},
            {"bufferViews",
             {{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 96}},
              {{"buffer", 0}, {"byteOffset", 96}, {"byteLength", 144}}}},
            {"accessors",
             {{{"bufferView", 0},
               {"componentType", 5126},
               {"count", 8},
               {"type", "VEC3"},
               {"min", {0, 0, 0}},
               {"max", {10, 10, 10}}},
              {{"bufferView", 1}, {"componentType", 5125}, {"count", 36}, {"type", "SCALAR"}}}}};
  }
  std::string glb() const {
    std::string text = gltf().dump(), bytes = "glTF";
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const auto put = [&bytes](std::size_t number) {
      const auto n = static_cast<std::uint32_t>(number);
      bytes.append(reinterpret_cast<const char*>(&n), sizeof n);
    };
    put(2), put(12 + 8 + text.size() + 8 + 240), put(text.size());
    bytes += "JSON" + text;
    put(240);
    return bytes + std::string("BIN\0", 4) + buffer();
  }

  TempDirectory temp_;
  Soup soup_;
};

TEST_F(MeshFormats, EveryFormatGivesTheSameCube) {
  expect_cube("a.stl", ascii_stl());
  expect_cube("b.stl", as_stl(soup_));
  expect_cube("a.ply", ply());
  std::string binary = ply().substr(0, ply().find("end_header\n")) + "end_header\n";
  binary.replace(binary.find("ascii"), 5, "binary_little_endian") += buffer().substr(0, 96);
  for (std::size_t t = 0; t < 12; ++t) binary += '\3' + buffer().substr(96 + 12 * t, 12);
  expect_cube("b.ply", binary);
  expect_cube("a.vtk", vtk());
  expect_cube("a.vtp", vtp());
  expect_cube("a.off", "OFF\n# by hand\n8 12 0\n" + lines("3 "));
  expect_cube("UPPER.OFF", "OFF 8 12 0\n" + lines("3 "));
  json in_file = gltf();
  in_file["buffers"][0]["uri"] = "cube.bin";
  temp_.write("cube.bin", buffer());
  expect_cube("a.gltf", in_file.dump(), 1.0);  // a glTF file is in metres
  expect_cube("b.glb", glb(), 1.0);
  EXPECT_NE(run(temp_.path() + "/b.glb").out.find("\nunit       m, as glTF is in metres"),
            std::string::npos);
}

TEST_F(MeshFormats, TheUnitIsNamedOrANumber) {
  const std::string path = temp_.write("a.stl", ascii_stl());
  for (const auto& [option, unit_m] : {std::pair{"--unit mm", 0.001},
                                       {"--unit CM", 0.01},
                                       {"--unit m", 1.0},
                                       {"--unit um", 1e-6},
                                       {"--unit in", 0.0254},
                                       {"--unit-m 0.02", 0.02}}) {
    const Ran ran = run(path + " --json " + option);
    ASSERT_EQ(ran.status, 0) << option << ran.err;
    EXPECT_DOUBLE_EQ(json::parse(ran.out)["unit_m"].get<double>(), unit_m) << option;
  }
  for (const char* wrong : {"--unit mile", "--unit mm --unit-m 0.001", "--unit 7"})
    EXPECT_EQ(run(path + " " + wrong).status, 2) << wrong;
}

TEST_F(MeshFormats, ABrokenFileGetsOneMessageWithItsLineWhereThatIsKnown) {
  const auto cut = [](const std::string& text) { return text.substr(0, text.size() * 6 / 10); };
  expect_refused("a.stl", cut(ascii_stl()), "a.stl:52: ");
  expect_refused("b.stl", cut(as_stl(soup_)), "cut short, after 6 of 12 triangles");
  expect_refused("c.stl", "no mesh", "no STL");
  expect_refused("a.ply", cut(ply()), "; export the mesh again");  // how, VTK says
  expect_refused("a.vtk", cut(vtk()), "a.vtk: ");
  expect_refused("a.vtp", cut(vtp()), "a.vtp:14: ");
  expect_refused("a.off", "OFF\n8 12 0\n" + lines("4 "), "a.off:11: the face has 3 corners");
  expect_refused("b.off", "OFF\n7 12 0\n" + lines("3 ").substr(6), "names vertex 7 of 7");
  expect_refused("c.off", "OFF\n8 12 0\n0 0 zero\n", "c.off:3: '0 0 zero'");
  expect_refused("d.off", "OFF\n8 12 0\n0 0 0\n", "d.off:3: the file ends too early");
  expect_refused("a.gltf", "{\"asset\": ", "a.gltf:1: ");
  expect_refused("b.glb", cut(glb()), "b.glb: ");
  for (const char* ending : {"stl", "ply", "vtk", "vtp", "off", "gltf", "glb"}) {
    const std::string name = std::string("nothing.") + ending;
    expect_refused(name, "", ":1: the file is empty");
    expect_refused(std::string("words.") + ending, std::string(200, 'x') + "\n",
                   "; export the mesh");
  }
  expect_refused("lie.ply",
                 "ply\nformat ascii 1.0\nelement vertex 2000000000\nproperty float x\n"
                 "property float y\nproperty float z\nend_header\n",
                 "promises 2000000000 vertices and faces, and the file has 109 bytes");
  expect_refused("noise.vtk", std::string(300, '\xfe') + "\n", "; export the mesh");
  expect_refused("mesh.step", "ISO-10303", ".step is no format that is read");
  expect_refused("far.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1e300 0\n3 0 1 2\n",
                 "vertex 3 is not finite, or beyond");
  expect_refused("none.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n",
                 "no faces in it, 3 points alone; make a surface of them");
  expect_refused("cloud.ply",
                 "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
                 "property float z\nend_header\n0 0 0\n1 1 1\n",
                 "no faces in it, 2 points alone");
  expect_refused("none.stl", std::string(84, '\0'), "no faces in it; export the mesh with faces");
  std::string spoilt = ascii_stl();
  spoilt.replace(spoilt.find("vertex 10 10 0"), 9, "vertex nan");
  expect_refused("nan.stl", spoilt, "nan.stl:6: vertex ");
}

TEST_F(MeshFormats, ADecimalCommaOrAWordIsNoNumberInAnyText) {
  const std::string obj = kCubeVertices + kCubeFaces;
  for (const auto& [name, text] :
       std::vector<std::pair<std::string, std::string>>{{"a.stl", ascii_stl()},
                                                        {"a.ply", ply()},
                                                        {"a.vtk", vtk()},
                                                        {"a.vtp", vtp()},
                                                        {"a.off", "OFF\n8 12 0\n" + lines("3 ")},
                                                        {"a.obj", obj}})
    for (const std::string bad : {"10,5", "ten"}) {
      std::string spoilt = text;
      const std::size_t at = spoilt.find("10 10 0");
      ASSERT_NE(at, spoilt.npos) << name;
      spoilt.replace(at, 2, bad);
      const auto line =
          std::count(spoilt.begin(), spoilt.begin() + static_cast<long>(at), '\n') + 1;
      expect_refused(name, spoilt, fmt::format("{}:{}: ", name, line));
      expect_refused(name, spoilt, bad);
    }
}

TEST_F(MeshFormats, GltfWithAMissingOrShortBufferIsRefusedByName) {
  json file = gltf();
  file["buffers"][0]["uri"] = "gone.bin";
  expect_refused(
      "a.gltf", file.dump(),
      "a.gltf: its buffer file 'gone.bin' is missing beside it; copy it there, or export "
      "as GLB");
  file["buffers"][0]["uri"] = "the%20cube.bin";
  expect_refused("b.gltf", file.dump(), "its buffer file 'the cube.bin' is missing beside it");
  temp_.write("the cube.bin", buffer());
  expect_refused("b.gltf", file.dump(), "'the cube.bin'; export as GLB");
  temp_.write("gone.bin", buffer().substr(0, 100));
  file["buffers"][0]["uri"] = "gone.bin";
  expect_refused("a.gltf", file.dump(), "'gone.bin' is cut short, 100 of 240 bytes");
  file["buffers"] = {7, {{"uri", 5}, {"byteLength", "x"}}};
  expect_refused("a.gltf", file.dump(), "a.gltf");
}

TEST_F(MeshFormats, AnObjFileKeepsItsLinesWhereItIsRepairedToo) {
  const std::string path = temp_.write("bad.obj", kCubeVertices + "f 1 2 nine\n");
  const Ran ran = run(path + " --smooth");
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.err.find("bad.obj:9: 'nine' is not a face corner"), std::string::npos) << ran.err;
}

}  // namespace tact::tests::mesh_formats_test
