// SPDX-License-Identifier: Apache-2.0
// case_run.h - one case in the real loop, tick by tick, with a record of everything that the
// verdict needs. Set up first, then play: a real device is never left alone between two cases.
#pragma once

#include <memory>
#include <vector>

#include "firmware/guardian/guardian.h"
#include "firmware/loop/rt_loop.h"
#include "hal/registry/open_device.h"
#include "model/scene/tissue.h"
#include "tools/limits/cases/player.h"

namespace tact::tools::limits {

/// One tick of a case.
struct TickRow {
  double t_s = 0.0;  // since the case began; below 0: the gate opens
  Vec3 commanded_N, gated_N, written_N;
  Vec3 commanded_Nm, gated_Nm, written_Nm;
  model::Tool tool;  // as the gate saw it
  bool fresh = false;
  bool armed = false;
  bool cause = false;                 // the case injects its fault in this tick
  std::uint32_t skipped_periods = 0;  // before this tick
  std::uint32_t acted = 0;            // one bit a stage
  Fault limit = Fault::kNone, fault = Fault::kNone;
  double given_energy_J = 0.0, rms_N = 0.0;         // as the gate reckons
  double gated_grip_N = 0.0, written_grip_N = 0.0;  // on the fingers
};

/// What all cases share.
struct LimitsBench {
  const model::scene::Scene& scene;
  model::Limits limits;      // of scene and device; what is claimed, and evaluated
  double force_share = 1.0;  // of them that the PC allows (session.h)
  bool hard_real_time = true;
  hal::Device* device = nullptr;                 // real; null: a simulated one for each case
  hal::SafetyLines* lines = nullptr;             // of it
  firmware::loop::Requests* requests = nullptr;  // of all cases on it; a fault of the watch stays
  const firmware::guardian::Guardian* guardian = nullptr;
  /// Makes the gate's limits from the claimed ones. Null: the same. Others are for tests that must
  /// fail, and for the wall without the passivity stage.
  model::Limits (*gate_limits)(const model::Limits&) = nullptr;

  double period_s() const { return 1.0 / scene.rate_Hz; }
};

/// The limits that one case is evaluated by: of scene, device, PC, and what the case tightens.
model::Limits checked_limits(const Case& c, const LimitsBench& bench);

class CaseRun {
 public:
  CaseRun(const Case& c, const LimitsBench& bench);
  CaseRun(const CaseRun&) = delete;
  CaseRun& operator=(const CaseRun&) = delete;

  /// The whole case; ends with zero force. Its ticks do not allocate. False after Ctrl-C or a stop
  /// request.
  bool play();
  /// For the watch above it (guarded_play.h).
  const firmware::loop::Progress& progress() const { return loop_->progress(); }
  /// Instead of play(): a fault before it that lets nothing be armed any more.
  void refuse(Fault fault) { refused_ = fault; }

  const Case& subject() const { return case_; }
  const std::vector<TickRow>& rows() const { return rows_; }
  const model::Limits& limits() const { return limits_; }  // evaluated by
  double period_s() const { return moment_.period_s; }
  /// The fault that kept it from arming.
  Fault refused() const { return refused_; }

 private:
  void approach(const firmware::loop::TickInput& at);
  void keep(const firmware::loop::TickRecord& record, bool cause);

  Case case_;
  model::Limits limits_;
  Moment moment_;
  model::scene::Scene scene_;  // a plate always in contact
  std::unique_ptr<model::scene::Tissue> tissue_;
  hal::registry::OpenDevice simulated_device_;
  hal::sim::SimLines simulated_lines_;
  hal::NoSafetyLines no_lines_;
  std::unique_ptr<firmware::loop::Clock> clock_;
  std::unique_ptr<PlayedDevice> device_;
  std::unique_ptr<PlayedLines> lines_;
  std::unique_ptr<CommandLaw> law_;
  std::unique_ptr<firmware::loop::Controller> controller_;
  firmware::loop::Requests own_requests_;
  firmware::loop::Requests& requests_;
  std::unique_ptr<firmware::loop::TickRing> ring_ = std::make_unique<firmware::loop::TickRing>();
  std::unique_ptr<firmware::loop::RtLoop> loop_;
  int lead_ticks_;       // after arming, until the gate is open
  int most_wait_ticks_;  // for arming
  std::array<std::uint64_t, firmware::gate::kStageCount> counted_{};
  Fault refused_ = Fault::kNone;
  std::int64_t begin_ns_ = 0;  // of t = 0
  std::vector<TickRow> rows_;
};

}  // namespace tact::tools::limits
