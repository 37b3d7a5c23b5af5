// SPDX-License-Identifier: Apache-2.0
#include "hal/can/can_link.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "hal/can/can_open.h"
#include "hal/can/little_endian.h"

namespace tact::hal::can::can_link_test {

using Bytes = std::vector<std::uint8_t>;

void append(Bytes& out, std::uint64_t value, std::size_t count) {
  out.resize(out.size() + count);
  put_unsigned(std::span(out).last(count), 0, count, value);
}

Bytes attribute(std::uint16_t type, const Bytes& value) {
  Bytes out;
  append(out, value.size() + 4, 2);
  append(out, type, 2);
  out.insert(out.end(), value.begin(), value.end());
  out.resize((out.size() + 3) & ~std::size_t{3});
  return out;
}

Bytes join(std::initializer_list<Bytes> parts) {
  Bytes out;
  for (const Bytes& part : parts) out.insert(out.end(), part.begin(), part.end());
  return out;
}

Bytes word(std::uint32_t value) {
  Bytes out;
  append(out, value, 4);
  return out;
}

Bytes text(const std::string& value) {
  Bytes out(value.begin(), value.end());
  out.push_back(0);
  return out;
}

/// As the kernel writes it: RTM_NEWLINK, hardware type, index, flags, attributes.
Bytes link_message(std::uint16_t hardware, std::uint32_t flags, const Bytes& attributes) {
  Bytes out;
  append(out, 32 + attributes.size(), 4);
  append(out, 16, 2);           // RTM_NEWLINK
  out.resize(out.size() + 12);  // flags, sequence, sender, family
  append(out, hardware, 2);
  append(out, 7, 4);  // index
  append(out, flags, 4);
  append(out, 0, 4);
  out.insert(out.end(), attributes.begin(), attributes.end());
  return out;
}

Bytes can_message(std::uint32_t bitrate, std::uint32_t state, std::uint32_t restart_ms) {
  Bytes timing = word(bitrate);
  timing.resize(32);  // struct can_bittiming
  const Bytes data =
      join({attribute(1, timing), attribute(4, word(state)), attribute(6, word(restart_ms))});
  const Bytes info = join({attribute(1, text("can")), attribute(2, data)});
  return link_message(280, 1, join({attribute(3, text("can0")), attribute(18, info)}));
}

std::string refusal(const CanLink& link, int bits = 690, double rate_Hz = 1000.0) {
  const auto why = check_can_link(link, "can0", bits, rate_Hz);
  return why ? why->error(": ").message : "";
}

TEST(CanLink, ReadsWhatTheKernelReportsOfAController) {
  const auto link = decode_can_link(can_message(1'000'000, 2, 100));
  ASSERT_TRUE(link);
  EXPECT_EQ(link->index, 7);
  EXPECT_TRUE(link->is_can);
  EXPECT_TRUE(link->up);
  EXPECT_FALSE(link->only_local);
  EXPECT_TRUE(link->has_controller);
  EXPECT_EQ(link->bitrate, 1'000'000u);
  EXPECT_EQ(link->state, CanLinkState::kPassive);
  EXPECT_EQ(link->restart_ms, 100u);
}

TEST(CanLink, AVirtualPairHasNoBitRateAndIsNotRefused) {
  // Peers describe themselves in the same place with other meanings.
  const Bytes info = join({attribute(1, text("vxcan")), attribute(2, attribute(4, word(3)))});
  const auto link = decode_can_link(link_message(280, 1, attribute(18, info)));
  ASSERT_TRUE(link);
  EXPECT_FALSE(link->has_controller || link->bitrate || link->state || link->restart_ms);
  EXPECT_EQ(refusal(*link), "");
}

TEST(CanLink, DamagedMessagesAreNoLinkAndNeverReadBeyondTheirEnd) {
  const Bytes whole = can_message(500'000, 0, 0);
  for (std::size_t n = 0; n < whole.size(); ++n) {
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(n));
    EXPECT_FALSE(decode_can_link(cut));
    Bytes lies = cut;  // says that it is whole
    if (n >= 4) put_unsigned(lies, 0, 4, n);
    const auto link = decode_can_link(lies);
    if (link) EXPECT_EQ(link->index, 7);
  }
  Bytes zero_length = link_message(280, 1, Bytes(8, 0));
  EXPECT_TRUE(decode_can_link(zero_length));
}

TEST(CanLink, EveryUnfitInterfaceHasItsMessage) {
  CanLink good{.index = 7,
               .is_can = true,
               .up = true,
               .only_local = false,
               .carries_fd = false,
               .bitrate = 1'000'000,
               .fast_bitrate = {},
               .state = CanLinkState::kActive,
               .restart_ms = 0};
  EXPECT_EQ(refusal(good), "");
  EXPECT_EQ(refusal(good, 810), "");
  CanLink link = good;
  link.is_can = false;
  EXPECT_NE(refusal(link).find("can0 is no CAN interface"), std::string::npos);
  link = good, link.only_local = true;
  EXPECT_NE(refusal(link).find("vxcan"), std::string::npos);
  link = good, link.up = false;
  EXPECT_EQ(refusal(link), "can0 is down: sudo ip link set can0 up type can bitrate 1000000");
  link = good, link.restart_ms = 100;
  EXPECT_NE(refusal(link).find("comes back by itself 100 ms after bus-off"), std::string::npos);
  EXPECT_NE(refusal(link).find("restart-ms 0"), std::string::npos);
  link = good, link.state = CanLinkState::kBusOff;
  EXPECT_NE(refusal(link).find("can0 is bus-off: check bit rate"), std::string::npos);
  link = good, link.state = CanLinkState::kPassive;
  EXPECT_NE(refusal(link).find("can0 is error passive: is it at the drives' bit rate"),
            std::string::npos);
  link = good, link.state = CanLinkState::kStopped;
  EXPECT_NE(refusal(link).find("can0 sleeps"), std::string::npos);
  link = good, link.has_controller = true;
  EXPECT_EQ(refusal(link), "");
  link.bitrate = std::nullopt;
  EXPECT_NE(refusal(link).find("can0 does not report its bit rate"), std::string::npos);
  link = good, link.bitrate = 500'000;
  EXPECT_NE(refusal(link).find("500000 bit/s, too slow for three drives at 1000 Hz"),
            std::string::npos);
  EXPECT_EQ(refusal(link, 690, 500.0), "");
}

TEST(CanLink, ReadsWhetherAnInterfaceCarriesCanFdAndHowFast) {
  Bytes timing = word(1'000'000), fast = word(5'000'000);
  timing.resize(32), fast.resize(32);
  const Bytes data = join({attribute(1, timing), attribute(9, fast)});
  const Bytes info = attribute(18, join({attribute(1, text("can")), attribute(2, data)}));
  const auto link = decode_can_link(link_message(280, 1, join({attribute(4, word(72)), info})));
  ASSERT_TRUE(link);
  EXPECT_TRUE(link->carries_fd);
  EXPECT_EQ(link->fast_bitrate, 5'000'000u);
  const auto classic = decode_can_link(link_message(280, 1, join({attribute(4, word(16)), info})));
  EXPECT_FALSE(classic->carries_fd);
}

TEST(CanLink, ALinkForCanFdIsHeldToMoreThanOneForClassicFrames) {
  const auto refusal_fd = [](const CanLink& link, double rate_Hz = 1000.0) {
    const auto why = check_can_link(link, "can0", {.slow = 273, .fast = 1908}, rate_Hz);
    return why ? why->error(": ").message : std::string();
  };
  const CanLink good{.index = 7,
                     .is_can = true,
                     .up = true,
                     .only_local = false,
                     .carries_fd = true,
                     .bitrate = 1'000'000,
                     .fast_bitrate = 5'000'000,
                     .state = CanLinkState::kActive,
                     .restart_ms = 0};
  EXPECT_EQ(refusal_fd(good), "");
  CanLink link = good;
  link.carries_fd = false;
  EXPECT_NE(refusal_fd(link).find(
                "can0 carries classic CAN alone: sudo ip link set can0 down; sudo ip link set can0 "
                "up type can bitrate 1000000 dbitrate 5000000 sample-point 0.666"),
            std::string::npos)
      << refusal_fd(link);
  link = good, link.up = false;
  EXPECT_NE(refusal_fd(link).find("dbitrate 5000000 sample-point 0.666"), std::string::npos);
  link = good, link.state = CanLinkState::kBusOff;
  EXPECT_NE(refusal_fd(link).find("can0 is bus-off"), std::string::npos);
  link = good, link.fast_bitrate = 2'000'000;
  EXPECT_NE(refusal_fd(link).find("1000000 and 2000000 bit/s, too slow"), std::string::npos);
  EXPECT_NE(refusal_fd(good, 2000.0).find("lower rate_Hz"), std::string::npos);
  link = good, link.has_controller = true, link.fast_bitrate = std::nullopt;
  EXPECT_NE(refusal_fd(link).find("has no fast bit rate"), std::string::npos);
  link = good, link.bitrate = link.fast_bitrate = std::nullopt;  // a virtual one
  EXPECT_EQ(refusal_fd(link), "");
}

TEST(CanLink, ItsRateIsTheReportedOneAndAVirtualOneCountsAsWellSetUp) {
  const CanFdBits bits{.slow = 300, .fast = 1000};
  CanLink link;
  EXPECT_DOUBLE_EQ(bus_time_s(230, link.rate()), 230e-6);
  EXPECT_DOUBLE_EQ(bus_time_s(bits, link.rate()), 500e-6);
  link.bitrate = 500'000;
  EXPECT_DOUBLE_EQ(bus_time_s(230, link.rate()), 460e-6);
  EXPECT_DOUBLE_EQ(bus_time_s(bits, link.rate()), 800e-6);
  link.fast_bitrate = 2'000'000;
  EXPECT_DOUBLE_EQ(bus_time_s(bits, link.rate()), 1100e-6);
}

TEST(CanLink, AnInterfaceThatIsNotThereIsNamedWithTheRemedy) {
  for (const char* name : {"can99", "", "aNameThatIsFarTooLongForAnInterface"}) {
    const auto socket = open_checked_can(name, 690, 1000.0, {});
    ASSERT_FALSE(socket);
    EXPECT_NE(socket.error().message.find("there is no network interface \"" + std::string(name)),
              std::string::npos);
  }
}

TEST(CanLink, TheKernelsOwnAnswerIsUnderstood) {
  const auto link = read_can_link("lo");  // every machine has it, and it is no CAN
  if (!link) GTEST_SKIP() << link.error().message;
  EXPECT_GT(link->index, 0);
  EXPECT_FALSE(link->is_can);
  EXPECT_NE(refusal(*link).find("is no CAN interface"), std::string::npos);
}

}  // namespace tact::hal::can::can_link_test
