// SPDX-License-Identifier: Apache-2.0
#include "host/tracking/tracking_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/io/input_file.h"
#include "model/io/one_line.h"
#include "model/io/toml.h"

namespace tact::host::tracking {
namespace {

using model::Error;
using model::Result;

// Chosen: a description has a few kB, a room less than 100 m.
constexpr std::uintmax_t kMaxFile_bytes = 1'000'000;
constexpr double kFarthest_m = 100.0;

/// None: `node` is no list of `count` numbers, each at most `most`.
std::optional<std::vector<double>> read_numbers(const toml::node* node, std::size_t count,
                                                double most) {
  const toml::array* list = node != nullptr ? node->as_array() : nullptr;
  if (list == nullptr || list->size() != count) return std::nullopt;
  std::vector<double> numbers;
  for (const toml::node& item : *list) {
    const auto value = item.value<double>();
    if (!value || !(std::abs(*value) <= most)) return std::nullopt;
    numbers.push_back(*value);
  }
  return numbers;
}

}  // namespace

Result<toml::table> parse_toml_file(const std::string& path) {
  const auto text = model::io::read_file(
      path, "give the path of a tracking description of at most 1 MB", kMaxFile_bytes);
  if (!text) return text.error();
  return model::io::parse_toml(*text, path);
}

void TrackingKeys::refuse(std::string_view key, const std::string& sentence) {
  // The first one: later ones often follow from it.
  if (error_) return;
  const toml::node* node = table_.get(key);
  const std::uint32_t line =
      node != nullptr ? node->source().begin.line : table_.source().begin.line;
  // toml++ counts from 1 and gives 0 for a table that nobody wrote.
  error_ = Error{fmt::format("{}:{}: {}", path_, std::max(line, 1u), sentence)};
}

void TrackingKeys::only(std::initializer_list<std::string_view> keys) {
  for (const auto& [key, node] : table_) {
    if (std::ranges::find(keys, key.str()) != keys.end()) continue;
    refuse(key.str(), fmt::format("{} is not known here; write one of: {}",
                                  model::io::on_one_line(key.str()), fmt::join(keys, ", ")));
  }
}

double TrackingKeys::number(std::string_view key, double least, double most) {
  const toml::node* node = table_.get(key);
  const auto value = node != nullptr ? node->value<double>() : std::nullopt;
  if (!value || !(*value >= least && *value <= most)) {
    refuse(key,
           fmt::format("{} must be a number from {:g} to {:g}; write it here", key, least, most));
    return least;
  }
  return *value;
}

std::string TrackingKeys::text(std::string_view key) {
  const toml::node* node = table_.get(key);
  const auto value = node != nullptr ? node->value<std::string>() : std::nullopt;
  if (!value || value->empty()) {
    refuse(key, fmt::format("{} must be a text; write {} = \"...\"", key, key));
    return {};
  }
  return *value;
}

bool TrackingKeys::flag(std::string_view key) {
  const toml::node* node = table_.get(key);
  if (node == nullptr) return false;
  // Exact: toml++ would take the number 1 for true.
  const auto value = node->value_exact<bool>();
  if (!value) refuse(key, fmt::format("{} must be true or false", key));
  return value.value_or(false);
}

std::vector<double> TrackingKeys::numbers(std::string_view key, std::size_t count, double most) {
  const std::optional<std::vector<double>> given = read_numbers(table_.get(key), count, most);
  if (given) return *given;
  refuse(key, fmt::format("{} must be {} numbers of at most {:g}; write {} = [..]", key, count,
                          most, key));
  return std::vector<double>(count, 0.0);
}

std::vector<std::vector<double>> TrackingKeys::rows(std::string_view key, std::size_t count,
                                                    double most) {
  std::vector<std::vector<double>> out;
  const toml::node* node = table_.get(key);
  const toml::array* list = node != nullptr ? node->as_array() : nullptr;
  bool good = list != nullptr;
  for (std::size_t i = 0; good && i < list->size(); ++i) {
    const std::optional<std::vector<double>> row = read_numbers(list->get(i), count, most);
    good = row.has_value();
    if (good) out.push_back(*row);
  }
  if (good) return out;
  refuse(key,
         fmt::format("{} must be a list of lists of {} numbers of at most {:g}", key, count, most));
  return {};
}

Pose TrackingKeys::pose() {
  const std::vector<double> p = numbers("position_m", 3, kFarthest_m);
  const std::vector<double> q = numbers("rotation_wxyz", 4, 1e6);
  const auto rotation = pose::rotation_from(std::array{q[0], q[1], q[2], q[3]});
  if (!rotation) refuse("rotation_wxyz", "rotation_wxyz has no direction; no turn is [1, 0, 0, 0]");
  return {.rotation = rotation.value_or(Eigen::Quaterniond::Identity()),
          .position_m = {p[0], p[1], p[2]}};
}

void TrackingKeys::section(std::string_view key, const std::function<void(TrackingKeys&)>& visit) {
  const toml::node* node = table_.get(key);
  const toml::table* table = node != nullptr ? node->as_table() : nullptr;
  if (table == nullptr) return refuse(key, fmt::format("[{}] is missing; add this section", key));
  TrackingKeys keys(*table, path_, error_);
  visit(keys);
}

void TrackingKeys::sections(std::string_view key, const std::function<void(TrackingKeys&)>& visit) {
  const toml::node* node = table_.get(key);
  const toml::array* list = node != nullptr ? node->as_array() : nullptr;
  if (list == nullptr || list->empty() || !list->is_homogeneous(toml::node_type::table))
    return refuse(key, fmt::format("[[{}]] is missing; add one or more", key));
  for (const toml::node& item : *list) {
    TrackingKeys keys(*item.as_table(), path_, error_);
    visit(keys);
  }
}

}  // namespace tact::host::tracking
