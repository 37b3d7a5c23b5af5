// SPDX-License-Identifier: Apache-2.0
#include "hal/can/can_lock.h"

#include <fmt/format.h>
#include <net/if.h>

#include <array>

#include "hal/device_lock.h"

namespace tact::hal::can {

using model::Error;

std::optional<Error> lock_drives(const model::CanSettings& settings, bool gives_sync) {
  std::array<char, IF_NAMESIZE> name{};  // its own: an interface may have other names beside it
  const unsigned index = if_nametoindex(settings.interface.c_str());
  if (index == 0 || if_indextoname(index, name.data()) == nullptr) return std::nullopt;
  for (const int node : settings.node)
    if (auto error = lock_device(fmt::format("{}, node {}", name.data(), node))) return error;
  return gives_sync ? lock_device(fmt::format("the SYNC of {}", name.data())) : std::nullopt;
}

}  // namespace tact::hal::can
