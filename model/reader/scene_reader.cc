// SPDX-License-Identifier: Apache-2.0
#include "model/reader/scene_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "model/reader/scene_text.h"
#include "model/reader/scene_values.h"

namespace tact::model::reader {
namespace {

std::string names_of(std::span<const Choice> choices) {
  std::string names;
  for (const Choice& choice : choices)
    names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", choice.name);
  return names;
}

}  // namespace

void SceneVisit::note(ProblemKind kind, const TextPosition& position, const std::string& message) {
  problems_.push_back({kind, position.line, fmt::format("{}: {}", position.where, message)});
}

std::optional<Error> SceneVisit::problem() const {
  const auto first =
      std::min_element(problems_.begin(), problems_.end(), [](const Problem& a, const Problem& b) {
        // A wrong value makes keys seem missing, and missing ones make others contradict: the first
        // kind may be the cause.
        return std::tie(a.kind, a.line) < std::tie(b.kind, b.line);
      });
  if (first == problems_.end()) return std::nullopt;
  return Error{first->message};
}

void Keys::visit_root(SceneVisit& visit, const Inside& inside) {
  Keys keys(visit, visit.document() ? &visit.document()->root : nullptr, "");
  inside(keys);
  keys.finish();
}

/// Keeps the present value where the value is not good.
template <typename T>
void Keys::store(const toml::node& node, std::string_view key, Result<T> value, T& out) {
  if (value)
    out = std::move(*value);
  else
    check(node, key, value.error().message);
}

void Keys::text(std::string_view key, std::string_view meaning, std::string& out, Need need) {
  const std::string fallback = need == Need::kOptional ? fmt::format("\"{}\"", out) : "";
  const toml::node* node = take(key, "text", meaning, fallback);
  // Empty is how a text says "none"; only what is required refuses it.
  if (node && need == Need::kOptional && node->value<std::string>() == "") return out.clear();
  if (node) store(*node, key, as_text(*node), out);
}

void Keys::flag(std::string_view key, std::string_view meaning, bool& out, Need need) {
  const std::string fallback = need == Need::kOptional ? fmt::format("{}", out) : "";
  const toml::node* node = take(key, "true or false", meaning, fallback);
  if (node) store(*node, key, as_flag(*node), out);
}

void Keys::number(std::string_view key, Range range, std::string_view meaning, double& out,
                  Need need) {
  const std::string fallback = need == Need::kOptional ? fmt::format("{}", out) : "";
  const toml::node* node = take(key, range_text(range, key), meaning, fallback);
  if (node) store(*node, key, as_number(*node, range), out);
}

void Keys::count(std::string_view key, CountRange range, std::string_view meaning, std::size_t& out,
                 Need need) {
  const std::string fallback = need == Need::kOptional ? fmt::format("{}", out) : "";
  const toml::node* node = take(key, range_text(range), meaning, fallback);
  if (node) store(*node, key, as_count(*node, range), out);
}

void Keys::vector(std::string_view key, Range each, std::string_view meaning, Vec3& out,
                  Need need) {
  const std::string fallback =
      need == Need::kOptional ? fmt::format("[{:.5g}, {:.5g}, {:.5g}]", out.x, out.y, out.z) : "";
  const toml::node* node = take(key, "[x, y, z], each " + range_text(each, key), meaning, fallback);
  if (node) store(*node, key, as_vector(*node, each), out);
}

void Keys::per_arm(std::string_view key, Range each, std::string_view meaning,
                   std::array<double, 3>& out, Need need) {
  const std::string fallback =
      need == Need::kOptional ? fmt::format("[{:.5g}]", fmt::join(out, ", ")) : "";
  const toml::node* node = take(key, "[a, b, c], each " + range_text(each, key), meaning, fallback);
  if (node) store(*node, key, as_numbers<3>(*node, each, "123"), out);
}

void Keys::quaternion(std::string_view key, std::string_view meaning, std::array<double, 4>& out,
                      Need need) {
  const std::string fallback = need == Need::kOptional ? "none" : "";
  const toml::node* node = take(key, "[w, x, y, z]", meaning, fallback);
  if (node) store(*node, key, as_numbers<4>(*node, {-1e6, 1e6}, "wxyz"), out);
}

void Keys::points(std::string_view key, Range each, std::string_view meaning,
                  std::vector<std::array<double, 4>>& out) {
  const toml::node* node = take(key, "[[number, x, y, z], ..]", meaning);
  if (node) store(*node, key, as_rows(*node, each), out);
}

void Keys::choice(std::string_view key, std::span<const Choice> choices, std::string_view meaning,
                  std::size_t& out, Need need) {
  constexpr std::size_t kMaxOnALine = 4;
  // More would not fit into the column of the reference.
  if (!visit_.document() && choices.size() > kMaxOnALine) return describe(key, choices);
  const std::string fallback =
      need == Need::kOptional ? fmt::format("\"{}\"", choices[out].name) : "";
  const toml::node* node = take(key, names_of(choices), meaning, fallback);
  if (node) out = match(key, choices, *node).value_or(out);
}

void Keys::one_of(std::string_view key, std::span<const Choice> choices,
                  const std::function<void(std::size_t)>& further) {
  if (!visit_.document()) {
    for (std::size_t i = 0; i < choices.size(); ++i) {
      describe(key, choices.subspan(i, 1));
      further(i);
    }
    return;
  }
  const toml::node* node = take(key, names_of(choices), "");
  const std::optional<std::size_t> index =
      node ? match(key, choices, *node) : std::optional<std::size_t>{};
  // Without the deciding key the set of valid keys is unknown: none is called unknown.
  all_named_ = index.has_value();
  if (index) further(*index);
}

/// A row for each choice.
void Keys::describe(std::string_view key, std::span<const Choice> choices) {
  for (const Choice& choice : choices) {
    const std::string value = fmt::format("\"{}\"", choice.name);
    visit_.add({path_, std::string(key), value, "", std::string(choice.meaning)});
  }
}

bool Keys::section(std::string_view key, std::string_view meaning, const Inside& inside,
                   Need need) {
  const std::string times = need == Need::kOptional ? "optional" : "";
  if (!visit_.document()) {
    Keys keys(visit_, nullptr, path_to(key));
    visit_.add({keys.path_, "", fmt::format("[{}]", keys.path_), times, std::string(meaning)});
    inside(keys);
    return true;
  }
  const toml::node* node = take(key, fmt::format("a section [{}]", path_to(key)), meaning, times);
  if (!node) return false;
  if (!node->is_table()) {
    check(*node, key, fmt::format("is {}, not a section", type_name(*node)));
    return false;
  }
  Keys keys(visit_, node->as_table(), path_to(key));
  inside(keys);
  keys.finish();
  return true;
}

void Keys::entries(std::string_view key, CountRange range, std::string_view meaning,
                   const Inside& inside) {
  const std::string path = path_to(key);
  if (!visit_.document()) {
    Keys keys(visit_, nullptr, path);
    const std::string times = fmt::format("{} .. {} times", range.low, range.high);
    visit_.add({path, "", fmt::format("[[{}]]", path), times, std::string(meaning)});
    return inside(keys);
  }
  const std::string allowed = fmt::format("{} .. {} sections [[{}]]", range.low, range.high, path);
  // None at all is fine where none is needed.
  const toml::node* node = take(key, allowed, meaning, range.low == 0 ? "none" : "");
  if (!node) return;
  const toml::array* array = node->as_array();
  if (!array) return check(*node, key, fmt::format("is {}", type_name(*node)));
  if (array->size() < range.low || array->size() > range.high)
    return check(*node, key, fmt::format("has {} entries", array->size()));
  for (std::size_t i = 0; i < array->size(); ++i) {
    const toml::node& entry = *array->get(i);
    const std::string name = fmt::format("{}.{}", key, i);
    if (!entry.is_table()) {
      visit_.note(ProblemKind::kWrong, visit_.document()->position_of(entry),
                  fmt::format("{} is {}; allowed: {}", path_to(name), type_name(entry), allowed));
      continue;
    }
    Keys keys(visit_, entry.as_table(), path_to(name));
    inside(keys);
    keys.finish();
  }
}

TextPosition Keys::position_of(std::string_view key) const {
  if (!table_) return {};
  const toml::node* node = table_->get(key);
  return visit_.document()->position_of(node ? *node : *table_);
}

void Keys::refuse(std::initializer_list<std::string_view> keys, const std::string& message) {
  if (!table_) return;
  TextPosition reported = position_of(*keys.begin());
  for (const std::string_view key : keys) {
    const TextPosition position = position_of(key);
    if (position.line == 0) reported = position;  // an override: what was just typed
  }
  visit_.note(ProblemKind::kConflict, reported, message);
}

/// The node of a key, or null where there is nothing to read.
const toml::node* Keys::take(std::string_view key, std::string allowed, std::string_view meaning,
                             std::string fallback) {
  if (!visit_.document()) {
    if (fallback.empty()) fallback = "required";
    visit_.add(
        {path_, std::string(key), std::move(allowed), std::move(fallback), std::string(meaning)});
    return nullptr;
  }
  const toml::node* node = table_->get(key);
  if (!node && fallback.empty()) {
    visit_.note(ProblemKind::kMissing, position_of(key),
                fmt::format("{} is missing; allowed: {}", path_to(key), allowed));
  }
  // Also of a key that is missing: it is no unknown one, and what is near to it is suggested.
  known_.push_back({key, std::move(allowed)});
  return node;
}

std::optional<std::size_t> Keys::match(std::string_view key, std::span<const Choice> choices,
                                       const toml::node& node) {
  const Result<std::string> value = as_text(node);
  for (std::size_t i = 0; value && i < choices.size(); ++i)
    if (*value == choices[i].name) return i;
  check(node, key,
        value ? fmt::format("= \"{}\" is unknown", on_one_line(*value)) : value.error().message);
  return std::nullopt;
}

/// Called after the key was taken, so its range is in the last known entry.
void Keys::check(const toml::node& node, std::string_view key, std::string_view problem) {
  visit_.note(ProblemKind::kWrong, visit_.document()->position_of(node),
              fmt::format("{} {}; allowed: {}", path_to(key), problem, known_.back().allowed));
}

/// Every key that the visit did not name is unknown.
void Keys::finish() {
  if (!table_ || !all_named_) return;
  for (auto&& [key, node] : *table_) {
    const auto named = [&key = key](const Known& known) { return known.key == key.str(); };
    if (std::any_of(known_.begin(), known_.end(), named)) continue;
    visit_.note(ProblemKind::kWrong, visit_.document()->position_of(node), unknown_message(key));
  }
}

std::string Keys::unknown_message(std::string_view key) const {
  const std::string path = path_to(on_one_line(key));
  std::vector<std::string_view> names;
  std::string all;
  for (const Known& known : known_) {
    if (differs_only_in_unit(key, known.key)) {
      return fmt::format("{} has the wrong unit; write {}, allowed: {}", path, known.key,
                         known.allowed);
    }
    names.push_back(known.key);
    all += fmt::format("{}{}", all.empty() ? "" : ", ", known.key);
  }
  const std::size_t near = nearest_key(key, names);
  if (near == std::string_view::npos)
    return fmt::format("{} is no key here; allowed here: {}", path, all);
  return fmt::format("{} is no key here; did you mean {}? allowed: {}", path, known_[near].key,
                     known_[near].allowed);
}

std::string Keys::path_to(std::string_view key) const {
  return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
}

}  // namespace tact::model::reader
