// SPDX-License-Identifier: Apache-2.0
#include "model/reader/scene_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace tact::model::reader {
namespace {

/// Levenshtein's distance.
std::size_t edits_between(std::string_view a, std::string_view b) {
  // One row of the table of Levenshtein; diagonal is what it held before.
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, replaced});
    }
  }
  return row.back();
}

}  // namespace

bool differs_only_in_unit(std::string_view key, std::string_view known) {
  const io::UnitName* unit = io::find_unit(known);
  if (!unit || key == known) return false;
  const std::string_view stem = known.substr(0, known.size() - unit->suffix.size());
  // Any text behind the stem was meant as a unit, known or not.
  return key == stem || (key.starts_with(stem) && key[stem.size()] == '_');
}

std::size_t nearest_key(std::string_view key, std::span<const std::string_view> known) {
  constexpr std::size_t kLongestKey = 64;  // longer ones are no slip of the finger
  std::size_t nearest = std::string_view::npos, fewest = kLongestKey;
  for (std::size_t i = 0; i < known.size() && key.size() <= kLongestKey; ++i) {
    const std::size_t edits = edits_between(key, known[i]);
    if (edits < fewest && 2 * edits <= known[i].size()) nearest = i, fewest = edits;
  }
  return nearest;
}

void TextHash::add(std::string_view text) {
  hash_ = fnv1a(text, hash_);
  hash_ = fnv1a(std::string_view("\xff"), hash_);  // no UTF-8 text has this byte: ends one text
}

std::string TextHash::hex() const { return fmt::format("{:016x}", hash_); }

}  // namespace tact::model::reader
