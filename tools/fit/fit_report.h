// SPDX-License-Identifier: Apache-2.0
// fit_report.h - a fit for people, for a scene and for machines: text, TOML, JSON, a picture.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "model/result.h"
#include "tools/fit/fit_prony.h"
#include "tools/fit/fit_run.h"

namespace tact::tools::fit {

/// Everything that one call fitted.
struct FitReport {
  std::optional<FitData> data{};
  std::vector<FittedLaw> laws{};
  std::vector<std::string> notes{};  // laws that could not be fitted, and why
  std::optional<PronyFit> relaxation{};

  /// At least one law follows the data, and the relaxation is good: what was asked for exists.
  bool follows() const;
  /// Least residual on the held-out sites, or on the fitted ones without any, first.
  void sort();
};

std::string text_of(const FitReport& report);
/// Sections to paste into a scene. Where two laws turn the same key, the first one has it and the
/// other's line is a comment.
std::string toml_of(const FitReport& report);
nlohmann::ordered_json json_of(const FitReport& report);
/// Writes what FILE.svg and FILE.png are drawn from; returns the job of lab/picture.py.
model::Result<nlohmann::json> picture_of(const FitReport& report, const std::string& file);

}  // namespace tact::tools::fit
