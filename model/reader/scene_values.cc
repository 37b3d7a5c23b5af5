// SPDX-License-Identifier: Apache-2.0
#include "model/reader/scene_values.h"

#include <fmt/format.h>

#include <cmath>

#include "model/reader/scene_text.h"

namespace tact::model::reader {
std::string_view type_name(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a section";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::string:
      return "text";
    case toml::node_type::integer:
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "true or false";
    // TOML's four kinds of dates and times: no key takes one.
    default:
      return "a date or time";
  }
}

std::string range_text(Range range, std::string_view key) {
  const std::string_view unit = io::unit_of(key);
  return fmt::format("{} .. {}{}{}", range.low, range.high, unit.empty() ? "" : " ", unit);
}

std::string range_text(CountRange range) {
  return fmt::format("{} .. {}, whole", range.low, range.high);
}

Result<double> as_number(const toml::node& node, Range range) {
  if (!node.is_number()) return Error{fmt::format("is {}, not a number", type_name(node))};
  // 2 may be written for 2.0: whole numbers are exact in a double far beyond any range here.
  const double given = node.is_integer() ? static_cast<double>(node.as_integer()->get())
                                         : node.as_floating_point()->get();
  if (!std::isfinite(given)) return Error{fmt::format("= {} is not finite", given)};
  if (given < range.low || given > range.high)
    return Error{fmt::format("= {} is out of range", given)};
  return given;
}

Result<std::size_t> as_count(const toml::node& node, CountRange range) {
  const Range bounds{static_cast<double>(range.low), static_cast<double>(range.high)};
  const Result<double> given = as_number(node, bounds);
  if (!given) return given.error();
  // 8.0, too: a count is written as one.
  if (!node.is_integer()) return Error{fmt::format("= {} is written with a fraction", *given)};
  return static_cast<std::size_t>(*given);
}

template <std::size_t n>
Result<std::array<double, n>> as_numbers(const toml::node& node, Range each,
                                         const char (&names)[n + 1]) {
  constexpr const char* kCount = n == 3 ? "three" : "four";
  const toml::array* array = node.as_array();
  if (!array) return Error{fmt::format("is {}, not {} numbers", type_name(node), kCount)};
  if (array->size() != n)
    return Error{fmt::format("has {} elements, not {}", array->size(), kCount)};
  std::array<double, n> value{};
  for (std::size_t i = 0; i < n; ++i) {
    const Result<double> given = as_number(*array->get(i), each);
    if (!given) return Error{fmt::format("{} {}", names[i], given.error().message)};
    value[i] = *given;
  }
  return value;
}
template Result<std::array<double, 3>> as_numbers(const toml::node&, Range, const char (&)[4]);
template Result<std::array<double, 4>> as_numbers(const toml::node&, Range, const char (&)[5]);

Result<std::vector<std::array<double, 4>>> as_rows(const toml::node& node, Range each) {
  const toml::array* array = node.as_array();
  if (!array) return Error{fmt::format("is {}, not a list", type_name(node))};
  std::vector<std::array<double, 4>> rows;
  for (const toml::node& row : *array) {
    const auto given = as_numbers<4>(row, each, "1234");
    if (!given) return Error{fmt::format("entry {}: {}", rows.size(), given.error().message)};
    rows.push_back(*given);
  }
  return rows;
}

Result<Vec3> as_vector(const toml::node& node, Range each) {
  const Result<std::array<double, 3>> xyz = as_numbers<3>(node, each, "xyz");
  if (!xyz) return xyz.error();
  return Vec3{(*xyz)[0], (*xyz)[1], (*xyz)[2]};
}

Result<std::string> as_text(const toml::node& node) {
  const toml::value<std::string>* text = node.as_string();
  if (!text) return Error{fmt::format("is {}, not text", type_name(node))};
  // What is optional may be empty, and is asked for before (Keys::text).
  if (text->get().empty()) return Error{"is empty"};
  // It would break the lines of a terminal, a log or a header.
  for (const char c : text->get())
    if (is_control(c)) return Error{"has a control character"};
  return text->get();
}

Result<bool> as_flag(const toml::node& node) {
  if (!node.is_boolean()) return Error{fmt::format("is {}, not true or false", type_name(node))};
  return node.as_boolean()->get();
}

}  // namespace tact::model::reader
