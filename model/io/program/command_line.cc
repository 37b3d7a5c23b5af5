// SPDX-License-Identifier: Apache-2.0
#include "model/io/program/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <string_view>

namespace tact::model::io {

namespace {

/// "" or "--json=": what a shell makes of a variable that is not set.
bool is_empty_value(std::string_view word) {
  return word.empty() || (word.starts_with("--") && word.find('=') == word.size() - 1);
}

/// With the subcommand that was named, as in its --help.
std::string refusal(const CLI::App& options, const char* program, std::string_view message) {
  std::string name = program;
  for (const CLI::App* part : options.get_subcommands()) name += " " + part->get_name();
  return fmt::format("{0}: {1}; see {0} --help\n", name, message);
}

}  // namespace

std::optional<int> parse_command_line(CLI::App& options, const char* program, int argc,
                                      const char* const* argv,
                                      const std::function<std::optional<Error>()>& check) {
  // CLI11's own words take two lines and do not name the program.
  options.failure_message([program](const CLI::App* app, const CLI::Error& error) {
    return refusal(*app, program, error.what());
  });
  options.set_version_flag("--version",
                           fmt::format("{} {} ({}), compiler {}", program, tact_version(),
                                       source_revision(), compiler_version()));
  // Before the library parses: it would take an empty argument for a value.
  if (const char* const* empty =
          std::find_if(argv + std::min(argc, 1), argv + argc, is_empty_value);
      empty != argv + argc) {
    fmt::print(stderr, "{0}: argument {1} is empty: is a variable not set? See {0} --help\n",
               program, empty - argv);
    return 2;
  }
  try {
    options.parse(argc, argv);
  } catch (const CLI::ParseError& error) {  // the library's way, --help included
    return options.exit(error) == 0 ? 0 : 2;
  }
  if (const auto error = check ? check() : std::nullopt) {
    fmt::print(stderr, "{}", refusal(options, program, error->message));
    return 2;
  }
  return std::nullopt;
}

}  // namespace tact::model::io
