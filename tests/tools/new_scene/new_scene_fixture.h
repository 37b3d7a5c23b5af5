// SPDX-License-Identifier: Apache-2.0
// new_scene_fixture.h - tact-lab new-scene run in a folder of its own, and organs to give it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "model/mesh/mesh.h"
#include "tests/support/mesh_files.h"
#include "tests/support/shapes.h"

namespace tact::tools::new_scene::new_scene_test {

namespace fs = std::filesystem;

using model::Vec3;
using model::mesh::SurfaceMesh;
using tests::Ran;

/// 100 x 80 x 60 mm, far from the origin, as a scanner has it.
inline SurfaceMesh ellipsoid_mm(int levels) {
  SurfaceMesh mesh = tests::make_ball(1.0, levels);
  for (Vec3& p : mesh.vertex_m) p = {50.0 * p.x + 12.0, 40.0 * p.y - 205.0, 30.0 * p.z + 1310.0};
  return mesh;
}

inline std::string as_stl(const SurfaceMesh& mesh) {
  std::string text = "solid organ\n";
  const auto add = [&text](const Vec3& p) {
    text += "vertex " + std::to_string(p.x) + " " + std::to_string(p.y) + " " +
            std::to_string(p.z) + "\n";
  };
  for (const auto& t : mesh.triangle) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const std::uint32_t v : t) add(mesh.vertex_m[v]);
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid organ\n";
}

inline std::string as_obj(const SurfaceMesh& mesh) {
  std::string text;
  for (const Vec3& p : mesh.vertex_m)
    text +=
        "v " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + "\n";
  for (const auto& t : mesh.triangle)
    text += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " +
            std::to_string(t[2] + 1) + "\n";
  return text;
}

class NewScene : public testing::Test {
 protected:
  Ran run(const std::string& arguments) const {
    return tests::run_apart(temp_, "tact-lab new-scene", arguments);
  }
  std::string path(const std::string& name) const { return temp_.path() + "/" + name; }
  /// Names in the folder that begin with "mine", in order.
  std::vector<std::string> made() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(temp_.path()))
      if (entry.path().filename().string().starts_with("mine"))
        names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }

  tests::TempDirectory temp_;
  const std::string out_ = path("mine.toml");
};

}  // namespace tact::tools::new_scene::new_scene_test
