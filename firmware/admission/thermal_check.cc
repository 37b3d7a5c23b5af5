// SPDX-License-Identifier: Apache-2.0
#include "firmware/admission/thermal_check.h"

#include <fmt/format.h>

#include <cmath>

#include "model/scene/scene_limits.h"

namespace tact::firmware::admission {

std::optional<model::Error> check_thermal(const model::scene::Scene& scene,
                                          const model::Limits& limits) {
  const double least_s = model::scene::least_thermal_time_s(limits, scene.rate_Hz);
  if (limits.thermal_time_s >= least_s) return std::nullopt;
  return model::Error{fmt::format(
      "{}: limits.thermal_time_s = {} is too short for this device, which bears {:.3g} N for long "
      "and {:.3g} N at most; allowed: {:.2f} or more, or a lower limits.force_N",
      scene.path, limits.thermal_time_s, limits.continuous_force_N, limits.force_N,
      std::ceil(100.0 * least_s) / 100.0)};
}

}  // namespace tact::firmware::admission
