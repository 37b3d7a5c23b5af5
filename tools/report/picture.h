// SPDX-License-Identifier: Apache-2.0
// picture.h - a picture by gnuplot: SVG for pages, PNG for everything else.
//
// The script plots files of its own folder and names neither terminal nor output. It is kept beside
// the picture as NAME.gp, so anyone can draw it again, or another way, from that folder:
//
//     gnuplot -e "kind='png'" NAME.gp
#pragma once

#include <string>
#include <vector>

#include "model/result.h"

namespace tact::tools::report {

struct Picture {
  std::string name;  // of the files, without ending
  int width_px = 1200;
  int height_px = 800;
  std::string script;
};

/// Draws NAME.svg and NAME.png into a folder and returns their paths. An error says what to install
/// or what gnuplot had to say.
model::Result<std::vector<std::string>> draw(const Picture& picture, const std::string& directory);

/// Colours that people with any colour vision tell apart (Okabe, Ito 2008), as gnuplot words.
inline constexpr const char* kInk[] = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                       "#E69F00", "#56B4E9", "#000000", "#999999"};

}  // namespace tact::tools::report
