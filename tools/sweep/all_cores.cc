// SPDX-License-Identifier: Apache-2.0
#include "tools/sweep/all_cores.h"

#include <memory>
#include <mutex>
#include <vector>

#include "tools/program/run_program.h"
#include "tools/program/sweep.h"

namespace tact::tools::sweep {

using model::Result;
using model::scene::Presser;
using model::scene::PressSweep;

namespace {

/// One presser for each thread that works at a time.
class Pressers {
 public:
  Pressers(const model::scene::Scene& scene, std::unique_ptr<Presser> first) : scene_(scene) {
    settings_ = first->settings();
    idle_.push_back(std::move(first));
  }

  model::scene::PressResult press(const model::scene::PressPoint& place) {
    std::unique_ptr<Presser> presser = take();
    const auto result = presser->press(place);
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(presser));
    return result;
  }

 private:
  std::unique_ptr<Presser> take() {
    {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        auto presser = std::move(idle_.back());
        idle_.pop_back();
        return presser;
      }
    }
    return std::move(*Presser::make(scene_, settings_));  // as the first: it cannot fail
  }

  const model::scene::Scene& scene_;
  model::scene::PressSettings settings_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Presser>> idle_;
};

}  // namespace

Result<PressSweep> sweep_on_all_cores(const model::scene::Scene& scene,
                                      std::span<const model::scene::PressPoint> places,
                                      const model::scene::PressSettings& settings) {
  auto first = Presser::make(scene, settings);
  if (!first) return first.error();
  PressSweep out{.settings = (*first)->settings(), .results = {}};
  Pressers pressers(scene, std::move(*first));
  auto results = program::sweep<model::scene::PressResult>(
      places.size(), {.label = "tact-lab sweep"},
      [&](std::size_t job) { return pressers.press(places[job]); });
  if (!results) return program::interruption();
  out.results = std::move(*results);
  return out;
}

}  // namespace tact::tools::sweep
