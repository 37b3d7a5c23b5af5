// SPDX-License-Identifier: Apache-2.0
#include "tools/doctor/fix_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <string_view>

namespace tact::tools::doctor {
namespace {

using firmware::pc::PcQuestion;
using firmware::pc::PcRow;
using firmware::pc::Verdict;
using Rows = std::vector<PcRow>;
using Names = std::initializer_list<std::string_view>;

// As tools/deploy/haptics.conf, which the package has: a test compares them.
constexpr const char* kLimits =
    R"(# SPDX-License-Identifier: Apache-2.0
# Group haptics may use real-time priorities up to 85 and lock its memory: the loop runs at
# SCHED_FIFO 80. Goes to /etc/security/limits.d/ (tools/deploy/install); holds from the next login.
@haptics - rtprio 85
@haptics - memlock unlimited
)";

constexpr const char* kUnitText =
    R"(# tact-doctor --fix: core {0} is the loop's. tact-doctor --undo takes this away.
[Unit]
Description=Full CPU speed, and no interrupts on core {0}, for tact
After=irqbalance.service

[Service]
Type=oneshot
RemainAfterExit=yes
ExecStart=/bin/sh -c 'for f in /sys/devices/system/cpu/cpu*/cpufreq/scaling_governor; do [ ! -w $$f ] || echo performance >$$f; done'
# Those of a core's own timer cannot be moved.
ExecStart=/bin/sh -c 'for f in /proc/irq/*/smp_affinity_list; do echo {1} >$$f || true; done 2>/dev/null'

[Install]
WantedBy=multi-user.target
)";

const PcRow* red_row(const Rows& rows, std::string_view name) {
  for (const PcRow& row : rows)
    if (row.name == name && row.verdict == Verdict::kRed) return &row;
  return nullptr;
}

bool any_red(const Rows& rows, Names names) {
  return std::ranges::any_of(names, [&](auto name) { return red_row(rows, name) != nullptr; });
}

/// Somebody else has given the kernel isolated cores: two answers would contradict each other.
bool is_isolated_by_another(const PcQuestion& q) {
  const auto given = q.files.line("/proc/cmdline");
  return given && given->find("isolcpus=") != std::string::npos && !q.files.is_there(kGrubDropIn);
}

bool plan_core(const PcQuestion& q, const std::string& others, FixPlan& plan) {
  if (others.empty() || is_isolated_by_another(q)) return false;
  plan.files.push_back(
      {kGrubDropIn,
       fmt::format("# tact-doctor --fix: core {} is the loop's. tact-doctor --undo takes this "
                   "away.\nGRUB_CMDLINE_LINUX=\"$GRUB_CMDLINE_LINUX {}\"\n",
                   q.core, firmware::pc::isolation_parameters(q))});
  plan.commands.push_back(
      {.file = kGrubDropIn, .words = {"update-grub"}, .back = {"update-grub"}, .back_last = true});
  return true;
}

void plan_unit(const PcQuestion& q, const std::string& others, FixPlan& plan) {
  plan.files.push_back({kUnit, fmt::format(fmt::runtime(kUnitText), q.core, others)});
  plan.commands.push_back({.file = kUnit,
                           .words = {"systemctl", "daemon-reload"},
                           .back = {"systemctl", "daemon-reload"},
                           .back_last = true});
  plan.commands.push_back({.file = kUnit,
                           .words = {"systemctl", "enable", "tact-pc.service"},
                           .back = {"systemctl", "disable", "tact-pc.service"}});
  plan.commands.push_back({.file = kUnit,
                           .words = {"systemctl", "start", "tact-pc.service"},
                           .back = {"systemctl", "stop", "tact-pc.service"}});
}

void plan_group(const FixPeople& people, FixPlan& plan) {
  if (!people.has_group)
    plan.commands.push_back({.file = "",
                             .words = {"groupadd", "--system", "haptics"},
                             .back = {"groupdel", "haptics"}});
  if (!people.user.empty())
    plan.commands.push_back({.file = "",
                             .words = {"usermod", "-aG", "haptics", people.user},
                             .back = {"gpasswd", "-d", people.user, "haptics"}});
}

}  // namespace

FixPlan plan_fix(const PcQuestion& question, const Rows& rows, const FixPeople& people) {
  const PcQuestion q{.files = question.files, .core = firmware::pc::core_in_question(question)};
  const std::string others = firmware::pc::other_cpus(q);
  FixPlan plan;
  std::vector<std::string_view> done{"real-time priority", "locked memory"};
  const auto take = [&](Names names) { done.insert(done.end(), names); };
  if (any_red(rows, {"isolated core", "timer tick"}) && plan_core(q, others, plan))
    take({"isolated core", "timer tick"});
  if (any_red(rows, {"interrupts", "CPU governor"}) && !others.empty()) {
    plan_unit(q, others, plan);
    take({"interrupts", "CPU governor"});
  }
  plan.files.push_back({kLimitsDropIn, kLimits});
  plan_group(people, plan);
  for (const PcRow& row : rows)
    if (row.verdict == Verdict::kRed && std::ranges::find(done, row.name) == done.end())
      plan.left.push_back(fmt::format("{}: {}", row.name, row.cure));
  return plan;
}

}  // namespace tact::tools::doctor
