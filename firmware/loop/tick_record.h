// SPDX-License-Identifier: Apache-2.0
// tick_record.h - all data of one tick: element of the ring buffer, source of telemetry and
// recordings.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <type_traits>

#include "firmware/loop/controller.h"

namespace tact::firmware::loop {

enum class Phase : std::uint8_t {
  kWake,
  kRead,
  kDetect,
  kRender,
  kLimit,
  kWrite,
  kPublish,
  kTotal
};
inline constexpr std::size_t kPhaseCount = 8;
inline constexpr std::array<const char*, kPhaseCount> kPhaseName{
    "wake", "read", "detect", "render", "limit", "write", "publish", "total"};

/// Contacts of the tool's spheres. A copy only copies the spheres in use: 168 bytes each.
class SphereContacts {
 public:
  using SphereContact = model::contact::SphereContact;

  SphereContacts() RT_SAFE {}
  SphereContacts(const SphereContacts& other) RT_SAFE { assign(other.all()); }
  SphereContacts& operator=(const SphereContacts& other) RT_SAFE {
    if (this != &other) assign(other.all());
    return *this;
  }
  /// Takes at most kMaxSpheres.
  void assign(std::span<const SphereContact> contacts) RT_SAFE {
    count_ = std::min(contacts.size(), model::contact::kMaxSpheres);
    std::copy_n(contacts.begin(), count_, contact_.begin());  // bound: spheres
  }
  std::span<const SphereContact> all() const RT_SAFE { return {contact_.data(), count_}; }

 private:
  static_assert(std::is_trivially_copyable_v<SphereContact>);
  std::size_t count_ = 0;
  union {  // so that the constructor writes nothing
    // NOLINTNEXTLINE(readability-identifier-naming): the union has no name, the member is private
    std::array<SphereContact, model::contact::kMaxSpheres> contact_;
  };
};

struct TickRecord {
  std::uint64_t tick = 0;
  std::int64_t due_ns = 0;          // its deadline on the fixed release schedule
  std::uint64_t late_ticks = 0;     // so far
  std::uint64_t skipped_ticks = 0;  // so far
  std::int64_t margin_ns = 0;       // of the previous tick: next deadline minus its end
  TickInput input;
  TickOutput output;
  std::array<std::int32_t, kPhaseCount>
      phase_ns{};               // of this tick up to write; publish and total of the previous tick
  std::uint8_t event = 0;       // of a person or program, in this tick alone; 0: none
  std::uint8_t event_word = 0;  // levels of the event lines
  bool sync = false;            // level of the sync line
  SphereContacts contacts;
};

}  // namespace tact::firmware::loop
