// SPDX-License-Identifier: Apache-2.0
// reference_json.h - what the files of tact-reference have in common.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "model/result.h"
#include "model/types.h"

namespace tact::tools::ground_truth {

inline model::Vec3 vector_of(const nlohmann::json& j) {
  return {j.at(0).get<double>(), j.at(1).get<double>(), j.at(2).get<double>()};
}

inline std::string vector_text(const model::Vec3& v) {
  return fmt::format("[{:.7g}, {:.7g}, {:.7g}]", v.x, v.y, v.z);
}

/// What is not known is NaN, null in the file.
inline double error_of(const nlohmann::json& j) {
  return j.is_null() ? std::numeric_limits<double>::quiet_NaN() : j.get<double>();
}

inline std::string error_text(double ratio) {
  return std::isfinite(ratio) ? fmt::format("{:.3g}", ratio) : "null";
}

/// `make` is the command that makes such a file; `data_of` reads the JSON, `check` says what a
/// reader may not rely on.
template <typename DataOf, typename Check>
auto read_json(const std::string& path, const char* schema, const char* make, DataOf data_of,
               Check check) -> model::Result<decltype(data_of(nlohmann::json{}))> {
  using model::Error;
  std::ifstream file(path, std::ios::binary);
  if (!file)
    return Error{fmt::format("{}: cannot be read; check the name, or make it: {}", path, make)};
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  try {  // the library reports by exceptions; they end here
    const auto j = nlohmann::json::parse(text);
    if (j.value("schema", "") != schema)
      return Error{
          fmt::format("{}: \"schema\" is not \"{}\"; make it again: {}", path, schema, make)};
    auto data = data_of(j);
    if (const std::optional<Error> error = check(data))
      return Error{fmt::format("{}: {}; make it again: {}", path, error->sentence, make)};
    return data;
  } catch (const nlohmann::json::exception& e) {
    return Error{fmt::format("{}: {}; make it again: {}", path, e.what(), make)};
  }
}

}  // namespace tact::tools::ground_truth
