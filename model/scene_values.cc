#include "model/scene_values.h"

#include <fmt/format.h>

#include <cmath>

#include "model/scene_words.h"

namespace tact::model {

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
    default:
      return "a date or time";
  }
}

std::string range_text(Range range, std::string_view key) {
  const std::string_view unit = unit_of_key(key);
  return fmt::format("{} .. {}{}{}", range.low, range.high, unit.empty() ? "" : " ", unit);
}

std::string range_text(CountRange range) {
  return fmt::format("{} .. {}, whole", range.low, range.high);
}

std::string number_problem(const toml::node& node, Range range, double& value) {
  if (!node.is_number()) return fmt::format("is {}, not a number", type_name(node));
  const double given = node.is_integer() ? static_cast<double>(node.as_integer()->get())
                                         : node.as_floating_point()->get();
  if (!std::isfinite(given)) return fmt::format("= {} is not finite", given);
  if (given < range.low || given > range.high) return fmt::format("= {} is out of range", given);
  value = given;
  return {};
}

std::string count_problem(const toml::node& node, CountRange range, std::size_t& value) {
  const Range bounds{static_cast<double>(range.low), static_cast<double>(range.high)};
  double given = 0.0;
  std::string problem = number_problem(node, bounds, given);
  if (!problem.empty()) return problem;
  if (!node.is_integer()) return fmt::format("= {} is written with a fraction", given);
  value = static_cast<std::size_t>(given);
  return {};
}

std::string vector_problem(const toml::node& node, Range each, Vec3& value) {
  const toml::array* array = node.as_array();
  if (!array) return fmt::format("is {}, not three numbers", type_name(node));
  if (array->size() != 3) return fmt::format("has {} elements, not three", array->size());
  Vec3 given;
  std::size_t index = 0;
  for (double* component : {&given.x, &given.y, &given.z}) {
    const std::string problem = number_problem(*array->get(index), each, *component);
    if (!problem.empty()) return fmt::format("{} {}", "xyz"[index], problem);
    ++index;
  }
  value = given;
  return {};
}

std::string text_problem(const toml::node& node, std::string& value) {
  const toml::value<std::string>* text = node.as_string();
  if (!text) return fmt::format("is {}, not text", type_name(node));
  if (text->get().empty()) return "is empty";
  for (const char c : text->get()) {
    if (is_control(c)) return "has a control character";
  }
  value = text->get();
  return {};
}

std::string flag_problem(const toml::node& node, bool& value) {
  if (!node.is_boolean()) return fmt::format("is {}, not true or false", type_name(node));
  value = node.as_boolean()->get();
  return {};
}

}  // namespace tact::model
