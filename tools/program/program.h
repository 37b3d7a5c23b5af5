// SPDX-License-Identifier: Apache-2.0
// program.h - what every measuring program does alike: options, one-line errors, Ctrl-C, status.
//
//     Exit status   0 good,   1 a check failed or Ctrl-C,   2 bad usage or input
//
//     Program program("tact-doctor", "Is this PC fit ...", "ns: nanoseconds ...");
//     program.options().add_flag(...);
//     if (const auto status = program.parse(argc, argv)) return *status;
//
// or, with subcommands, each with options of its own:
//
//     Program lab("tact-lab", "makes, measures ...", "Options of each: ...");
//     lab.add<Options>("chart", "speed against accuracy", "Errors are ...", add_options, measure);
//     return lab.run(argc, argv);
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/result.h"
#include "model/scene/scene.h"
#include "tools/program/interrupt.h"

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
  /// A subcommand: `purpose` is its line in --help of the program; its own --help adds the options
  /// and `footer`. `act` gives the exit status, or an error, which is reported in one line.
  template <typename Options>
  void add(const std::string& name, const std::string& purpose, const std::string& footer,
           void (*add_options)(CLI::App&, Options&),
           model::Result<int> (*act)(const Program&, Options&)) {
    const auto options = std::make_shared<Options>();
    add_options(add_part(name, purpose, footer), *options);
    parts_[name] = [options, act](const Program& program) { return act(program, *options); };
  }
  /// Parses, and runs the subcommand that was named; the exit status.
  int run(int argc, char** argv);

  /// From here on Ctrl-C is a question (interrupt.h). The exit status if the program ends here:
  /// after --help, or with a bad option.
  std::optional<int> parse(int argc, char** argv);
  /// Reports an error in one line and gives the exit status; `kept`: what Ctrl-C leaves behind.
  int fail(const model::Error& error, std::string_view kept = "nothing was written") const;
  /// As it was typed, for the head of a result.
  const std::string& command() const { return command_; }

 private:
  CLI::App& add_part(const std::string& name, const std::string& purpose,
                     const std::string& footer);

  std::string name_, part_, command_;  // part_: " chart" once it was named
  std::unique_ptr<CLI::App> options_;
  std::map<std::string, std::function<model::Result<int>(const Program&)>> parts_;
  std::optional<InterruptFlag> watch_;
};

/// SCENE and --set.
struct SceneArguments {
  std::string path;
  std::vector<std::string> overrides;
  bool trust_library = false;  // the vendor's, whichever user owns the file

  void add_to(CLI::App& options, const std::string& needs = "");
  /// A program that opens no device needs no keys of devices.
  model::Result<model::scene::Scene> load(model::scene::DeviceKeys device_keys = nullptr) const;
};

/// Makes the folder and tries to write there, before an hour of work; an error says what to do.
std::optional<model::Error> prepare_folder(const std::string& directory);
/// Refuses, before the work, an output that is one of the inputs or that write_file would refuse;
/// `beginning`: of what will be written.
std::optional<model::Error> check_output(const std::string& output, std::string_view beginning,
                                         const std::vector<std::string>& inputs);

}  // namespace tact::tools::program
