// SPDX-License-Identifier: Apache-2.0
#include "tools/program/program.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <thread>

#include "model/io/file_writer.h"
#include "model/io/program/command_line.h"
#include "model/io/program/program_end.h"
#include "tools/program/run_program.h"

namespace tact::tools::program {

namespace fs = std::filesystem;
using model::Error;
using model::Result;

namespace {

constexpr const char* kStatus =
    "\nExit status: 0 good, 1 a check failed or Ctrl-C, 2 bad usage or input.";

// What long work cost, with the programs that it ran; "285 CPU s on up to 2 cores, 1.4 GB at most".
void print_cost(const std::string& who) {
  constexpr double kLong_s = 10.0;  // chosen
  rusage own{}, children{};
  getrusage(RUSAGE_SELF, &own);
  getrusage(RUSAGE_CHILDREN, &children);
  const auto in_s = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  const double cpu_s =
      in_s(own.ru_utime) + in_s(own.ru_stime) + in_s(children.ru_utime) + in_s(children.ru_stime);
  if (cpu_s < kLong_s) return;
  const double peak_GB =
      1e-6 * 1.024 * static_cast<double>(std::max(own.ru_maxrss, children.ru_maxrss));
  fmt::print(stderr, "{}: {:.0f} CPU s on up to {} cores, {:.2g} GB at most\n", who, cpu_s,
             std::max(1U, std::thread::hardware_concurrency()), peak_GB);
}

}  // namespace

Program::Program(std::string name, const std::string& purpose, const std::string& footer)
    : name_(std::move(name)), options_(std::make_unique<CLI::App>(purpose)) {
  options_->footer(footer + kStatus);
}

Program::~Program() = default;

std::optional<int> Program::parse(int argc, char** argv) {
  model::io::watch_standard_output(name_.c_str());
  model::io::report_uncaught(name_.c_str());
  for (int i = 0; i < argc; ++i) command_ += fmt::format("{}{}", i > 0 ? " " : "", argv[i]);
  if (const auto status = model::io::parse_command_line(*options_, name_.c_str(), argc, argv))
    return status;
  watch_.emplace();
  return std::nullopt;
}

CLI::App& Program::add_part(const std::string& name, const std::string& purpose,
                            const std::string& footer) {
  options_->require_subcommand(1);
  CLI::App* part = options_->add_subcommand(name, purpose);
  part->footer(footer + kStatus);
  return *part;
}

int Program::run(int argc, char** argv) {
  options_->set_help_all_flag("--help-all", "this, and the options of every subcommand");
  if (const auto status = parse(argc, argv)) return *status;
  const std::string part = options_->get_subcommands().front()->get_name();
  part_ = " " + part;
  const auto status = parts_.at(part)(*this);
  print_cost(name_ + part_);
  return status ? *status : fail(status.error());
}

int Program::fail(const Error& error, std::string_view kept) const {
  const bool interrupted = was_interrupted(error);
  fmt::print(stderr, "{}{}: {}\n", name_, part_,
             interrupted ? fmt::format("interrupted; {}", kept) : error.message);
  return interrupted ? 1 : 2;
}

void SceneArguments::add_to(CLI::App& options, const std::string& needs) {
  options.add_option("SCENE", path, "scene file (TOML)" + (needs.empty() ? "" : " with " + needs))
      ->required();
  options.add_option("--set", overrides, "one key of the scene, as KEY=VALUE; repeatable");
}

Result<model::scene::Scene> SceneArguments::load(model::scene::DeviceKeys device_keys) const {
  auto scene = model::scene::load_scene(path, overrides, device_keys);
  if (scene) scene->device.trust_library = trust_library;
  return scene;
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
