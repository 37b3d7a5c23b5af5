// scene_values.h - is this TOML value what a key allows?
//
// An answer is the rest of a sentence about the key, "= 5 is out of range"; it is empty where the
// value is good and has been stored, and the variable is untouched where it is not. NaN and
// infinity are numbers to TOML and never good here; a whole number may stand for any number, a
// number with a fraction never for a count. Set-up code only.
#pragma once

#include <toml++/toml.h>

#include <cstddef>
#include <string>
#include <string_view>

#include "model/types.h"

namespace tact::model {

/// Allowed values, both ends included.
struct Range {
  double low = 0.0, high = 0.0;
};
struct CountRange {
  std::size_t low = 0, high = 0;
};

/// "0 .. 0.05 m" for a key that ends in _m.
std::string range_text(Range range, std::string_view key);
std::string range_text(CountRange range);

/// "an array", "text"
std::string_view type_name(const toml::node& node);

std::string number_problem(const toml::node& node, Range range, double& value);
std::string count_problem(const toml::node& node, CountRange range, std::size_t& value);
std::string vector_problem(const toml::node& node, Range each, Vec3& value);
std::string text_problem(const toml::node& node, std::string& value);
std::string flag_problem(const toml::node& node, bool& value);

}  // namespace tact::model
