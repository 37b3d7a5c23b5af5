// SPDX-License-Identifier: Apache-2.0
// tact-mcap: a tick log, a black box or a recording for Foxglove, PlotJuggler and ROS 2.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>
#include <string>

#include "model/io/json.h"
#include "model/io/program/command_line.h"
#include "model/io/program/program_end.h"
#include "tools/mcap/export_run.h"

namespace {

constexpr int kGood = 0, kCheckFailed = 1, kBadInput = 2;

int run(const std::string& from, const std::string& to, bool json) {
  const auto done = tact::tools::mcap::export_run(from, to);
  if (!done) {
    fmt::print(stderr, "tact-mcap: {}\n", done.error().sentence);
    return kBadInput;
  }
  // What is whole was written: a log that a crash cut off is still worth looking at.
  if (!done->damage.empty())
    fmt::print(stderr, "tact-mcap: {}: {}; what is whole is in {}\n", from, done->damage, to);
  if (json) {
    const nlohmann::json told{
        {"format", "tact-mcap"},      {"version", 1},           {"file", to},
        {"ticks", done->ticks},       {"frames", done->frames}, {"messages", done->messages},
        {"length_s", done->length_s}, {"damage", done->damage}};
    fmt::print("{}\n", tact::model::io::text_of(told));
  } else {
    fmt::print("{}: {} ticks, {} frames, {:.1f} s\n", to, done->ticks, done->frames,
               done->length_s);
  }
  return done->damage.empty() ? kGood : kCheckFailed;
}

}  // namespace

int main(int argc, char** argv) {
  tact::model::io::watch_standard_output("tact-mcap");
  tact::model::io::tell_uncaught("tact-mcap");
  std::string from, to;
  bool json = false;
  CLI::App app{
      "tact-mcap: a tick log, a black box or a recording as MCAP, for Foxglove, PlotJuggler and\n"
      "ROS 2: pose (m), force (N) and torque (Nm) written and wanted, state, fault and margin "
      "(us).\n"
      "Exit status: 0 good, 1 the input is damaged and what is whole was written, 2 bad usage or\n"
      "input."};
  app.add_option("in", from, "of tactd --record, of tact-view --record, or a black box of tactd")
      ->required();
  app.add_option("out", to, "the file to write, OUT.mcap")->required();
  app.add_flag("--json", json, "say what was written as one line of JSON");
  if (const auto status = tact::model::io::parse_command_line(app, "tact-mcap", argc, argv))
    return *status;
  try {
    return run(from, to, json);
  } catch (const std::exception& error) {  // a library's, when memory or descriptors run out
    fmt::print(stderr, "tact-mcap: {}\n", error.what());
    return kBadInput;
  }
}
