// SPDX-License-Identifier: Apache-2.0
#include "tools/new_scene/choose_law.h"

#include "model/io/program/installed.h"
#include "model/scene/plan_file.h"
#include "model/scene/scene.h"
#include "tools/program/run_program.h"

namespace tact::tools::new_scene {
namespace {

/// A program beside this one.
program::ProgramCall call_of(const char* name, std::vector<std::string> arguments,
                             const std::string& log_path) {
  return {.program = (model::io::program_folder() / name).string(),
          .arguments = std::move(arguments),
          .directory = ".",
          .log_path = log_path,
          .package = "tact-lab",
          .environment = {}};
}

}  // namespace

model::Result<bool> choose_law(
    const OutputNames& files, const std::string& log_path,
    const std::function<void(const char* step, const std::string& text)>& tell) {
  const auto no_plan = [&tell](const model::Error& error) -> model::Result<bool> {
    if (program::was_interrupted(error)) return error;
    tell("plan", "none: " + error.sentence);
    return false;
  };
  tell("reference", "one sphere, by CalculiX: minutes for thousands of vertices");
  auto ran =
      run_program(call_of("tact-reference", {files.scene, "--out", files.reference}, log_path));
  if (!ran) return no_plan(ran.error());
  tell("reference", "the whole tool, by finite elements: as long again");
  ran = run_program(call_of("tact-reference",
                            {files.scene, "--tool", "--level", "1", "--out", files.tool_reference},
                            log_path));
  if (!ran) return no_plan(ran.error());
  auto plan = call_of(
      "tact-plan",
      {files.scene, "--reference", files.reference, "--tool-reference", files.tool_reference},
      log_path);
  plan.any_status = true;  // 1: no law is good enough, as it has told
  plan.on_line = [&tell](std::string_view line) { tell("plan", std::string(line)); };
  ran = run_program(plan);
  if (!ran) return no_plan(ran.error());
  const auto scene = model::scene::load_scene(files.scene, {});
  if (!scene) return no_plan(scene.error());
  return static_cast<bool>(model::scene::find_plan(*scene, {}));
}

}  // namespace tact::tools::new_scene
