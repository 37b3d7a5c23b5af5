// SPDX-License-Identifier: Apache-2.0
#include "tools/program/script.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "model/io/program/installed.h"

namespace tact::tools::program {

model::Error become_script(const std::string& script, std::vector<std::string> arguments,
                           const std::string& package) {
  const std::string path = model::io::data_file(script).string();
  if (path.empty())
    return {fmt::format("{} is missing; apt install --reinstall {}", script, package)};
  // -I: independent of PYTHONPATH.
  arguments.insert(arguments.begin(), {"python3", "-I", path});
  std::vector<char*> words;
  words.reserve(arguments.size() + 1);
  for (std::string& word : arguments) words.push_back(word.data());
  words.push_back(nullptr);
  std::fflush(nullptr);  // what we have printed would be lost
  execv("/usr/bin/python3", words.data());
  return {"/usr/bin/python3 does not start; apt install python3"};
}

}  // namespace tact::tools::program
