// SPDX-License-Identifier: Apache-2.0
#include "model/parameters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace tact::model {
namespace {

/// NaN is in no range.
bool has_meaning(double value, const Range& range) {
  if (range.is_hard) return value >= range.low && value <= range.high;
  if (!std::isfinite(value)) return false;
  if (range.low > 0.0) return value > 0.0;
  return range.low < 0.0 || value >= 0.0;
}

}  // namespace

void ParameterList::count(std::string_view key, CountRange range, std::string_view meaning,
                          std::size_t& value, Need) {
  const Range ends{static_cast<double>(range.low), static_cast<double>(range.high), range.is_hard};
  all.push_back({.key = key, .meaning = meaning, .range = ends, .count = &value});
}

Parameter ParameterList::find(std::string_view key) const {
  const auto found = std::ranges::find(all, key, &Parameter::key);
  return found == all.end() ? Parameter{} : *found;
}

std::optional<Error> ParameterList::check(std::string_view owner) const {
  for (const Parameter& p : all) {
    if (has_meaning(p.value(), p.range)) continue;
    std::array<char, 96> text{};
    std::snprintf(text.data(), text.size(), " = %g; allowed: %g .. %g", p.value(), p.range.low,
                  p.range.high);
    return Error{std::string(owner) + ": " + std::string(p.key) + text.data()};
  }
  return std::nullopt;
}

}  // namespace tact::model
