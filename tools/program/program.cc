// SPDX-License-Identifier: Apache-2.0
#include "tools/program/program.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "model/io/file_writer.h"
#include "model/io/program/command_line.h"
#include "model/io/program/program_end.h"
#include "tools/program/run_program.h"

namespace tact::tools::program {

namespace fs = std::filesystem;
using model::Error;
using model::Result;

Program::Program(std::string name, const std::string& purpose, const std::string& footer)
    : name_(std::move(name)), options_(std::make_unique<CLI::App>(purpose)) {
  options_->footer(footer +
                   "\nExit status: 0 good, 1 a check failed or Ctrl-C, 2 bad usage or input.");
}

Program::~Program() = default;

std::optional<int> Program::parse(int argc, char** argv) {
  model::io::watch_standard_output(name_.c_str());
  model::io::tell_uncaught(name_.c_str());
  for (int i = 0; i < argc; ++i) command_ += fmt::format("{}{}", i > 0 ? " " : "", argv[i]);
  if (const auto status = model::io::parse_command_line(*options_, name_.c_str(), argc, argv))
    return status;
  watch_.emplace();
  return std::nullopt;
}

int Program::fail(const Error& error, std::string_view kept) const {
  const bool interrupted = was_interrupted(error);
  fmt::print(stderr, "{}: {}\n", name_,
             interrupted ? fmt::format("interrupted; {}", kept) : error.sentence);
  return interrupted ? 1 : 2;
}

void SceneArguments::add_to(CLI::App& options, const std::string& needs) {
  options.add_option("SCENE", path, "scene file (TOML)" + (needs.empty() ? "" : " with " + needs))
      ->required();
  options.add_option("--set", overrides, "one key of the scene, as KEY=VALUE; repeatable");
}

Result<model::scene::Scene> SceneArguments::load() const {
  auto scene = model::scene::load_scene(path, overrides);
  if (scene) scene->device.trust_library = trust_library;
  return scene;
}

void SweepArguments::add_to(CLI::App& options, const std::string& row,
                            const std::string& quick_means) {
  auto* shard_option = options.add_option(
      "--shard", shard_text_, fmt::format("i/n: every n-th {} from i on, 0 <= i < n", row));
  options.add_option("--merge", merge, "CSVs of all shards: the table of one whole run")
      ->excludes(shard_option);
  options.add_flag("--quick", quick, quick_means);
  options.add_flag("--no-pictures", no_pictures, "tables alone; needs no gnuplot");
}

std::optional<Error> SweepArguments::prepare(const std::string& out_directory) {
  if (!shard_text_.empty()) {
    const auto parsed = parse_shard(shard_text_);
    if (!parsed) return parsed.error();
    shard = *parsed;
  }
  return prepare_folder(out_directory);
}

std::optional<Error> prepare_folder(const std::string& directory) {
  std::error_code failed;
  fs::create_directories(directory, failed);
  if (!fs::is_directory(directory) || access(directory.c_str(), W_OK) != 0)
    return Error{fmt::format("{}: no folder that can be written to; name another", directory)};
  return std::nullopt;
}

std::optional<Error> check_output(const std::string& output, std::string_view beginning,
                                  const std::vector<std::string>& inputs) {
  if (output.empty()) return std::nullopt;
  std::error_code failed;
  for (const std::string& input : inputs)
    if (!input.empty() && fs::equivalent(output, input, failed))
      return Error{fmt::format("{}: would be overwritten, and is read; name another", output)};
  return model::io::check_target(output, beginning);
}

}  // namespace tact::tools::program
