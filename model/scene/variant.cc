// SPDX-License-Identifier: Apache-2.0
#include "model/scene/variant.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "model/scene/laws.h"

namespace tact::model::scene {
namespace {

std::optional<Error> change(std::vector<LawNumber>& numbers, const std::string& set) {
  const std::size_t equals = set.find('=');
  const std::string key = set.substr(0, equals);
  const auto found = std::ranges::find(numbers, key, &LawNumber::key);
  if (found == numbers.end() || !found->is_live()) {
    std::string known;
    for (const LawNumber& n : numbers)
      if (n.is_live()) known += (known.empty() ? "" : ", ") + n.key;
    return Error{fmt::format("{} cannot change while the scene runs; these can: {}", key, known)};
  }
  const std::string text = equals == std::string::npos ? "" : set.substr(equals + 1);
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  const Range& range = found->number.range;
  // NaN is in no range.
  if (read.ec != std::errc() || read.ptr != end || !(value >= range.low && value <= range.high))
    return Error{fmt::format("{} = {}: give a number from {:g} to {:g}", key,
                             text.empty() ? "nothing" : text, range.low, range.high)};
  *found->number.number = value;
  return std::nullopt;
}

}  // namespace

std::vector<std::string> merged(std::vector<std::string> set, std::span<const std::string> more) {
  const auto key_of = [](const std::string& each) { return each.substr(0, each.find('=')); };
  for (const std::string& each : more) {
    std::erase_if(set, [&](const std::string& old) { return key_of(old) == key_of(each); });
    set.push_back(each);
  }
  return set;
}

std::vector<LawNumber> law_numbers(Scene& scene) {
  std::vector<LawNumber> out;
  const auto add = [&out](std::string_view section, const Parameter& p) {
    // Below its range an optional number is one that the law does not use.
    if ((p.number != nullptr && *p.number >= p.range.low) || p.count != nullptr)
      out.push_back({fmt::format("{}.{}", section, p.key), p});
  };
  if (const LawRow* law = find_law(scene.law))
    for (const Parameter& p : parameters_of(*law, scene).all) add(law->name, p);
  // The map is of one nu.
  if (scene.elastic && follows_elastic(scene))
    add("elastic", model::parameters_of(*scene.elastic).find("youngs_modulus_Pa"));
  return out;
}

Result<Scene> with_numbers(Scene scene, std::span<const std::string> set) {
  auto numbers = law_numbers(scene);
  for (const std::string& each : set)
    if (auto error = change(numbers, each)) return *error;
  return scene;
}

Result<Variant> make_variant(const Scene& scene, std::span<const std::string> set) {
  auto changed = with_numbers(scene, set);
  if (!changed) return changed.error();
  Variant out{.scene = std::make_unique<const Scene>(std::move(*changed)), .tissue = nullptr};
  auto tissue = make_tissue(*out.scene);
  if (!tissue) return tissue.error();
  out.tissue = std::move(*tissue);
  return out;
}

}  // namespace tact::model::scene
