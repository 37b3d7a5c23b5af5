// SPDX-License-Identifier: Apache-2.0
// script.h - a subcommand whose work is a Python script: the organ that it needs, and how it runs.
#pragma once

#include <nlohmann/json.hpp>

#include "model/scene/scene.h"
#include "tools/program/program.h"

namespace tact::tools::lab {

nlohmann::json list_of(const model::Vec3& v);

/// A scene with [elastic]; an error says how to give it.
model::Result<model::scene::Scene> elastic_scene(const program::SceneArguments& arguments);

/// The organ of a scene with [elastic], in its mesh's own frame.
nlohmann::json organ_of(const model::scene::Scene& scene);

/// --finite-strain of chart and plan.
void add_finite_strain(CLI::App& app, std::string& path);

enum class AfterCtrlC { kNot, kToo };

/// The script, `job` as its argument, takes our place, and so Ctrl-C, our output and our exit
/// status. It comes back only if that fails. `script`: of tools/ and share/tact.
model::Result<int> become(const char* script, const nlohmann::json& job,
                          AfterCtrlC when = AfterCtrlC::kNot);

/// Draws a picture by lab/picture.py, if the job is not empty, then prints; the exit status.
model::Result<int> finish(model::Result<nlohmann::json> picture, const std::string& text,
                          int status);

}  // namespace tact::tools::lab
