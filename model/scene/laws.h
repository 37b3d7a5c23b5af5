// SPDX-License-Identifier: Apache-2.0
// laws.h - the laws that a scene can choose, one row each.
//
// To add a law, write its header with visit() and make_*, its test, and a row in laws.cc. The
// reader of scenes, --help-scene, --parameters and the page's scene picker, tactd, and fit, chart
// and plan of tact-lab ask these rows. Set-up code only.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "model/law/law.h"
#include "model/parameters.h"
#include "model/result.h"

namespace tact::model::scene {

struct Scene;
class TissueLawBuilder;

/// A law with what decides its cost; 0 and nothing leave what the scene says.
struct LawSizes {
  std::string law{};
  std::size_t table_knots = 0;  // of every law that is read from a table
  std::size_t size = 0;         // of the size_key of its row
  std::string disc_form{};      // disc_stack
};

/// One law for the whole surface, as a scene makes it.
struct Curve {
  std::unique_ptr<law::Law> law;
  std::string title{};             // for people
  bool draws_tissue = false;       // by its own profile, not as a half-space
  bool is_measured = false;        // its strain is that of the tissue, not a small one
  std::size_t untabled_bytes = 0;  // size of a law that the loop calls itself; 0: it reads a table
};

struct LawRow {
  std::string_view name, meaning;            // in a scene, where its section is [name]
  void (*visit)(ParameterVisitor&, Scene&);  // the keys of its section
  Result<Curve> (*curve)(const Scene&) = nullptr;
  /// Builds a law that has no curve, as it differs from place to place.
  std::optional<Error> (TissueLawBuilder::*build)() = nullptr;
  /// Numbers to which, all together, its force is proportional; none where that is the modulus of
  /// [elastic]. And one to which its damping is.
  std::vector<std::string_view> stiffness_keys{};
  std::string_view damping_key{};
  /// What tact-lab fit turns; empty: it fits no such law.
  std::vector<std::string_view> fit_keys{};
  /// Ratios to the scene's own numbers where its search starts; empty: one start, at these.
  std::vector<std::vector<double>> fit_starts{};
  /// A count of the section that decides its cost.
  std::string_view size_key{};
  bool follows_elastic = false;  // its force is that of [elastic], by [compliance]
  bool can_be_cut = false;       // by the blade of a tool
  /// What tact-lab chart compares: of size_key, else of table_knots; empty: the law as it is.
  std::vector<std::size_t> sizes{}, quick_sizes{};
};

std::span<const LawRow> all_laws();
/// Null: there is none of this name.
const LawRow* find_law(std::string_view name);

/// Does the force of the scene follow its [elastic]?
bool follows_elastic(const Scene& scene);

/// The numbers of a law's section, pointing into the scene.
ParameterList parameters_of(const LawRow& law, Scene& scene);

}  // namespace tact::model::scene
