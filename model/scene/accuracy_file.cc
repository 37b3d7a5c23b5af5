// SPDX-License-Identifier: Apache-2.0
#include "model/scene/accuracy_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "model/io/input_file.h"
#include "model/io/toml.h"
#include "model/reader/scene_text.h"
#include "model/scene/laws.h"
#include "model/scene/scene.h"

namespace tact::model::scene {
namespace {

namespace fs = std::filesystem;

// A file of another schema is measured again, not translated.
constexpr std::string_view kSchema = "tact-accuracy/2";

/// What is no number becomes NaN, and is refused with the others.
std::vector<double> numbers_of(const toml::table& table, const char* key) {
  std::vector<double> out;
  if (const toml::array* array = table[key].as_array())
    for (const toml::node& value : *array) out.push_back(value.value_or<double>(std::nan("")));
  return out;
}

std::string remedy(const Scene& scene) {
  return fmt::format(
      "tact-lab reference {0} --tool --out TRUTH.json solves the truth, tact-lab chart {0} "
      "--tool-reference TRUTH.json --out DIR --accuracy {1} measures against it",
      scene.path, accuracy_path(scene));
}

/// Error: what the table lacks.
Result<Accuracy> accuracy_of(const toml::table& table, const std::string& law) {
  Accuracy out{
      .law = law,
      .law_hash = table["law_hash"].value_or<std::string>(""),
      .reference = table["reference"].value_or<std::string>(""),
      .date = table["date"].value_or<std::string>(""),
      .large_strain_off = table["large_strain_off"].value_or(false),
      .rms_ratio = table["force_rms_ratio"].value_or<double>(std::nan("")),
      .within_noticeable_ratio = table["within_noticeable_ratio"].value_or<double>(std::nan("")),
      .depth_m = numbers_of(table, "depth_m"),
      .own_worst_ratio = numbers_of(table, "own_worst_ratio")};
  const auto is_number = [](double v) { return std::isfinite(v); };
  if (!is_number(out.rms_ratio) || out.rms_ratio < 0.0 || !is_number(out.within_noticeable_ratio) ||
      out.depth_m.empty() || out.depth_m.size() != out.own_worst_ratio.size() ||
      !std::all_of(out.depth_m.begin(), out.depth_m.end(), is_number) ||
      !std::all_of(out.own_worst_ratio.begin(), out.own_worst_ratio.end(), is_number))
    return Error{"a number is missing or has no meaning"};
  return out;
}

std::string hash_of_forces(const Scene& scene, const TissueLaw& law) {
  // Chosen: enough that another law, parameter, organ or tool
  // changes some force, few enough for every --check.
  constexpr std::size_t kPlaces = 9;
  constexpr double kDepths_m[] = {0.0005, 0.002, 0.005, 0.01};
  contact::ContactLaw& contact_law = law.contact_law();
  const mesh::SurfaceMesh& organ = scene.organ_mesh;
  reader::TextHash hash;
  for (const contact::ProbeSphere& s : scene.tool.spheres)
    hash.add(fmt::format("{:.6g} {:.6g} {:.6g} {:.6g}", s.offset_m.x, s.offset_m.y, s.offset_m.z,
                         s.radius_m));
  contact::Indentation before{};
  for (std::size_t k = 0; k < kPlaces; ++k) {
    const std::size_t triangle = k * (organ.triangle.size() - 1) / (kPlaces - 1);
    contact::Indentation at{.surface_point = {.triangle = static_cast<std::uint32_t>(triangle),
                                              .weight = {1.0, 0.0, 0.0}},
                            .normal = organ.vertex_normal[organ.triangle[triangle][0]]};
    for (const double depth_m : kDepths_m) {
      at.indentation_m = depth_m;
      // Six digits: the last bits may differ between compilers,
      // a law that is another one differs before.
      hash.add(fmt::format("{:.6g}", contact_law.respond(at).law.force_N));
      // A law that relaxes must not remember the depth before.
      contact_law.leave(0);
    }
    if (k > 0) {
      const auto [near, structural] =
          contact_law.coupling(before, at, scene.tool.spheres[0].radius_m);
      hash.add(fmt::format("{:.6g} {:.6g}", near, structural));
    }
    before = at;
  }
  return hash.hex();
}

}  // namespace

Result<std::string> hash_of_linear_forces(const Scene& scene, std::string_view law_name) {
  Scene linear = scene;
  linear.compliance.large_strain = false;
  const auto law = make_tissue_law(linear, law_name);
  if (!law) return law.error();
  return hash_of_forces(linear, **law);
}

std::string accuracy_path(const Scene& scene) {
  return fs::path(scene.path).replace_extension(".accuracy").string();
}

Result<Accuracy> read_accuracy(const Scene& scene) {
  const std::string path = accuracy_path(scene), &name = scene.law;
  if (!scene.elastic)
    return Error{fmt::format("{} has no [elastic], so there is nothing to solve and compare with",
                             scene.path)};
  std::error_code failed;
  if (!fs::exists(path, failed))
    return Error{fmt::format("it was never measured; {}", remedy(scene))};
  // What is lacking is reported from the outside inwards,
  // each time with the commands that make it again.
  const auto text = io::read_file(path, remedy(scene));
  if (!text) return text.error();
  const auto parsed = io::parse_toml(*text, path);
  if (!parsed) return Error{fmt::format("{}; {}", parsed.error().message, remedy(scene))};
  const toml::table& root = *parsed;
  if (root["schema"].value_or<std::string>("") != kSchema)
    return Error{
        fmt::format("{} is of another version of tact-lab chart; {}", path, remedy(scene))};
  const toml::table* table = root[name].as_table();
  if (table == nullptr) return Error{fmt::format("{} has no [{}]; {}", path, name, remedy(scene))};
  auto out = accuracy_of(*table, name);
  if (!out)
    return Error{fmt::format("{}: [{}]: {}; {}", path, name, out.error().message, remedy(scene))};
  const auto hash = hash_of_linear_forces(scene, scene.law);
  if (!hash) return hash.error();
  if (out->law_hash != *hash)
    return Error{fmt::format("{} is of another law, organ or tool; {}", path, remedy(scene))};
  return out;
}

std::size_t worst_depth(const Accuracy& accuracy) {
  const auto& own = accuracy.own_worst_ratio;
  const auto nearer = [](double a, double b) { return std::abs(a) < std::abs(b); };
  return static_cast<std::size_t>(std::max_element(own.begin(), own.end(), nearer) - own.begin());
}

// Both: an RMS of the peak hides a light touch that is far off.
double worst_error_ratio(const Accuracy& accuracy) {
  return std::max(accuracy.rms_ratio, std::abs(accuracy.own_worst_ratio[worst_depth(accuracy)]));
}

bool keeps(const Accuracy& accuracy, const ToleranceSettings& tolerance) {
  return worst_error_ratio(accuracy) <= tolerance.force_error_ratio;
}

std::optional<Accuracy> nearest_law(const Scene& scene) {
  std::optional<Accuracy> out;
  Scene own = scene;
  for (const LawRow& row : all_laws()) {
    // What a blade cannot cut is no law for a scene with one.
    if (scene.tool.blade && !row.can_be_cut) continue;
    own.law = row.name;
    const auto found = scene.describes(row.name) ? read_accuracy(own) : Error{};
    if (found && (!out || worst_error_ratio(*found) <= worst_error_ratio(*out))) out = *found;
  }
  return out;
}

std::string accuracy_line(const Scene& scene) {
  const auto found = read_accuracy(scene);
  if (!found) return "force of the whole tool: not known: " + found.error().message;
  const auto own_percent = [&](std::size_t i) {
    return 100.0 * std::abs(found->own_worst_ratio[i]);
  };
  std::string own;
  for (std::size_t i = 0; i < found->depth_m.size(); ++i)
    own += fmt::format("{}{:.1f} % at {:g} mm", i == 0 ? "" : ", ", own_percent(i),
                       1e3 * found->depth_m[i]);
  std::string out = fmt::format(
      "force of the whole tool: {:.1f} % of the peak off (RMS), at the worst place {} of the force "
      "there; {:.0f} % of all places and depths within the 7 % that people notice; against {}{}; "
      "measured {}, hash {}",
      100.0 * found->rms_ratio, own, 100.0 * found->within_noticeable_ratio, found->reference,
      found->large_strain_off ? ", with compliance.large_strain off, which this scene has on" : "",
      found->date, found->law_hash);
  if (!scene.tolerance) return out;
  const double allowed_percent = 100.0 * scene.tolerance->force_error_ratio;
  if (keeps(*found, *scene.tolerance))
    return out + fmt::format("; it keeps its tolerance of {:g} %, of the peak and of the own force",
                             allowed_percent);
  const std::size_t worst = worst_depth(*found);
  return out + fmt::format(
                   "; it misses its tolerance of {:g} %: {:.1f} % of the own force at {:g} "
                   "mm, {:.1f} % of the peak (RMS)",
                   allowed_percent, own_percent(worst), 1e3 * found->depth_m[worst],
                   100.0 * found->rms_ratio);
}

}  // namespace tact::model::scene
