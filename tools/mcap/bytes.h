// SPDX-License-Identifier: Apache-2.0
// bytes.h - little-endian bytes, one after the other, as MCAP and CDR have them.
//
// MCAP packs; CDR aligns each number to its size, counted from behind its 4 bytes of encapsulation
// (OMG DDSI-RTPS 2.5, 10.2: 00 01 is plain CDR, little-endian).
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>

namespace tact::tools::mcap {

class Bytes {
 public:
  template <std::unsigned_integral Unsigned>
  Bytes& put(Unsigned value) {
    for (unsigned at = 0; at < sizeof value; ++at)
      bytes_ += static_cast<char>((value >> (8 * at)) & 0xffu);
    return *this;
  }
  /// Its length as u32 first.
  Bytes& text(std::string_view value) {
    put(static_cast<std::uint32_t>(value.size()));
    return raw(value);
  }
  Bytes& raw(std::string_view value) {
    bytes_ += value;
    return *this;
  }
  const std::string& str() const { return bytes_; }
  std::size_t size() const { return bytes_.size(); }
  void clear() { bytes_.clear(); }

 private:
  std::string bytes_;
};

class Cdr {
 public:
  template <std::unsigned_integral Unsigned>
  Cdr& put(Unsigned value) {
    while ((bytes_.size() - kHead) % sizeof value != 0) bytes_.put(std::uint8_t{0});
    bytes_.put(value);
    return *this;
  }
  Cdr& real(double value) { return put(std::bit_cast<std::uint64_t>(value)); }
  /// With the zero byte at its end, which the length counts.
  Cdr& text(std::string_view value) {
    put(static_cast<std::uint32_t>(value.size() + 1));
    bytes_.raw(value).put(std::uint8_t{0});
    return *this;
  }
  const std::string& str() const { return bytes_.str(); }

 private:
  static constexpr std::size_t kHead = 4;
  Bytes bytes_ = Bytes().put(std::uint32_t{0x0100});
};

}  // namespace tact::tools::mcap
