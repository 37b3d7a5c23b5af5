// SPDX-License-Identifier: Apache-2.0
// reference_json.h - what the files of tact-lab reference have in common.
#pragma once

#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "model/io/json.h"
#include "model/result.h"
#include "model/types.h"
#include "tools/ground_truth/solved_body.h"

namespace tact::tools::ground_truth {

inline model::Vec3 vector_of(const nlohmann::json& j) {
  return {j.at(0).get<double>(), j.at(1).get<double>(), j.at(2).get<double>()};
}

/// What is not known is NaN, null in the file.
inline double error_of(const nlohmann::json& j) {
  return j.is_null() ? std::numeric_limits<double>::quiet_NaN() : j.get<double>();
}

inline SolvedBody body_of(const nlohmann::json& j) {
  return {.mesh = j.at("mesh").get<std::string>(),
          .mesh_hash = j.at("mesh_hash").get<std::string>(),
          .solver = j.at("solver").get<std::string>(),
          .youngs_modulus_Pa = j.at("youngs_modulus_Pa").get<double>(),
          .poisson_ratio = j.at("poisson_ratio").get<double>(),
          .fixed_min_m = vector_of(j.at("fixed_min_m")),
          .fixed_max_m = vector_of(j.at("fixed_max_m"))};
}

/// `make` is the command that makes such a file; `data_of` reads the JSON, `check` says what a
/// reader may not rely on.
template <typename DataOf, typename Check>
auto read_json(const std::string& path, const char* schema, const char* make, DataOf data_of,
               Check check) -> model::Result<decltype(data_of(nlohmann::json{}))> {
  using model::Error;
  const auto parsed =
      model::io::read_json(path, fmt::format("check the name, or make it: {}", make));
  if (!parsed) return parsed.error();
  try {  // the library reports by exceptions; they end here
    const nlohmann::json& j = *parsed;
    if (j.value("schema", "") != schema)
      return Error{
          fmt::format("{}: \"schema\" is not \"{}\"; make it again: {}", path, schema, make)};
    auto data = data_of(j);
    if (const std::optional<Error> error = check(data))
      return Error{fmt::format("{}: {}; make it again: {}", path, error->message, make)};
    return data;
  } catch (const nlohmann::json::exception& e) {
    return Error{fmt::format("{}: {}; make it again: {}", path, e.what(), make)};
  }
}

}  // namespace tact::tools::ground_truth
