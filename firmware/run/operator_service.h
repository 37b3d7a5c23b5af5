// SPDX-License-Identifier: Apache-2.0
// operator_service.h - the main thread while the loop runs: signals, requests of tactctl, reports.
#pragma once

#include <cstdint>

#include "firmware/black_box/black_box.h"
#include "firmware/console/operator_signals.h"
#include "firmware/run/law_updater.h"
#include "firmware/run/loop_executor.h"

namespace tact::firmware::run {

struct ServiceParts {
  const model::scene::Scene& scene;
  LoopParts& parts;
  const console::OperatorSignals& signals;
  loop::Requests& requests;
  telemetry::Telemetry& telemetry;
  black_box::BlackBox* black_box;  // or null
  LawUpdater& updater;
  const loop::Progress& progress;
  std::int64_t period_ns;
};

/// Returns when the loop has ended.
void serve_operator(const ServiceParts& s, LoopExecutor& executor);

}  // namespace tact::firmware::run
