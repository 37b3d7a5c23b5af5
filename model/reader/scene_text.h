// SPDX-License-Identifier: Apache-2.0
// scene_text.h - the small language of scene keys: units in names, and what was probably meant.
//
// A key is a stem and a unit, rod_length + _m. Same stem, other unit: a wrong unit, not a wrong
// key. Otherwise the nearest key is the one with the fewest edits (insert, delete, replace,
// V. Levenshtein, Sov. Phys. Dokl. 10 (1966) 707), if these are at most half of its length.
// Set-up code only.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "model/fnv1a.h"
#include "model/io/one_line.h"
#include "model/io/unit_name.h"

namespace tact::model::reader {

/// True for depth_mm, or depth, when the known key is depth_m.
bool differs_only_in_unit(std::string_view key, std::string_view known);

/// The known key that `key` was probably meant to be; npos where nothing is near.
std::size_t nearest_key(std::string_view key, std::span<const std::string_view> known);

using io::is_control;
using io::on_one_line;

/// 16 hex digits of the FNV-1a hash of the texts in order.
class TextHash {
 public:
  void add(std::string_view text);
  std::string hex() const;

 private:
  std::uint64_t hash_ = kFnvStart;
};

}  // namespace tact::model::reader
