// SPDX-License-Identifier: Apache-2.0
#include "tools/limits/evidence/hazards.h"

#include <algorithm>

#include "model/io/toml.h"
#include "tools/limits/evidence/hazards.toml.h"

namespace tact::tools::limits {
namespace {

template <class T>
std::vector<T> list_of(const toml::table& row, std::string_view key) {
  std::vector<T> out;
  if (const toml::array* values = row[key].as_array())
    for (const auto& value : *values) out.push_back(value.value_or(T{}));
  return out;
}

std::string text_of(const toml::table& row, std::string_view key) {
  return row[key].value_or(std::string());
}

// tests/house/hazards_test.py has read the file that was built in: it is whole.
const toml::table& parsed() {
  static const auto table = model::io::parse_toml(kHazards, "tests/safety/hazards.toml");
  // For a table that does not parse: none, instead of a crash.
  static const toml::table none;
  return table ? *table : none;
}

/// What a row of the table is made to.
template <class Make>
void for_each_row(std::string_view kind, const Make& make) {
  if (const toml::array* rows = parsed()[kind].as_array())
    for (const auto& row : *rows)
      if (const toml::table* fields = row.as_table()) make(*fields);
}

HazardTest test_of(const toml::table& row) {
  return {.id = text_of(row, "id"),
          .by = text_of(row, "by"),
          .names = list_of<std::string>(row, "names")};
}

bool names(const toml::table& row, std::string_view key, const std::string& id) {
  const auto ids = list_of<std::string>(row, key);
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

Requirement requirement_of(const toml::table& row) {
  Requirement out{.id = text_of(row, "id"),
                  .text = text_of(row, "text"),
                  .by = text_of(row, "by"),
                  .stages = list_of<std::string>(row, "stages"),
                  .faults = {},
                  .tests = {}};
  for (const auto number : list_of<std::int64_t>(row, "faults"))
    out.faults.push_back(static_cast<int>(number));
  for_each_row("test", [&out](const toml::table& test) {
    if (names(test, "proves", out.id)) out.tests.push_back(test_of(test));
  });
  return out;
}

}  // namespace

std::vector<Hazard> hazard_table() {
  std::vector<Hazard> table;
  for_each_row("hazard", [&table](const toml::table& row) {
    Hazard hazard{.id = text_of(row, "id"),
                  .hazard = text_of(row, "hazard"),
                  .cause = text_of(row, "cause"),
                  .remains = text_of(row, "remains"),
                  .requirements = {}};
    for_each_row("requirement", [&hazard](const toml::table& one) {
      if (names(one, "hazards", hazard.id)) hazard.requirements.push_back(requirement_of(one));
    });
    table.push_back(std::move(hazard));
  });
  return table;
}

std::vector<HazardTest> hazard_tests() {
  std::vector<HazardTest> all;
  for_each_row("test", [&all](const toml::table& row) { all.push_back(test_of(row)); });
  return all;
}

}  // namespace tact::tools::limits
