// SPDX-License-Identifier: Apache-2.0
#include "model/scene/scene_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "model/scene/laws.h"
#include "model/scene/scene_limits.h"
#include "model/scene/variant.h"

namespace tact::model::scene {
namespace {

// Chosen: a slip of the pen, not a long session, is what it keeps out.
constexpr std::size_t kMaxStrokes = 64;
// A scanner's origin may lie anywhere.
constexpr Range kAnywhere_m{-1e6, 1e6};

void visit_mesh(Keys& k, MeshText& mesh) {
  // For the message that says which line names a file that is not there.
  mesh.position = k.position_of("mesh");
  k.text("mesh", "OBJ file, absolute or from the folder of the scene", mesh.file);
  k.number("mesh_unit_m", {1e-6, 1.0}, "length of one unit of the file", mesh.unit_m, kOptional);
}

void visit_blade(Keys& k, contact::Blade& blade) {
  k.vector("from_m", {-0.2, 0.2}, "one end of the edge, tool frame", blade.a_m);
  k.vector("to_m", {-0.2, 0.2}, "the other end", blade.b_m);
}

void visit_tool(Keys& k, SceneText& out) {
  visit_mesh(k, out.tool_mesh);
  k.vector("handle_m", {-0.3, 0.3}, "its point at the device's reference point, tool frame",
           out.script.handle_m, kOptional);
  k.entries("sphere", {1, contact::kMaxSpheres}, "in contact with the organ", [&](Keys& sphere) {
    contact::ProbeSphere& probe = out.scene.tool.spheres.emplace_back();
    sphere.vector("offset_m", {-0.2, 0.2}, "of the centre from the tool's origin, tool frame",
                  probe.offset_m);
    sphere.number("radius_m", {5e-4, 0.05}, "of the sphere", probe.radius_m);
  });
  k.section("blade", "a cutting edge, for law = \"spring_patch\"", visit_blade,
            out.scene.tool.blade);
  // Known by now: visit_scene visits the laws before the tool.
  const std::string& law = out.scene.law;
  const LawRow* row = find_law(law);
  if (out.scene.tool.blade && row != nullptr && !row->can_be_cut)
    k.refuse({"blade"}, fmt::format("tool.blade cuts nothing with law = \"{}\"; write law = "
                                    "\"spring_patch\" or leave [tool.blade] out",
                                    law));
}

// The page has a picture of each: host/web/src/scene/material.ts.
constexpr std::array kMaterials{
    Choice{"tissue", "moist and red, paler where it is stretched"},
    Choice{"skin", "dry, paler where it is stretched"},
    Choice{"glove", "smooth, of pale blue rubber"},
    Choice{"paint", "grey lacquer"},
    Choice{"steel", "polished"},
};

void visit_look(Keys& k, SceneText& out) {
  LookSettings& look = out.scene.look;
  std::size_t organ = 0, tool = kMaterials.size() - 1;
  k.choice("organ", kMaterials, "what it looks like", organ, kOptional);
  k.choice("tool", kMaterials, "the same of the tool", tool, kOptional);
  look.organ = kMaterials[organ].name;
  look.tool = kMaterials[tool].name;
  k.flag("vertex_colors", "the organ's colours are those of its mesh's vertices",
         look.has_vertex_colors, kOptional);
  k.entries("piece", {0, kMaxPieces},
            "a connected piece of the organ's mesh, in its order; the last: all others too",
            [&](Keys& piece) {
              piece.vector("color_ratio", {0.0, 4.0}, "red, green, blue, times the material's",
                           look.piece_color_ratio.emplace_back());
            });
  out.vertex_colors_position = k.position_of("vertex_colors");
  if (look.has_vertex_colors && !look.piece_color_ratio.empty())
    k.refuse({"vertex_colors"},
             "look.vertex_colors and look.piece both colour the organ; leave one of them out");
}

void visit_contact(Keys& k, Scene& scene) {
  contact::ContactParameters& c = scene.contact;
  k.number("friction_ratio", {0.0, 2.0}, "largest sliding force over normal force",
           c.friction_ratio);
  k.number("sliding_stiffness_N_per_m", {0.0, 5000.0}, "of tissue along the surface; 0: its own",
           c.sliding_stiffness_N_per_m, kOptional);
  k.number("tear_force_N", {0.01, 20.0}, "above it a held sphere is released", c.tear_force_N);
  k.number("grip_close_ratio", {0.05, 1.0}, "closing the grip above it holds the tissue",
           c.grip_close_ratio, kOptional);
  k.number("grip_open_ratio", {0.0, 0.95}, "opening the grip below it releases; < grip_close_ratio",
           c.grip_open_ratio, kOptional);
  constexpr std::array kGrips{Choice{"hold", "the jaws are closed while the hand presses"},
                              Choice{"toggle", "one press closes them, the next opens them"}};
  k.choice("grip", kGrips, "what a press of the grip, button or switch does", scene.grip_toggles,
           kOptional);
  // Without a gap between them a trembling hand would grip and release many times a second.
  if (!(c.grip_open_ratio < c.grip_close_ratio)) {
    k.refuse(
        {"grip_open_ratio", "grip_close_ratio"},
        fmt::format(
            "contact.grip_open_ratio = {} must be below grip_close_ratio = {}; lower it or raise "
            "grip_close_ratio",
            c.grip_open_ratio, c.grip_close_ratio));
  }
}

void visit_hand(Keys& k, SceneText& out) {
  HandSettings& hand = out.scene.hand;
  HandScript& script = out.script;
  k.number("mass_kg", {0.01, 2.0}, "of the hand that moves with the handle", hand.mass_kg);
  k.number("stiffness_N_per_m", {1.0, 5000.0}, "of the grasp, towards where the hand wants to be",
           hand.stiffness_N_per_m);
  k.number("damping_Ns_per_m", {0.0, 200.0}, "of the grasp", hand.damping_Ns_per_m);
  k.flag("repeat", "start over after the last stroke", hand.repeat);
  k.vector("home_m", {-0.5, 0.5}, "where the tool's origin starts, in W", script.home_m);
  k.vector("site_m", {-0.5, 0.5}, "the point of the surface that is touched, in W", script.site_m);
  k.vector("inward", {-1.0, 1.0}, "direction into the tissue there, any length but 0",
           script.inward);
  if (!(norm(script.inward) > 0.0))
    k.refuse({"inward"}, "hand.inward has no direction; allowed: any length but 0");
  k.entries("stroke", {0, kMaxStrokes}, "what the hand does, in this order",
            [&](Keys& stroke) { visit_stroke(stroke, script.strokes.emplace_back()); });
  script.repeat = hand.repeat;
  script.home_position = k.position_of("home_m");
}

void visit_live(Keys& k, Scene& scene) {
  constexpr CountRange kCount{0, 16};
  k.entries("live", kCount, "a number that may change on hardware while it runs: tactctl SCENE set",
            [&](Keys& live) {
              live.text("key", "of a law, or elastic.youngs_modulus_Pa", scene.live.emplace_back());
            });
  const std::vector<LawNumber> numbers = law_numbers(scene);
  const auto may_change = [&numbers](const std::string& key) {
    return std::ranges::any_of(numbers,
                               [&](const LawNumber& n) { return n.is_live() && n.key == key; });
  };
  for (const std::string& key : scene.live)
    if (!may_change(key))
      k.refuse({"live"}, fmt::format("live.key = \"{}\" is no number of the law in use; "
                                     "tactd SCENE --parameters lists those",
                                     key));
}

}  // namespace

void visit_scene(Keys& k, DeviceKeys device_keys, SceneText& out) {
  Scene& scene = out.scene;
  k.text("name", "of the scene, shown by the viewer", scene.name);
  k.number("rate_Hz", kRate_Hz, "ticks of the control loop", scene.rate_Hz);
  // In the order of the reference page. rate_Hz and law come first: limits and tool ask for them.
  visit_laws(k, scene);
  visit_law_options(k, scene);
  visit_truth(k, scene);
  visit_live(k, scene);
  k.section("organ", "what is touched", [&](Keys& organ) {
    visit_mesh(organ, out.organ_mesh);
    organ.vector("orientation_deg", {-360.0, 360.0},
                 "turn about the mesh's origin, axis times angle", out.organ_orientation_deg,
                 kOptional);
    organ.vector("position_m", kAnywhere_m, "of the mesh's origin, in W", scene.organ.position_m);
  });
  k.section("tool", "the tool in contact with it", visit_tool, out);
  k.section("look", "what the viewer paints; no force depends on it", visit_look, out, kOptional);
  k.section("contact", "between tool and organ", visit_contact, scene);
  k.section("device", "what the hand holds", [&](Keys& device) {
    if (device_keys == nullptr) return device.leave_others();
    device_keys(device, scene.device);
  });
  k.section("hand", "the simulated hand", visit_hand, out);
  k.section("limits", "what the gate lets through",
            [&](Keys& limits) { visit_limits(limits, scene.rate_Hz, scene.limits); });
  k.entries("task", {0, kMaxTasks},
            "what a person is asked to do, in this order; no force depends on it",
            [&](Keys& task) { visit_task(task, scene.tasks.emplace_back()); });
  k.section("telemetry", "what the viewer gets", [&](Keys& telemetry) {
    telemetry.number("frame_rate_Hz", {1.0, 240.0}, "frames for the viewer", scene.frame_rate_Hz);
  });
}

}  // namespace tact::model::scene
