// SPDX-License-Identifier: Apache-2.0
#include "model/io/program/completion.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <vector>

namespace tact::model::io {
namespace {

constexpr const char* kScript = R"~(# bash completion of {0}, made by {0} --bash-completion
{1}() {{
  local now=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} words=
  case ${{COMP_WORDS[1]}}:$before in
{2}  esac
  COMPREPLY=()
  [ -z "$words" ] || mapfile -t COMPREPLY < <(compgen -W "$words" -- "$now")
}}
complete -o bashdefault -o default -F {1} {0}
)~";

/// "a b" of a type that is described as TEXT:{a,b}; empty for any other.
std::string listed_values(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t begin = type.find('{'), end = type.find('}');
  if (begin == std::string::npos || end == std::string::npos) return {};
  std::string values = type.substr(begin + 1, end - begin - 1);
  std::ranges::replace(values, ',', ' ');
  return values;
}

/// What is offered behind the subcommand `part`; of the program itself, "*".
std::string cases_of(const CLI::App& app, const std::string& part) {
  std::string cases, options, others;
  for (const CLI::App* below : app.get_subcommands([](const CLI::App*) { return true; })) {
    cases += cases_of(*below, below->get_name());
    others += below->get_name() + " ";
  }
  for (const CLI::Option* option : app.get_options()) {
    const std::string values = listed_values(*option);
    std::vector<std::string> names;
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
    for (const std::string& name : names) {
      options += name + " ";
      if (option->get_items_expected_max() > 0)
        cases += fmt::format("    {}:{}) words='{}' ;;\n", part, name, values);
    }
    // A positional argument: its values stand where no option is asked for.
    if (names.empty()) others += values + (values.empty() ? "" : " ");
  }
  return cases + fmt::format("    {}:*) case $now in -*) words='{}' ;; *) words='{}' ;; esac ;;\n",
                             part, options, others);
}

}  // namespace

std::string bash_completion(const CLI::App& options, const std::string& program) {
  std::string function = "_" + program;
  // Not every shell takes dashes in the name of a function.
  std::ranges::replace(function, '-', '_');
  return fmt::format(fmt::runtime(kScript), program, function, cases_of(options, "*"));
}

}  // namespace tact::model::io
