// SPDX-License-Identifier: Apache-2.0
// labels.h - names of a record's numbers, for tables that people read.
#pragma once

#include "firmware/loop/state.h"
#include "model/fault.h"

namespace tact::firmware::protocol {

inline const char* state_name(std::uint64_t number) {
  return number < loop::kStateTable.size() ? loop::name_of(static_cast<loop::State>(number))
                                           : "unknown";
}
inline const char* fault_name(std::uint64_t number) {
  return model::describe(static_cast<model::Fault>(number)).name;
}

}  // namespace tact::firmware::protocol
