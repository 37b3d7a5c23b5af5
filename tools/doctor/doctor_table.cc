// SPDX-License-Identifier: Apache-2.0
#include "tools/doctor/doctor_table.h"

#include <fmt/format.h>

#include <algorithm>

namespace tact::tools::doctor {
namespace {

using firmware::pc::PcRow;
using firmware::pc::Verdict;

const char* ink_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kGreen:
      return "\033[32m";
    case Verdict::kRed:
      return "\033[31m";
    case Verdict::kUnknown:
      break;
  }
  return "\033[33m";
}

}  // namespace

std::string make_doctor_table(const std::vector<PcRow>& rows, bool colour) {
  std::size_t width = 0;
  for (const PcRow& row : rows) width = std::max(width, row.name.size());
  std::string out;
  for (const PcRow& row : rows) {
    const std::string verdict = fmt::format("{:7}", name_of(row.verdict));
    out += fmt::format("{:{}}  {}  {}\n", row.name, width,
                       colour ? ink_of(row.verdict) + verdict + "\033[0m" : verdict, row.found);
    if (row.verdict == Verdict::kGreen) continue;
    out += fmt::format("{:{}}           why:  {}\n", "", width, row.why);
    out += fmt::format("{:{}}           cure: {}\n", "", width, row.cure);
  }
  const auto count = [&](Verdict verdict) {
    return std::count_if(rows.begin(), rows.end(),
                         [&](const PcRow& row) { return row.verdict == verdict; });
  };
  return out + fmt::format("{} green, {} red, {} unknown\n", count(Verdict::kGreen),
                           count(Verdict::kRed), count(Verdict::kUnknown));
}

}  // namespace tact::tools::doctor
