// SPDX-License-Identifier: Apache-2.0
// scene_values.h - is this TOML value what a key allows?
//
// An error is the rest of a message about the key, "= 5 is out of range". NaN and infinity are
// numbers to TOML and never good here; a whole number may stand for any number, a number with a
// fraction never for a count. Set-up code only.
#pragma once

#include <toml++/toml.h>

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "model/parameters.h"
#include "model/result.h"
#include "model/types.h"

namespace tact::model::reader {

/// "0 .. 0.05 m" for a key that ends in _m.
std::string range_text(Range range, std::string_view key);
std::string range_text(CountRange range);

/// "an array", "text"
std::string_view type_name(const toml::node& node);

Result<double> as_number(const toml::node& node, Range range);
Result<std::size_t> as_count(const toml::node& node, CountRange range);
Result<Vec3> as_vector(const toml::node& node, Range each);
/// `names`: one letter for each number, which an error names.
template <std::size_t n>
Result<std::array<double, n>> as_numbers(const toml::node& node, Range each,
                                         const char (&names)[n + 1]);
/// A list of [a, b, c, d].
Result<std::vector<std::array<double, 4>>> as_rows(const toml::node& node, Range each);
Result<std::string> as_text(const toml::node& node);
Result<bool> as_flag(const toml::node& node);

}  // namespace tact::model::reader
