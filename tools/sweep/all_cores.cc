// SPDX-License-Identifier: Apache-2.0
#include "tools/sweep/all_cores.h"

#include "tools/program/run_program.h"
#include "tools/program/sweep.h"

namespace tact::tools::sweep {

using model::Result;
using model::scene::Presser;
using model::scene::PressSweep;

Result<PressSweep> sweep_on_all_cores(const model::scene::Scene& scene,
                                      std::span<const model::scene::PressPoint> places,
                                      const model::scene::PressSettings& settings) {
  const auto first = Presser::make(scene, settings);
  if (!first) return first.error();
  auto results = program::sweep<model::scene::PressResult>(
      places.size(), {.label = "tact-lab sweep"}, [&](std::size_t job) {
        // Each worker thread lives for this sweep and has one; after the first none can fail.
        thread_local const auto presser = Presser::make(scene, settings);
        return (*presser)->press(places[job]);
      });
  if (!results) return program::interruption();
  return PressSweep{.settings = (*first)->settings(), .results = std::move(*results)};
}

}  // namespace tact::tools::sweep
