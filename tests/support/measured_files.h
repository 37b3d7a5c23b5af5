// SPDX-License-Identifier: Apache-2.0
// measured_files.h - SCENE.accuracy and a plan as tools/chart/tool.py and plan.py write them.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "model/io/seal.h"
#include "model/scene/accuracy_file.h"
#include "model/scene/plan_file.h"

namespace tact::tests {

inline std::string accuracy_text(const std::vector<model::scene::Accuracy>& laws) {
  std::string out = "schema = \"tact-accuracy/2\"\n";
  for (const model::scene::Accuracy& a : laws)
    out += fmt::format(
        "[{}]\nlaw_hash = \"{}\"\nreference = \"{}\"\ndate = \"{}\"\nlarge_strain_off = {}\n"
        "force_rms_ratio = {}\nwithin_noticeable_ratio = {}\ndepth_m = [{}]\n"
        "own_worst_ratio = [{}]\n",
        a.law, a.law_hash, a.reference, a.date, a.large_strain_off, a.rms_ratio,
        a.within_noticeable_ratio, fmt::join(a.depth_m, ", "), fmt::join(a.own_worst_ratio, ", "));
  return out;
}

inline std::string plan_text(const model::scene::Plan& plan) {
  const model::scene::LawRow* law = model::scene::find_law(plan.sizes.law);
  std::string out =
      fmt::format("law = \"{}\"\ntable_knots = {}\n", plan.sizes.law, plan.sizes.table_knots);
  if (law != nullptr && !law->size_key.empty())
    out += fmt::format("{} = {}\n", law->size_key, plan.sizes.size);
  return model::io::sealed_text(
      out + fmt::format("tick_p999_us = {}\nforce_error_ratio = {}\nshape_error_ratio = {}\n"
                        "machine = \"{}\"\nscene_hash = \"{}\"\n",
                        plan.tick_p999_us, plan.force_error_ratio, plan.shape_error_ratio,
                        plan.machine, plan.scene_hash));
}

inline void write_plan(const model::scene::Plan& plan, const std::string& path) {
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  std::ofstream(path) << plan_text(plan);
}

}  // namespace tact::tests
