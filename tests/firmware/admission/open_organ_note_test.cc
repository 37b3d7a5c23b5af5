// SPDX-License-Identifier: Apache-2.0
// What tactd --check reports of an organ with a hole.
#include <gtest/gtest.h>

#include "firmware/admission/notes.h"
#include "tests/support/test_scene.h"

namespace tact::firmware::admission::open_organ_note_test {

TEST(OpenOrganNote, OpenOrganIsReportedWithItsBoundaryEdges) {
  const std::string note = open_organ_note(tests::make_plate_scene());  // 20 x 20 cells
  EXPECT_NE(note.find("plate.toml: the organ is open, with 80 boundary edges; beside the boundary "
                      "of an open surface there is no inside"),
            std::string::npos)
      << note;
}

TEST(OpenOrganNote, ClosedOrganHasNoNote) {
  model::scene::Scene scene = tests::make_plate_scene();
  scene.organ_mesh = tests::make_ball(0.05, 2);
  EXPECT_EQ(open_organ_note(scene), "");
}

TEST(OpenOrganNote, ShippedScenesHaveNoNote) {
  for (const std::string name :
       {"grasper", "gum", "heart", "liver", "liver_source", "liver_twist", "maintenance", "skin"}) {
    const auto scene =
        model::scene::load_scene(TACT_SOURCE_DIR "/model/scenes/" + name + ".toml", {});
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(open_organ_note(*scene), "") << name;
  }
}

TEST(PartsNote, RepeatsWhatTactMeshNotes) {
  model::scene::Scene scene = tests::make_plate_scene();
  EXPECT_EQ(parts_note(scene), "");
  scene.organ.mesh_path = "bladder.obj";
  scene.organ.is_turned = true;
  EXPECT_EQ(parts_note(scene),
            "plate.toml: the normals of bladder.obj point inwards and were turned");
  scene.organ.is_turned = false;
  // the same cavity, in the organ and drawn once
  const model::mesh::SurfaceMesh inner = tests::make_ball(0.03, 1);
  std::vector<model::Vec3> vertex_m = tests::make_ball(0.05, 1).vertex_m;
  auto triangle = tests::make_ball(0.05, 1).triangle;
  const auto first = static_cast<std::uint32_t>(vertex_m.size());
  vertex_m.insert(vertex_m.end(), inner.vertex_m.begin(), inner.vertex_m.end());
  for (const auto& t : inner.triangle)
    triangle.push_back({t[0] + first, t[2] + first, t[1] + first});
  scene.organ_mesh = *model::mesh::make_surface_mesh(vertex_m, triangle);
  scene.look.piece_color_ratio.clear();
  EXPECT_TRUE(parts_note(scene).starts_with(
      "plate.toml: the organ has 2 parts that share no edge, and all are felt; is only one the "
      "organ? tact-mesh bladder.obj --largest"))
      << parts_note(scene);
  scene.look.piece_color_ratio = {{1.0, 1.0, 0.5}};
  EXPECT_EQ(parts_note(scene), "") << "its pieces have colours: they are meant";
}

}  // namespace tact::firmware::admission::open_organ_note_test
