// SPDX-License-Identifier: Apache-2.0
// sweep_report.h - what tact-lab sweep writes and says of a sweep.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "model/scene/press_sweep.h"
#include "model/scene/scene.h"
#include "tools/report/table.h"

namespace tact::tools::sweep {

/// One row a press, in the order of the places.
report::Table presses_table(const model::scene::Scene& scene,
                            const model::scene::PressSweep& sweep);
/// The job of lab/picture.py: the largest slope of each place, seen from above, and how often which
/// slope occurs.
nlohmann::json presses_picture(const model::scene::PressSweep& sweep, const std::string& folder);

/// The command that repeats one press and writes its force along the way.
std::string command_to_repeat(const std::string& command, const model::scene::PressPoint& place);

/// The result for people; `command`: as it was typed.
std::string text_of(const model::scene::PressSweep& sweep, const std::string& command,
                    std::size_t worst);
/// The same as JSON text; `files` that were written.
std::string json_of(const model::scene::Scene& scene, const model::scene::PressSweep& sweep,
                    const std::string& command, const std::vector<std::string>& files);

}  // namespace tact::tools::sweep
