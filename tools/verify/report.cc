// SPDX-License-Identifier: Apache-2.0
#include "tools/verify/report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace tact::tools::verify {
namespace {

using nlohmann::json;

std::optional<double> as_number(const json& value) {
  if (value.is_number()) return value.get<double>();
  // JSON has no word for these.
  if (value == "NaN") return std::numeric_limits<double>::quiet_NaN();
  if (value == "Infinity") return std::numeric_limits<double>::infinity();
  if (value == "-Infinity") return -std::numeric_limits<double>::infinity();
  return std::nullopt;
}

bool is_near(double got, double want, double tolerance) {
  // Not by the difference: it would be NaN, which is within no tolerance.
  if (std::isnan(want)) return std::isnan(got);
  if (std::isinf(want)) return got == want;
  return std::abs(got - want) <= tolerance;
}

}  // namespace

Tolerance Tolerance::of_file(const json& file) {
  Tolerance out = Tolerance{}.for_case(file);
  if (file.contains("field_kinds")) file.at("field_kinds").get_to(out.kind_of);
  return out;
}

Tolerance Tolerance::for_case(const json& one_case) const {
  Tolerance out = *this;
  if (!one_case.contains("tolerance")) return out;
  const json& own = one_case.at("tolerance");
  if (own.contains("rel")) own.at("rel").get_to(out.rel);
  if (own.contains("abs")) own.at("abs").get_to(out.abs);
  return out;
}

double number(const json& value) {
  const std::optional<double> known = as_number(value);
  return known ? *known : value.get<double>();
}

void Report::begin_case(const std::string& id) {
  id_ = id;
  id_failed_ = false;
  ++cases_;
}

void Report::call_damaged(const std::string& message) {
  if (damage_.empty()) damage_ = message;
}

void Report::fail(Failure failure) {
  // A case counts once, however many of its fields are wrong.
  if (!id_failed_) ++failed_;
  id_failed_ = true;
  failures_.push_back(std::move(failure));
}

void Report::compare(const std::string& field, const json& got, const json& want, bool numeric,
                     double abs, double rel) {
  if (want.is_array()) {
    // Too short must not pass because the rest was not checked.
    if (!got.is_array() || got.size() != want.size())
      return fail({id_, field + " (length)", got.size(), want.size(), 0.0});
    for (std::size_t i = 0; i < want.size(); ++i)
      compare(field + "[" + std::to_string(i) + "]", got[i], want[i], numeric, abs, rel);
    return;
  }
  const std::optional<double> got_number = as_number(got), want_number = as_number(want);
  if (!got_number || !want_number) {
    if (got != want) fail({id_, field, got, want, 0.0});
    return;
  }
  // The larger of the two: rel alone would ask zero to be exact.
  const double tolerance = numeric ? std::max(abs, rel * std::abs(*want_number)) : 0.0;
  if (!is_near(*got_number, *want_number, tolerance)) fail({id_, field, got, want, tolerance});
}

void Report::compare_all(const json& got, const json& expect, const Tolerance& tolerance) {
  for (const auto& [field, want] : expect.items()) {
    const auto kind = tolerance.kind_of.find(field);
    const bool numeric = kind != tolerance.kind_of.end();
    double abs = 0.0;
    if (numeric && tolerance.abs.contains(kind->second)) abs = tolerance.abs.at(kind->second);
    // A field without a computation fails, too.
    compare(field, got.contains(field) ? got.at(field) : json("missing"), want, numeric, abs,
            tolerance.rel);
  }
}

}  // namespace tact::tools::verify
