// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/emulators/run/run_record.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace tact::rig {
namespace {

constexpr unsigned kAllAxes = 7;
constexpr std::int64_t kBurst_ns = 200'000;  // within which the torques of one tick arrive

/// Only into the room that is there: the run never allocates.
template <typename T>
void keep(std::vector<T>& values, const T& value) {
  if (values.size() < values.capacity()) values.push_back(value);
}

nlohmann::json distribution(std::vector<std::int64_t> values) {
  if (values.empty()) return nullptr;
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    const double rank = std::ceil(share * static_cast<double>(values.size()));
    return values[static_cast<std::size_t>(std::max(1.0, rank)) - 1];
  };
  return {{"count", values.size()}, {"median", at(0.5)}, {"p99", at(0.99)}, {"max", values.back()}};
}
nlohmann::json when(std::int64_t time_ns) {
  return time_ns == 0 ? nlohmann::json(nullptr) : nlohmann::json(time_ns);
}

}  // namespace

RunRecord::RunRecord(double seconds, bool rows) {
  const auto ticks = static_cast<std::size_t>(1000.0 * std::clamp(seconds, 1.0, 3600.0)) + 1000;
  cycle_ns_.reserve(2 * ticks);
  own_ns_.reserve(2 * ticks);
  if (rows) rows_.reserve(ticks);
}

void RunRecord::watch(const Platform& platform, const Joints& tau_Nm, FaultPlan& faults,
                      std::int64_t now_ns) {
  const bool none = tau_Nm == Joints{};
  if (!none) torque_zero_since_ns_ = 0;
  if (none && had_torque_) torque_zero_since_ns_ = now_ns;
  had_torque_ = !none;
  const double force_N = none ? 0.0 : model::norm(platform.hand_force_N(tau_Nm));
  largest_force_N_ = std::max(largest_force_N_, force_N);
  for (const double tau : tau_Nm) largest_torque_Nm_ = std::max(largest_torque_Nm_, std::abs(tau));
  faults.watch(force_N, none, now_ns);
}

void RunRecord::commanded(int axis, const Platform& platform, const Joints& tau_Nm,
                          FaultPlan& faults, std::int64_t now_ns) {
  ++commands_;
  const unsigned mask = axis < 0 ? kAllAxes : 1u << static_cast<unsigned>(axis);
  for (unsigned i = 0; i < 3; ++i) {
    if ((mask >> i & 1u) == 0) continue;
    if (obeyed_ && commanded_ns_[i] != 0)
      oldest_command_ns_ = std::max(oldest_command_ns_, now_ns - commanded_ns_[i]);
    commanded_ns_[i] = now_ns;
  }
  // Between the first and the last torque of one tick no force was requested.
  const bool was_complete = answered_ == kAllAxes;
  answered_ |= mask;
  if (answered_ != kAllAxes) return;
  watch(platform, tau_Nm, faults, now_ns);
  if (was_complete || cycle_start_ns_ == 0) return;
  if (loop_runs_) keep(cycle_ns_, now_ns - cycle_start_ns_);
  loop_runs_ = true;  // the first has waited for the loop to begin
}

void RunRecord::tick(const Platform& platform, const Joints& tau_Nm, bool enabled,
                     FaultPlan& faults, std::int64_t now_ns) {
  obeyed_ = enabled;
  for (const std::int64_t last_ns : commanded_ns_)
    if (enabled && last_ns != 0 && tau_Nm != Joints{})
      oldest_command_ns_ = std::max(oldest_command_ns_, now_ns - last_ns);
  if (now_ns - *std::max_element(commanded_ns_.begin(), commanded_ns_.end()) > kBurst_ns ||
      !enabled)
    watch(platform, tau_Nm, faults, now_ns);
  if (rows_.capacity() > 0)
    keep(rows_, Row{now_ns, platform.position_m(), platform.hand_force_N(tau_Nm), tau_Nm});
}

void RunRecord::cycle_begins(std::int64_t now_ns) {
  ++cycles_;
  cycle_start_ns_ = now_ns;
  answered_ = 0;
}

void RunRecord::answer_sent(std::int64_t since_ns, std::int64_t now_ns) {
  keep(own_ns_, now_ns - since_ns);
}

std::string RunRecord::json(const std::string& protocol, const Platform& platform,
                            const FaultPlan& faults, int watchdog_trips) const {
  nlohmann::json out{{"protocol", protocol},
                     {"cycles", cycles_},
                     {"commands", commands_},
                     {"largest_hand_force_N", largest_force_N_},
                     {"largest_joint_torque_Nm", largest_torque_Nm_},
                     {"travel_m", platform.travel_m()},
                     {"lowest_z_m", platform.lowest_z_m()},
                     {"oldest_command_ns", oldest_command_ns_},
                     {"torque_zero_since_ns", when(torque_zero_since_ns_)},
                     {"watchdog_trips", watchdog_trips},
                     {"bus_cycle_ns", distribution(cycle_ns_)},
                     {"own_share_ns", distribution(own_ns_)},
                     {"faults", nlohmann::json::array()}};
  for (const Fault& fault : faults.faults()) {
    out["faults"].push_back({{"fault", fault.text},
                             {"injected_ns", when(fault.injected_ns)},
                             {"last_force_ns", when(fault.last_force_ns)},
                             {"torque_zero_ns", when(fault.torque_zero_ns)},
                             {"force_zero_ns", when(fault.force_zero_ns)},
                             {"largest_after_zero_N", fault.largest_after_zero_N},
                             {"largest_after_force_zero_N", fault.largest_after_force_zero_N},
                             {"watchdog_trips", fault.watchdog_trips},
                             {"acts", fault.acts}});
  }
  return out.dump();
}

bool RunRecord::write_csv(const std::string& path) const {
  std::FILE* const file = std::fopen(path.c_str(), "w");
  if (file == nullptr) return false;
  bool good = std::fputs("time_ns,x_m,y_m,z_m,Fx_N,Fy_N,Fz_N,tau1_Nm,tau2_Nm,tau3_Nm\n", file) >= 0;
  for (const Row& row : rows_) {
    good &= std::fprintf(file, "%lld,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g\n",
                         static_cast<long long>(row.time_ns), row.position_m.x, row.position_m.y,
                         row.position_m.z, row.force_N.x, row.force_N.y, row.force_N.z,
                         row.tau_Nm[0], row.tau_Nm[1], row.tau_Nm[2]) > 0;
  }
  return std::fclose(file) == 0 && good;
}

}  // namespace tact::rig
