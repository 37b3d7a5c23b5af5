// SPDX-License-Identifier: Apache-2.0
#include "tools/report/picture.h"

#include <fmt/format.h>

#include <filesystem>

#include "model/io/file_writer.h"
#include "tools/program/run_program.h"

namespace tact::tools::report {
namespace {

namespace fs = std::filesystem;
using model::Error;
using model::Result;

constexpr double kTimeLimit_s = 120.0;

std::string head(const Picture& p) {
  std::string out = fmt::format(
      "# Draw again, in this folder: gnuplot -e \"kind='png'\" {0}.gp\n"
      "if (!exists('kind')) kind = 'svg'\n"
      "if (kind eq 'png') {{ set terminal pngcairo size {1},{2} font 'DejaVu Sans,11' }}\n"
      "if (kind eq 'svg') {{ set terminal svg size {1},{2} font 'DejaVu Sans,Arial,14' "
      "background '#ffffff' }}\n"
      "set output '{0}.'.kind\n"
      "set datafile separator ','\n"
      "set datafile columnheaders\n"
      "set encoding utf8\n"
      "set border lc rgb '#444444'\n"
      "set grid lc rgb '#dddddd'\n"
      "set key font ',10' opaque\n"
      "set style textbox opaque noborder fillcolor rgb '#ffffff'\n",
      p.name, p.width_px, p.height_px);
  int i = 0;
  for (const char* ink : kInk) out += fmt::format("set linetype {} lc rgb '{}'\n", ++i, ink);
  return out;
}

}  // namespace

Result<std::vector<std::string>> draw(const Picture& picture, const std::string& directory) {
  std::error_code error;
  const fs::path folder = fs::absolute(directory, error);
  const std::string script = (folder / (picture.name + ".gp")).string();
  if (auto failed = model::io::write_file(script, head(picture) + picture.script)) return *failed;
  std::vector<std::string> files;
  for (const std::string kind : {"svg", "png"}) {
    const std::string log = (folder / (picture.name + ".gnuplot.txt")).string();
    const auto said = program::run_program({.program = "gnuplot",
                                            .arguments = {"-e", "kind='" + kind + "'", script},
                                            .directory = folder.string(),
                                            .log_path = log,
                                            .package = "gnuplot-nox",
                                            .time_limit_s = kTimeLimit_s,
                                            .environment = {}});
    if (!said) return said.error();
    fs::remove(log, error);
    files.push_back((fs::path(directory) / (picture.name + "." + kind)).string());
    if (!fs::exists(files.back()))
      return Error{fmt::format("gnuplot drew no {}; its script is {}", files.back(), script)};
  }
  return files;
}

}  // namespace tact::tools::report
