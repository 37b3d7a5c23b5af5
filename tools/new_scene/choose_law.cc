// SPDX-License-Identifier: Apache-2.0
#include "tools/new_scene/choose_law.h"

#include "model/io/program/installed.h"
#include "tools/program/run_program.h"

namespace tact::tools::new_scene {

model::Result<std::vector<std::string>> ask(const char* program,
                                            const std::vector<std::string>& arguments,
                                            const std::string& log_path) {
  std::vector<std::string> lines;
  const auto ran = program::run_program(
      {.program = (model::io::program_folder() / program).string(),
       .arguments = arguments,
       .directory = ".",
       .log_path = log_path,
       .package = "tact tact-lab",
       .environment = {},
       .on_line = [&lines](std::string_view line) { lines.emplace_back(line); }});
  if (ran) return lines;
  if (program::was_interrupted(ran.error()) || lines.empty()) return ran.error();
  return model::Error{lines.back()};
}

std::optional<model::Error> choose_law(
    const OutputNames& files, const std::string& log_path,
    const std::function<void(const char* step, const std::string& text)>& report) {
  report("reference", "one sphere, by CalculiX: minutes for thousands of vertices");
  auto answer = ask("tact-lab", {"reference", files.scene, "--out", files.reference}, log_path);
  if (!answer) return answer.error();
  report("reference", "the whole tool, by finite elements: as long again");
  // Level 1: the places are nine, and a finer mesh changes their force by 2 %.
  answer = ask("tact-lab",
               {"reference", files.scene, "--tool", "--level", "1", "--out", files.tool_reference},
               log_path);
  if (!answer) return answer.error();
  answer = ask("tact-lab",
               {"plan", files.scene, "--reference", files.reference, "--tool-reference",
                files.tool_reference},
               log_path);
  if (!answer) return answer.error();
  for (const std::string& line : *answer) report("plan", line);
  answer = ask("tactd", {files.scene, "--check"}, log_path);
  return answer ? std::nullopt : std::optional(answer.error());
}

}  // namespace tact::tools::new_scene
