// SPDX-License-Identifier: Apache-2.0
// plot.h - a plot by gnuplot: SVG for pages, PNG for everything else.
//
// The script is a file NAME.gp of the sources, of which CMake makes a constant (tact_room_scripts).
// It plots files of its own folder and names neither terminal nor output. What the program knows
// is in front of it as variables. All of it is kept beside the plot as NAME.gp, so anyone
// can draw it again, or another way, from that folder:
//
//     gnuplot -e "kind='png'" NAME.gp
#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "model/result.h"

namespace tact::tools::report {

/// A number, a text, or a list for words() and word(). Of a name with $: the rows of a data block.
using Value = std::variant<double, std::string, std::vector<std::string>>;
using Variables = std::vector<std::pair<std::string, Value>>;

struct Plot {
  std::string name{};  // of the files, without ending
  int width_px = 1200;
  int height_px = 800;
  std::string script{};
  Variables variables{};
};

/// Draws NAME.svg and NAME.png into a folder and returns their paths. An error says what to install
/// or what gnuplot had to say.
model::Result<std::vector<std::string>> draw(const Plot& plot, const std::string& directory);

}  // namespace tact::tools::report
