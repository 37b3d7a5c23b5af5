// SPDX-License-Identifier: Apache-2.0
#include "firmware/run/operator_desk.h"

#include <fmt/format.h>

namespace tact::firmware::run {
namespace {

constexpr const char* kTooEarly = "the request came before it was ready";

}  // namespace

void OperatorDesk::obey(std::int64_t longest_ns) {
  const Act act = signals_.wait(longest_ns);
  if (act == Act::kLeave) requests_.stop.store(true);
  const bool just_told = show();
  if (act == Act::kReset) reset();
  if (act == Act::kArm && just_told) refuse("armed", kTooEarly);
  if (act == Act::kArm && !just_told) arm();
}

// A signal that came before the words, and be it in the moment before, is no answer to them.
bool OperatorDesk::show() {
  if (!view_.show(newest_())) return false;
  for (int early = signals_.forget(); early > 0; --early) refuse("armed or reset", kTooEarly);
  return true;
}

void OperatorDesk::arm() {
  if (const std::string why = view_.why_not_arm(); !why.empty()) return refuse("armed", why);
  const std::uint32_t before = requests_.refused.load();
  signals_.raise_edge(requests_.arm);
  if (requests_.refused.load() != before)
    view_.tell("not armed: no power, or no good sample in that moment; look, and arm again");
}

void OperatorDesk::reset() {
  if (const std::string why = view_.why_not_reset(); !why.empty()) return refuse("reset", why);
  signals_.raise_edge(requests_.reset);
}

void OperatorDesk::refuse(const char* what, const std::string& why) const {
  requests_.refused.fetch_add(1);
  view_.tell(fmt::format("not {}: {}", what, why));
}

}  // namespace tact::firmware::run
