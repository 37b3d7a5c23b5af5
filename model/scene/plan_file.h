// SPDX-License-Identifier: Apache-2.0
// plan_file.h - the law and size that tact-lab plan chose for a scene on this machine, as the file
// that tools/chart/plan.py writes.
//
// A scene with law = "auto" is felt through it. The file is in the user's cache, named by the
// hash of the scene, so a changed scene has none; it also names the machine that was measured. A
// file that is missing, damaged or of another machine is an error whose remedy is to plan again;
// then the figures of SCENE.accuracy choose, without a time.
// Set-up code only.
#pragma once

#include <string>
#include <vector>

#include "model/result.h"
#include "model/scene/laws.h"
#include "model/scene/scene.h"

namespace tact::model::scene {

/// "rhombus, 65 knots"; a law alone where the sizes are the scene's.
std::string text_of(const LawSizes& sizes);
/// The scene with this law and these sizes.
Scene sized(Scene scene, const LawSizes& sizes);
/// The same as --set values, so that a run can be named and repeated without the plan.
std::vector<std::string> overrides_of(const LawSizes& sizes);
/// " --set KEY=VALUE" for each, quoted for a shell where it must be.
std::string command_text(const std::vector<std::string>& overrides);

struct Plan {
  LawSizes sizes;
  double tick_p999_us = 0.0;
  double force_error_ratio = 0.0;  // RMS, of the peak
  double shape_error_ratio = 0.0;  // RMS, of the depth
  std::string machine;             // machine_name() where it was measured
  std::string scene_hash;          // of the scene that says "auto"
};

/// Processor and number of cores, as the loop's time depends on them.
std::string machine_name();
/// $XDG_CACHE_HOME/tact/plan/HASH.toml, or below $HOME/.cache; an error if neither is set.
Result<std::string> plan_path(const std::string& scene_hash);

/// `scene` is the one to be felt: its hash and this machine must be the plan's. The overrides it
/// was loaded with go into the remedy.
Result<Plan> read_plan(const std::string& path, const Scene& scene,
                       const std::vector<std::string>& overrides);
/// The plan of this scene on this machine, from the cache. With law=auto among the overrides that
/// may be the plan of the scene without it, with any law in its file.
Result<Plan> find_plan(const Scene& scene, const std::vector<std::string>& overrides);
/// That plan. Where this machine has none, as after a fresh clone: the law that the scene's file
/// names, if SCENE.accuracy has its figure, else the one there with the least worst error; its
/// sizes as the scene says, `machine` empty.
Result<Plan> find_auto_law(const Scene& scene, const std::vector<std::string>& overrides);

}  // namespace tact::model::scene
