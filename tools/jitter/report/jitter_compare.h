// SPDX-License-Identifier: Apache-2.0
// jitter_compare.h - two measurements side by side, and a gate: is the second one worse?
//
// Evaluated are p50, p99 and p99.9 of wake-up, tick and deadline to force. Worse is what grew by
// more than the gate and by more than 1 us: below that lie the clock's own steps and the cache. The
// largest of a run is shown, and never evaluated: two runs of the same loop differ there by chance.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "model/result.h"

namespace tact::tools::jitter {

struct ComparedValue {
  std::string series, share;  // "wake", "p99.9"
  std::uint64_t before_ns = 0, after_ns = 0;
  bool checked = false;
  bool worse = false;

  double change_ratio() const;  // 0.1: a tenth more
};

struct Comparison {
  std::vector<ComparedValue> values;
  std::vector<std::string> unlike;  // conditions that differ: "kernel_release 6.1 and 6.12"

  bool is_worse() const;
  bool checked_any() const;
};

/// `gate_ratio`: how much more is too much; nothing: only shown. An error when one of them is no
/// result of tact-jitter.
model::Result<Comparison> compare_results(const nlohmann::json& before, const nlohmann::json& after,
                                          std::optional<double> gate_ratio);

/// Reads a result; an error says what is wrong with the file.
model::Result<nlohmann::json> load_result(const std::string& path);

std::string make_comparison_text(const Comparison& comparison);
nlohmann::json to_json(const Comparison& comparison);

}  // namespace tact::tools::jitter
