// SPDX-License-Identifier: Apache-2.0
#include "tools/new_scene/ask.h"

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

}  // namespace tact::tools::new_scene
