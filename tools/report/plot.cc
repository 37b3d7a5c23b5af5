// SPDX-License-Identifier: Apache-2.0
#include "tools/report/plot.h"

#include <fmt/format.h>

#include <filesystem>

#include "model/io/file_writer.h"
#include "tools/program/run_program.h"
#include "tools/report/scripts.h"

namespace tact::tools::report {
namespace {

namespace fs = std::filesystem;
using model::Error;
using model::Result;

constexpr double kTimeLimit_s = 120.0;

std::string gnuplot_text(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out.append(c == '\'' ? 2 : 1, c);
  return out + "'";
}

std::string line_of(const std::string& name, const Value& value) {
  if (const auto* number = std::get_if<double>(&value))
    return fmt::format("{} = {}\n", name, *number);
  if (const auto* text = std::get_if<std::string>(&value))
    return name[0] == '$' ? fmt::format("{} << EOD\n{}EOD\n", name, *text)
                          : fmt::format("{} = {}\n", name, gnuplot_text(*text));
  std::string list;
  for (const std::string& word : std::get<std::vector<std::string>>(value))
    list += '"' + word + "\" ";
  return fmt::format("{} = {}\n", name, gnuplot_text(list));
}

std::string whole_script(const Plot& p) {
  std::string out = fmt::format(
      "# Draw again, in this folder: gnuplot -e \"kind='png'\" {}.gp\nname = {}\nwidth_px = {}\n"
      "height_px = {}\n{}",
      p.name, gnuplot_text(p.name), p.width_px, p.height_px, kPlotScript);
  for (const auto& [name, value] : p.variables) out += line_of(name, value);
  return out + p.script;
}

}  // namespace

Result<std::vector<std::string>> draw(const Plot& plot, const std::string& directory) {
  std::error_code error;
  const fs::path folder = fs::absolute(directory, error);
  const std::string script = (folder / (plot.name + ".gp")).string();
  if (auto failed = model::io::write_file(script, whole_script(plot))) return *failed;
  std::vector<std::string> files;
  for (const std::string kind : {"svg", "png"}) {
    const std::string log = (folder / (plot.name + ".gnuplot.txt")).string();
    const auto said = program::run_program({.program = "gnuplot",
                                            .arguments = {"-e", "kind='" + kind + "'", script},
                                            .directory = folder.string(),
                                            .log_path = log,
                                            .package = "gnuplot-nox",
                                            .time_limit_s = kTimeLimit_s,
                                            .environment = {}});
    if (!said) return said.error();
    fs::remove(log, error);
    files.push_back((fs::path(directory) / (plot.name + "." + kind)).string());
    if (!fs::exists(files.back()))
      return Error{fmt::format("gnuplot drew no {}; its script is {}", files.back(), script)};
  }
  return files;
}

}  // namespace tact::tools::report
