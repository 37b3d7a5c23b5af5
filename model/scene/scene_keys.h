// SPDX-License-Identifier: Apache-2.0
// scene_keys.h - the format of a scene: scene_keys.cc states every key once.
//
// To add a key, add one line there: its name ending in its unit, the allowed range, what it means
// and the variable it fills. The reader, its errors and the reference page follow from that line;
// a test asks for the key in a shipped scene. The keys of a law stand in visit() of its header,
// which the rows of laws.cc name. Set-up code only.
#pragma once

#include <string>

#include "model/reader/scene_reader.h"
#include "model/scene/scene.h"
#include "model/scene/scene_strokes.h"

namespace tact::model::scene {

using Need::kOptional;
using reader::Keys;

/// A mesh as the scene names it.
struct MeshText {
  std::string file;  // relative to the scene file
  double unit_m = 0.001;
  reader::TextPosition position;
};

/// A scene before its meshes are read and its strokes become way points.
struct SceneText {
  Scene scene;
  MeshText organ_mesh;
  reader::TextPosition vertex_colors_position;
  Vec3 organ_orientation_deg;  // axis times angle, about the mesh's origin
  MeshText tool_mesh;
  HandScript script;
};

/// Reads every key into `out`, or describes them all.
void visit_scene(reader::Keys& root, DeviceKeys device_keys, SceneText& out);

// Parts of it, in scene_laws.cc: `law` and the sections of all laws; the chosen one must be there.
void visit_laws(reader::Keys& root, Scene& scene);
/// [pull] and [relaxation], of any law.
void visit_law_options(reader::Keys& root, Scene& scene);
/// [elastic], [[reference_site]] and [tolerance]: what reference, fit and plan of tact-lab ask.
void visit_truth(reader::Keys& root, Scene& scene);

}  // namespace tact::model::scene
