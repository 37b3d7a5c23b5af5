// SPDX-License-Identifier: Apache-2.0
#include "model/scene/plan_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string_view>
#include <utility>

#include "model/indent/disc_stack.h"
#include "model/io/input_file.h"
#include "model/io/seal.h"
#include "model/io/toml.h"
#include "model/scene/accuracy_file.h"

namespace tact::model::scene {
namespace {

namespace fs = std::filesystem;

/// The sizes by their keys, in a plan and in a scene; the second is empty where the law has none.
std::array<std::pair<std::string_view, std::size_t LawSizes::*>, 2> keys_of(std::string_view law) {
  const LawRow* row = find_law(law);
  return {{{"table_knots", &LawSizes::table_knots}, {row ? row->size_key : "", &LawSizes::size}}};
}

/// Error: what is missing or has no meaning.
Result<Plan> plan_of(const toml::table& root) {
  Plan plan;
  const std::string law = root["law"].value_or<std::string>("");
  if (find_law(law) == nullptr) return Error{fmt::format("law = \"{}\" is no law", law)};
  plan.sizes.law = law;
  // Chosen, above every size that a scene takes: the scene's own ranges come later.
  const auto number_of = [&root](std::string_view key) {
    const auto number = root[key].value_or<std::int64_t>(0);
    return number < 0 || number > 100000 ? std::nullopt
                                         : std::optional(static_cast<std::size_t>(number));
  };
  // Those of other laws, too: such a plan was not written by tact-lab.
  for (const LawRow& row : all_laws())
    if (!row.size_key.empty() && !number_of(row.size_key))
      return Error{fmt::format("{} is out of range", row.size_key)};
  for (const auto& [key, size] : keys_of(law)) {
    if (key.empty()) continue;
    const auto number = number_of(key);
    if (!number) return Error{fmt::format("{} is out of range", key)};
    plan.sizes.*size = *number;
  }
  const std::string form = plan.sizes.disc_form = root["disc_form"].value_or<std::string>("");
  if (!form.empty() &&
      std::ranges::find(indent::kDiscForms, form, &Choice::name) == indent::kDiscForms.end())
    return Error{fmt::format("disc_form = \"{}\" is no form", form)};
  const auto measured = [&](const char* key, double& value) {
    value = root[key].value_or<double>(-1.0);
    return std::isfinite(value) && value >= 0.0;
  };
  if (!measured("tick_p999_us", plan.tick_p999_us)) return Error{"tick_p999_us is missing"};
  if (!measured("force_error_ratio", plan.force_error_ratio))
    return Error{"force_error_ratio is missing"};
  if (!measured("shape_error_ratio", plan.shape_error_ratio))
    return Error{"shape_error_ratio is missing"};
  plan.machine = root["machine"].value_or<std::string>("");
  plan.scene_hash = root["scene_hash"].value_or<std::string>("");
  return plan;
}

/// Seal before meaning: a damaged plan is reported as such.
Result<Plan> parse_plan(const std::string& path) {
  const auto text = io::read_file(path, "it cannot be used");
  if (!text) return Error{text.error().message};
  // An edited plan was never measured.
  if (!io::is_sealed(*text)) return Error{"damaged, its sha256 is missing or another"};
  const auto root = io::parse_toml(*text, "the plan");
  if (!root) return Error{fmt::format("damaged, {}", root.error().message)};
  return plan_of(*root);
}

}  // namespace

std::string text_of(const LawSizes& sizes) {
  std::string out = sizes.law;
  if (!sizes.disc_form.empty()) out += " " + sizes.disc_form;
  for (const auto& [key, size] : keys_of(sizes.law))
    if (sizes.*size != 0)
      out += fmt::format(" {} {}", sizes.*size, size == &LawSizes::size ? key : "knots");
  return out;
}

Scene sized(Scene scene, const LawSizes& sizes) {
  scene.law = sizes.law;
  if (sizes.table_knots != 0) scene.table_knots = sizes.table_knots;
  const LawRow* law = find_law(sizes.law);
  const Parameter size = law ? parameters_of(*law, scene).find(law->size_key) : Parameter{};
  if (size.count != nullptr && sizes.size != 0) *size.count = sizes.size;
  for (const auto form : {indent::DiscForm::kAlmenLaszlo, indent::DiscForm::kLinear})
    if (sizes.disc_form == name_of(form)) scene.laws.of<indent::DiscStackParameters>().form = form;
  return scene;
}

std::vector<std::string> overrides_of(const LawSizes& sizes) {
  std::vector<std::string> out{"law=" + sizes.law};
  if (!sizes.disc_form.empty()) out.push_back("disc_stack.form=" + sizes.disc_form);
  for (const auto& [key, size] : keys_of(sizes.law))
    if (sizes.*size != 0)
      out.push_back(
          fmt::format("{}{}={}", size == &LawSizes::size ? sizes.law + "." : "", key, sizes.*size));
  return out;
}

std::string command_text(const std::vector<std::string>& overrides) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.=/+,:";
  std::string out;
  for (const std::string& one : overrides) {
    out += " --set ";
    if (one.find_first_not_of(kPlain) == std::string::npos) {
      out += one;
      continue;
    }
    out += '\'';
    for (const char c : one) c == '\'' ? out += "'\\''" : out += c;
    out += '\'';
  }
  return out;
}

std::string machine_name() {
  const auto facts = io::read_file("/proc/cpuinfo");
  std::istringstream file(facts ? *facts : std::string());
  // /proc/cpuinfo of some processors has no model name.
  std::string cpu = "unknown processor";
  int cores = 0;
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("processor")) ++cores;
    if (line.starts_with("model name") && colon != std::string::npos) cpu = line.substr(colon + 2);
  }
  std::replace_if(
      cpu.begin(), cpu.end(), [](char c) { return c == ',' || c == '"' || c == '\\'; }, ' ');
  return fmt::format("{} x {}", cores, cpu);
}

Result<std::string> plan_path(const std::string& scene_hash) {
  const auto folder = [](const char* variable) {
    const char* value = std::getenv(variable);  // before threads
    return fs::path(value == nullptr ? "" : value);
  };
  fs::path cache = folder("XDG_CACHE_HOME");
  if (cache.empty() && !folder("HOME").empty()) cache = folder("HOME") / ".cache";
  if (cache.empty())
    return Error{"no folder for plans: neither XDG_CACHE_HOME nor HOME is set; set one"};
  return (cache / "tact" / "plan" / (scene_hash + ".toml")).string();
}

Result<Plan> read_plan(const std::string& path, const Scene& scene,
                       const std::vector<std::string>& overrides) {
  const auto broken = [&](const std::string& what) {
    return Error{fmt::format(
        "{}: {}; run tact-lab plan {}{} --reference FILE, FILE from tact-lab reference {} "
        "--out FILE",
        path, what, scene.path, command_text(overrides), scene.path)};
  };
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return broken("no plan for this scene");
  Result<Plan> plan = parse_plan(path);
  if (!plan) return broken(plan.error().message);
  if (plan->scene_hash != scene.hash) return broken("the plan of another scene");
  if (plan->machine != machine_name())
    return broken(fmt::format("measured on another machine, {}", plan->machine));
  if (!scene.describes(plan->sizes.law))
    return broken(fmt::format("the scene has no law {}", plan->sizes.law));
  return plan;
}

Result<Plan> find_plan(const Scene& scene, const std::vector<std::string>& overrides) {
  const auto path = plan_path(scene.hash);
  if (!path) return path.error();
  // law=auto as an override changes the hash: the plan may be that of the scene as it is without.
  std::vector<std::string> others = overrides;
  std::erase_if(others, [](const std::string& one) { return one.starts_with("law="); });
  std::error_code ignored;
  if (others.size() == overrides.size() || fs::exists(*path, ignored))
    return read_plan(*path, scene, overrides);
  const auto planned = load_scene(scene.path, others);
  if (!planned) return planned.error();
  const auto its_path = plan_path(planned->hash);
  if (!its_path) return its_path.error();
  return read_plan(*its_path, *planned, others);
}

Result<Plan> find_auto_law(const Scene& scene, const std::vector<std::string>& overrides) {
  auto plan = find_plan(scene, overrides);
  if (plan) return plan;
  std::vector<std::string> others = overrides;
  std::erase_if(others, [](const std::string& one) { return one.starts_with("law="); });
  // What its file names was chosen with a device and a time in mind.
  const auto shipped = load_scene(scene.path, others);
  const auto its_own = shipped && shipped->law != kAutoLaw ? read_accuracy(*shipped) : Error{};
  const auto nearest = its_own ? std::optional(*its_own) : nearest_law(scene);
  if (!nearest) return plan.error();
  Plan out;
  out.sizes.law = nearest->law;
  out.force_error_ratio = worst_error_ratio(*nearest);
  return out;
}

}  // namespace tact::model::scene
