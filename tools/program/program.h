// SPDX-License-Identifier: Apache-2.0
// program.h - what every measuring program does alike: options, one-line errors, Ctrl-C, status.
//
//     Exit status   0 good,   1 a check failed or Ctrl-C,   2 bad usage or input
//
//     Program program("tact-chart", "Measure every law of the scene ...", "Errors are ratios ...");
//     SceneArguments scene;
//     scene.add_to(program.options());
//     if (const auto status = program.parse(argc, argv)) return *status;
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/result.h"
#include "model/scene/scene.h"
#include "tools/program/interrupt.h"
#include "tools/program/sweep.h"

namespace CLI {
class App;
}

namespace tact::tools::program {

class Program {
 public:
  /// `footer`: units and what else --help says below the options; the exit status is added.
  Program(std::string name, const std::string& purpose, const std::string& footer);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  CLI::App& options() { return *options_; }
  /// From here on Ctrl-C is a question (interrupt.h). The exit status if the program ends here:
  /// after --help, or with a bad option.
  std::optional<int> parse(int argc, char** argv);
  /// Tells an error in one line and gives the exit status; `kept`: what Ctrl-C leaves behind.
  int fail(const model::Error& error, std::string_view kept = "nothing was written") const;
  /// As it was typed, for the head of a result.
  const std::string& command() const { return command_; }

 private:
  std::string name_, command_;
  std::unique_ptr<CLI::App> options_;
  std::optional<InterruptWatch> watch_;
};

/// SCENE and --set.
struct SceneArguments {
  std::string path;
  std::vector<std::string> overrides;
  bool trust_library = false;  // of the maker, whoever's file it is

  void add_to(CLI::App& options, const std::string& needs = "");
  model::Result<model::scene::Scene> load() const;
};

/// --shard, --merge, --quick and --no-pictures of a sweep that many machines may share.
struct SweepArguments {
  Shard shard;
  std::vector<std::string> merge;
  bool quick = false, no_pictures = false;

  void add_to(CLI::App& options, const std::string& row, const std::string& quick_means);
  /// After parse(): the shard from its text, and a folder that can be written to.
  std::optional<model::Error> prepare(const std::string& out_directory);

 private:
  std::string shard_text_;
};

/// Makes the folder and tries to write there, before an hour of work; an error says what to do.
std::optional<model::Error> prepare_folder(const std::string& directory);
/// Refuses, before the work, an output that is one of the inputs or that write_file would refuse;
/// `beginning`: of what will be written.
std::optional<model::Error> check_output(const std::string& output, std::string_view beginning,
                                         const std::vector<std::string>& inputs);

}  // namespace tact::tools::program
