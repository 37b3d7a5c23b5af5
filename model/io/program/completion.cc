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
  case $before in
{2}    *) case $now in -*) words='{3}' ;; *) words='{4}' ;; esac ;;
  esac
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

struct Words {
  std::string cases, options, others;

  void add(const CLI::App& app) {
    for (const CLI::Option* option : app.get_options()) add(*option);
    for (const CLI::App* part : app.get_subcommands([](const CLI::App*) { return true; })) {
      others += part->get_name() + " ";
      add(*part);
    }
  }
  void add(const CLI::Option& option) {
    const std::string values = listed_values(option);
    std::vector<std::string> names;
    for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option.get_snames()) names.push_back("-" + name);
    for (const std::string& name : names) options += name + " ";
    // A positional argument: its values stand where no option is asked for.
    if (names.empty()) others += values + (values.empty() ? "" : " ");
    if (!names.empty() && option.get_items_expected_max() > 0)
      cases += fmt::format("    {}) words='{}' ;;\n", fmt::join(names, " | "), values);
  }
};

}  // namespace

std::string bash_completion(const CLI::App& options, const std::string& program) {
  Words words;
  words.add(options);
  std::string function = "_" + program;
  // Not every shell takes dashes in the name of a function.
  std::ranges::replace(function, '-', '_');
  return fmt::format(fmt::runtime(kScript), program, function, words.cases, words.options,
                     words.others);
}

}  // namespace tact::model::io
