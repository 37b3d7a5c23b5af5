// SPDX-License-Identifier: Apache-2.0
#include "model/reader/scene_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

namespace tact::model::reader {
namespace {

struct UnitName {
  std::string_view suffix, unit;
};

// Longest first, so that _N_per_m is not read as _m.
constexpr std::array kUnits{
    UnitName{"_Nms_per_rad", "N m s/rad"},
    UnitName{"_words_per_Nm", "word/(N m)"},
    UnitName{"_Ns_per_m", "N s/m"},
    UnitName{"_turns_per_s", "turn/s"},
    UnitName{"_N_per_m", "N/m"},
    UnitName{"_N_per_s", "N/s"},
    UnitName{"_s_per_m", "s/m"},
    UnitName{"_turns", "turn"},
    UnitName{"_words", "word"},
    UnitName{"_kgm2", "kg m^2"},
    UnitName{"_rad", "rad"},
    UnitName{"_deg", "deg"},
    UnitName{"_Nm", "N m"},
    UnitName{"_kg", "kg"},
    UnitName{"_Hz", "Hz"},
    UnitName{"_Pa", "Pa"},
    UnitName{"_us", "us"},
    UnitName{"_m2", "m^2"},
    UnitName{"_m", "m"},
    UnitName{"_s", "s"},
    UnitName{"_N", "N"},
    UnitName{"_A", "A"},
    UnitName{"_J", "J"},
    UnitName{"_W", "W"},
    UnitName{"_mps", "m/s"},
    UnitName{"_radps", "rad/s"},
};

const UnitName* find_unit(std::string_view key) {
  for (const UnitName& unit : kUnits)
    if (key.ends_with(unit.suffix)) return &unit;
  return nullptr;
}

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

std::string_view unit_of_key(std::string_view key) {
  const UnitName* unit = find_unit(key);
  return unit ? unit->unit : std::string_view{};
}

bool differs_only_in_unit(std::string_view key, std::string_view known) {
  const UnitName* unit = find_unit(known);
  if (!unit || key == known) return false;
  const std::string_view stem = known.substr(0, known.size() - unit->suffix.size());
  // Whatever stands behind the stem was meant as a unit, known or not.
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
