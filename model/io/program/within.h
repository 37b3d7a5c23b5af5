// SPDX-License-Identifier: Apache-2.0
// within.h - the one check of a number on a command line: a finite number, all of the word, in its
// range. Reals and whole numbers alike: CLI11 refuses a fraction where a whole number belongs.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <string>

namespace tact::model::io {

/// For the check() of a CLI11 option. nan, inf, 1e400 and what is no number are refused.
inline CLI::Validator within(double low, double high) {
  const std::string range = fmt::format("in [{:.10g} - {:.10g}]", low, high);
  return {[low, high, range](std::string& word) {
            const bool plus = word.starts_with('+') && !word.starts_with("+-");
            const char* const first = word.data() + (plus ? 1 : 0);
            const char* const last = word.data() + word.size();
            double value = 0.0;
            const auto [end, wrong] = std::from_chars(first, last, value);
            if (wrong != std::errc{} || end != last || !std::isfinite(value))
              return fmt::format("\"{}\" is no finite number {}", word, range);
            if (value < low || value > high) return fmt::format("{} is not {}", word, range);
            return std::string();
          },
          range};
}

/// Above 0, and no larger or smaller than arithmetic likes.
inline CLI::Validator above_zero() { return within(1e-12, 1e12); }

}  // namespace tact::model::io
