// SPDX-License-Identifier: Apache-2.0
#include "tools/figures/figures.h"

#include "tools/figures/scripts.h"

namespace tact::tools::figures {
namespace {

struct Size {
  int width_px = 900, height_px = 600;
};

Figure figure(const char* name, const char* of, const char* shows, const char* script, Rows curves,
              std::vector<Printed> numbers = {}, Size size = {}) {
  return {of,
          shows,
          {name, size.width_px, size.height_px, script},
          report::Table(name, std::move(curves)),
          std::move(numbers)};
}

}  // namespace

std::vector<Figure> all_figures() {
  return {
      figure("rhombus_units", "[1] figs. 5 to 7",
             "how the units of a pressed and of a pulled chain share its deformation",
             kRhombusUnitsScript, rhombus_units()),
      figure("disc_layers", "[2] fig. 3", "force and delay of the layers, with the worked example",
             kDiscLayersScript, disc_layers(), disc_example()),
      figure("skin_rings", "[3] fig. 5",
             "force over the number of rings: as printed it has no limit", kSkinRingsScript,
             skin_rings()),
      figure("skin_dent", "[3] fig. 6", "dent of 25 rings for several strains of the first spring",
             kSkinDentScript, near_field_indentation()),
      figure("skin_press", "[3] fig. 8", "force of a press over time", kSkinPressScript,
             skin_press()),
      figure("euler_methods", "[4] fig. 2",
             "errors of explicit Euler, implicit Euler and RK4 on one equation",
             kEulerMethodsScript, euler_methods()),
      figure("alpha_search", "[4] figs. 4 and 5",
             "how the best alpha is found: the error of the velocity over alpha",
             kAlphaSearchScript, alpha_search(), best_alpha()),
      figure("alpha_curves", "[4] fig. 5", "velocity for three alpha and two steps",
             kAlphaCurvesScript, alpha_curves(), {}, {1200, 550}),
      figure("step_methods", "[4] fig. 7", "displacement and force of one mass by three methods",
             kStepMethodsScript, step_methods(), {}, {1200, 550}),
      figure("step_sizes", "[4] fig. 8", "displacement by three methods at three steps",
             kStepSizesScript, step_sizes(), {}, {1500, 550})};
}

report::Table numbers_of(const std::vector<Figure>& figures) {
  report::Table table("numbers");
  for (const Figure& figure : figures)
    for (const Printed& n : figure.numbers)
      table.add({{"figure", figure.of},
                 {"quantity", n.quantity},
                 {"printed", n.printed},
                 {"tact", n.ours},
                 {"difference_percent", 100.0 * (n.ours / n.printed - 1.0)}});
  return table;
}

}  // namespace tact::tools::figures
