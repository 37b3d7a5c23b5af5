// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/emulators/cia402/object_dictionary.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tact::rig {
namespace {

using enum WireType;
constexpr std::int64_t kPdoOff = 0x8000'0000, kNoRequest = 0x4000'0000;
constexpr int kMaxPdo_bits = 64, kMaxMapped = 4;

/// The field of an entry alone in its bytes.
WireField whole(WireType type) { return {"", 0, type}; }

constexpr bool is_pdo_parameter(std::uint16_t index) { return index == 0x1400 || index == 0x1800; }
constexpr bool is_pdo_mapping(std::uint16_t index) { return index == 0x1600 || index == 0x1A00; }

struct Mapped {  // u32: index << 16 | sub << 8 | bits
  std::uint16_t index;
  std::uint8_t sub;
  int bits;
  explicit Mapped(std::int64_t entry)
      : index(static_cast<std::uint16_t>(entry >> 16 & 0xFFFF)),
        sub(static_cast<std::uint8_t>(entry >> 8 & 0xFF)),
        bits(static_cast<int>(entry & 0xFF)) {}
};

}  // namespace

Sdo sdo_abort(std::uint16_t index, std::uint8_t sub, SdoAbort code) {
  Sdo answer{0x80};
  put_raw(std::span(answer).subspan(1, 2), index);
  answer[3] = sub;
  put_raw(std::span(answer).subspan(4), static_cast<std::uint32_t>(code));
  return answer;
}

ObjectDictionary::ObjectDictionary(int node, double rated_torque_Nm, ObjectHabits habits)
    : habits_(std::move(habits)),
      entries_{
          {0x1000, 0, kU32, false, false, 0x00020192},  // servo drive, profile 402
          {0x1001, 0, kU8, false, true, 0},             // error register
          {0x1003, 0, kU8, true, false, 0},
          {0x1003, 1, kU32, false, false, 0},  // the newest error
          {0x1005, 0, kU32, true, false, habits_.sync_id},
          {0x1006, 0, kU32, true, false, habits_.sync_period_us},
          {0x100C, 0, kU16, true, false, habits_.guard_time_ms},
          {0x100D, 0, kU8, true, false, habits_.life_time_factor},
          {0x1014, 0, kU32, true, false, 0x80 + node},
          {0x1016, 0, kU8, false, false, 2},
          {0x1016, 1, kU32, true, false, 0},
          {0x1016, 2, kU32, true, false, habits_.second_watch},
          {0x1017, 0, kU16, true, false, 0},
          {0x1018, 0, kU8, false, false, 4},
          {0x1018, 1, kU32, false, false, 0x7AC7},  // an unused vendor id
          {0x1018, 2, kU32, false, false, 0x0402},
          {0x1018, 3, kU32, false, false, 0x0001'0000},
          {0x1018, 4, kU32, false, false, 1000 + node},
          {0x1019, 0, kU8, true, false, habits_.sync_counter},
          {0x1400, 0, kU8, false, false, 5},
          {0x1400, 1, kU32, true, false, 0x200 + node},
          {0x1400, 2, kU8, true, false, 255},
          {0x1400, 5, kU16, true, false, 0},
          {0x1600, 0, kU8, true, false, 1},
          {0x1600, 1, kU32, true, false, 0x60400010},
          {0x1600, 2, kU32, true, false, 0},
          {0x1600, 3, kU32, true, false, 0},
          {0x1600, 4, kU32, true, false, 0},
          {0x1800, 0, kU8, false, false, 5},
          {0x1800, 1, kU32, true, false, kPdoOff + 0x180 + node},
          {0x1800, 2, kU8, true, false, 1},
          {0x1A00, 0, kU8, true, false, 1},
          {0x1A00, 1, kU32, true, false, 0x60410010},
          {0x1A00, 2, kU32, true, false, 0},
          {0x1A00, 3, kU32, true, false, 0},
          {0x1A00, 4, kU32, true, false, 0},
          {0x6007, 0, kI16, true, false, 1},
          {0x603F, 0, kU16, false, true, 0},
          {0x6040, 0, kU16, true, true, 0},
          {0x6041, 0, kU16, false, true, 0},
          {0x605A, 0, kI16, true, false, 2},
          {0x605E, 0, kI16, true, false, 0},
          {0x6060, 0, kI8, true, true, 0},
          {0x6061, 0, kI8, false, true, 0},
          {0x6064, 0, kI32, false, true, 0},
          {0x606C, 0, kI32, false, true, 0},
          {0x6071, 0, kI16, true, true, 0},
          {0x6072, 0, kU16, true, true, 3000},
          {0x6075, 0, kU32, false, false, 4000},
          {0x6076, 0, kU32, false, false, std::llround(1000.0 * rated_torque_Nm)},
          {0x6077, 0, kI16, false, true, 0},
          {0x60B2, 0, kI16, true, true, 0},
          {0x60C2, 0, kU8, false, false, 2},
          {0x60C2, 1, kU8, true, false, 1},
          {0x60C2, 2, kI8, true, false, -3},
          {0x6502, 0, kU32, false, false, 1 << 9},  // supported modes: cyclic synchronous torque
      } {
  if (habits_.no_request_stays) set(0x1800, 1, get(0x1800, 1) | kNoRequest);
  std::erase_if(entries_, [this](const DictionaryEntry& entry) {
    return std::find(habits_.absent.begin(), habits_.absent.end(), entry.index) !=
           habits_.absent.end();
  });
}

const DictionaryEntry* ObjectDictionary::find(std::uint16_t index, std::uint8_t sub) const {
  for (const DictionaryEntry& entry : entries_)
    if (entry.index == index && entry.sub == sub) return &entry;
  return nullptr;
}
DictionaryEntry* ObjectDictionary::find(std::uint16_t index, std::uint8_t sub) {
  for (DictionaryEntry& entry : entries_)
    if (entry.index == index && entry.sub == sub) return &entry;
  return nullptr;
}

std::int64_t ObjectDictionary::get(std::uint16_t index, std::uint8_t sub) const {
  const DictionaryEntry* const entry = find(index, sub);
  return entry == nullptr ? 0 : entry->value;
}
void ObjectDictionary::set(std::uint16_t index, std::uint8_t sub, std::int64_t value) {
  if (DictionaryEntry* const entry = find(index, sub)) entry->value = value;
}

SdoAbort ObjectDictionary::check_pdo(const DictionaryEntry& entry, std::int64_t value,
                                     bool is_operational) const {
  if (is_operational) return SdoAbort::kWrongState;
  const std::int64_t cob_id = is_pdo_mapping(entry.index)
                                  ? get(static_cast<std::uint16_t>(entry.index - 0x200), 1)
                                  : get(entry.index, 1);
  const bool is_on = (cob_id & kPdoOff) == 0;
  if (is_pdo_mapping(entry.index))
    return is_on ? SdoAbort::kWrongState : check_mapping(entry, value);
  if (entry.sub == 1) {
    // While it is on, only switching it off is allowed.
    if (is_on && (value & 0x7FF) != (cob_id & 0x7FF)) return SdoAbort::kBadValue;
    const bool requested = entry.index == 0x1800 && (value & kNoRequest) == 0;
    if (habits_.no_request_stays && requested) return SdoAbort::kBadValue;
    return (value & 0x3FFF'F800) != 0 ? SdoAbort::kBadValue : SdoAbort::kNone;
  }
  if (entry.sub == 2 && entry.index == 0x1800 && (value < 1 || value > 240))
    return SdoAbort::kBadValue;
  if (entry.sub == 2 && entry.index == 0x1400 && value > 240 && value < 254)
    return SdoAbort::kBadValue;
  return SdoAbort::kNone;
}

SdoAbort ObjectDictionary::check_mapping(const DictionaryEntry& entry, std::int64_t value) const {
  if (entry.sub != 0) {
    if (get(entry.index, 0) != 0) return SdoAbort::kWrongState;
    const Mapped mapped(value);
    const DictionaryEntry* const object = find(mapped.index, mapped.sub);
    const bool receives = entry.index == 0x1600;
    if (object == nullptr || !object->is_mappable || (receives && !object->is_writable) ||
        mapped.bits != 8 * static_cast<int>(wire_size(object->type)))
      return SdoAbort::kNotMappable;
    return SdoAbort::kNone;
  }
  if (value > kMaxMapped) return SdoAbort::kMappingTooLong;
  int bits = 0;
  const auto count = static_cast<std::uint8_t>(value);
  for (std::uint8_t sub = 1; sub <= count; ++sub) {
    const Mapped mapped(get(entry.index, sub));
    if (mapped.bits == 0) return SdoAbort::kNotMappable;
    bits += mapped.bits;
  }
  return bits > kMaxPdo_bits ? SdoAbort::kMappingTooLong : SdoAbort::kNone;
}

SdoAbort ObjectDictionary::download(std::uint16_t index, std::uint8_t sub,
                                    std::span<const std::uint8_t> data, bool is_operational) {
  DictionaryEntry* const entry = find(index, sub);
  if (entry == nullptr)
    return find(index, 0) == nullptr ? SdoAbort::kNoObject : SdoAbort::kNoSubIndex;
  if (!entry->is_writable) return SdoAbort::kReadOnly;
  if (data.size() != wire_size(entry->type)) return SdoAbort::kWrongLength;
  const auto value = static_cast<std::int64_t>(get_field(data, whole(entry->type)));
  if (is_pdo_parameter(index) || is_pdo_mapping(index)) {
    const SdoAbort abort = check_pdo(*entry, value, is_operational);
    if (abort != SdoAbort::kNone) return abort;
  }
  const bool watches = (entry->value & 0xFFFF) != 0 && (value & 0xFFFF) != 0;
  if (index == 0x1016 && habits_.watch_off_first && watches && value >> 16 == entry->value >> 16)
    return SdoAbort::kContradiction;
  // No node is watched twice.
  const std::int64_t other = get(0x1016, sub == 1 ? 2 : 1);
  const bool twice = (value & 0xFFFF) != 0 && (other & 0xFFFF) != 0 && value >> 16 == other >> 16;
  if (index == 0x1016 && twice) return SdoAbort::kContradiction;
  if (index == 0x1019 && get(0x1006) != 0) return SdoAbort::kWrongState;
  if (index == 0x6060 && value != 0 && value != 10) return SdoAbort::kBadValue;
  entry->value = value;
  if (index == 0x6060) set(0x6061, 0, value == 10 ? habits_.mode_shown : value);
  return SdoAbort::kNone;
}

Sdo ObjectDictionary::serve(std::span<const std::uint8_t> request, bool is_operational) {
  Sdo answer{};
  std::array<std::uint8_t, 8> asked{};
  std::copy_n(request.begin(), std::min(request.size(), asked.size()), asked.begin());
  std::copy_n(asked.begin() + 1, 3, answer.begin() + 1);
  const auto index = static_cast<std::uint16_t>(asked[1] | asked[2] << 8);
  const std::uint8_t sub = asked[3], command = asked[0];
  SdoAbort abort = SdoAbort::kUnknownCommand;
  if (command == 0x40) {
    if (const DictionaryEntry* const entry = find(index, sub)) {
      const std::size_t size = wire_size(entry->type);
      answer[0] = static_cast<std::uint8_t>(0x43u | (4 - size) << 2u);
      if (habits_.sizes_unsaid) answer = {0x42, asked[1], asked[2], sub, 0xEE, 0xEE, 0xEE, 0xEE};
      put_field(std::span(answer).subspan(4), whole(entry->type),
                static_cast<double>(entry->value));
      abort = SdoAbort::kNone;
    } else {
      abort = find(index, 0) == nullptr ? SdoAbort::kNoObject : SdoAbort::kNoSubIndex;
    }
  } else if ((command & 0xF3u) == 0x23u) {  // expedited, size given
    const std::size_t size = 4u - (command >> 2u & 3u);
    abort = download(index, sub, std::span(asked).subspan(4, size), is_operational);
    answer[0] = 0x60;
  }
  return abort == SdoAbort::kNone ? answer : sdo_abort(index, sub, abort);
}

std::uint8_t ObjectDictionary::mapped_count(std::uint16_t mapping) const {
  return static_cast<std::uint8_t>(get(mapping, 0));  // kMaxMapped at most
}

std::size_t ObjectDictionary::pack(std::uint16_t mapping,
                                   std::span<std::uint8_t, 8> payload) const {
  std::size_t at = 0;
  for (std::uint8_t sub = 1; sub <= mapped_count(mapping); ++sub) {
    const Mapped mapped(get(mapping, sub));
    const DictionaryEntry* const entry = find(mapped.index, mapped.sub);
    put_field(payload.subspan(at), whole(entry->type), static_cast<double>(entry->value));
    at += wire_size(entry->type);
  }
  return at;
}

bool ObjectDictionary::unpack(std::uint16_t mapping, std::span<const std::uint8_t> payload) {
  std::size_t at = 0;
  for (std::uint8_t sub = 1; sub <= mapped_count(mapping); ++sub)
    at += wire_size(find(Mapped(get(mapping, sub)).index, Mapped(get(mapping, sub)).sub)->type);
  if (at != payload.size()) return false;
  at = 0;
  for (std::uint8_t sub = 1; sub <= mapped_count(mapping); ++sub) {
    const Mapped mapped(get(mapping, sub));
    DictionaryEntry* const entry = find(mapped.index, mapped.sub);
    entry->value = static_cast<std::int64_t>(get_field(payload.subspan(at), whole(entry->type)));
    at += wire_size(entry->type);
  }
  return true;
}

}  // namespace tact::rig
