// SPDX-License-Identifier: Apache-2.0
#include "hal/gpio/edge_watch.h"

#include <fmt/format.h>
#include <gpiod.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "hal/gpio/gpio_lines.h"

namespace tact::hal::gpio {
namespace {

using model::Error;
using model::Result;

constexpr unsigned kMaxEdges = 16;  // that the kernel keeps

struct CloseChip {
  void operator()(gpiod_chip* chip) const { gpiod_chip_close(chip); }  // releases its line, too
};
using ChipHandle = std::unique_ptr<gpiod_chip, CloseChip>;

class GpioEdges final : public EdgeWatch {
 public:
  GpioEdges(ChipHandle chip, gpiod_line* line) : chip_(std::move(chip)), line_(line) {}

  std::vector<Edge> read(std::chrono::milliseconds longest) override {
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(longest);
    const timespec timeout{.tv_sec = seconds.count(),
                           .tv_nsec = std::chrono::nanoseconds(longest - seconds).count()};
    std::vector<Edge> edges;
    if (gpiod_line_event_wait(line_, &timeout) != 1) return edges;
    std::array<gpiod_line_event, kMaxEdges> events{};
    const int count = gpiod_line_event_read_multiple(line_, events.data(), kMaxEdges);
    for (int i = 0; i < count; ++i) {
      const gpiod_line_event& e = events.at(static_cast<std::size_t>(i));
      edges.push_back({.rising = e.event_type == GPIOD_LINE_EVENT_RISING_EDGE,
                       .time_ns = e.ts.tv_sec * 1'000'000'000 + e.ts.tv_nsec});
    }
    return edges;
  }

 private:
  ChipHandle chip_;
  gpiod_line* line_;
};

}  // namespace

Result<std::unique_ptr<EdgeWatch>> open_edge_watch(const std::string& wanted, int line,
                                                   const SystemRoots& roots) {
  const auto chip = choose_chip(find_gpio_chips(roots), wanted);
  if (!chip) return chip.error();
  if (line < 0 || line >= chip->lines)
    return Error{fmt::format("line {} is none of {} \"{}\", which has lines 0 to {}", line,
                             chip->name, chip->label, chip->lines - 1)};
  ChipHandle handle(gpiod_chip_open(chip->path.c_str()));
  gpiod_line* found =
      handle == nullptr ? nullptr : gpiod_chip_get_line(handle.get(), static_cast<unsigned>(line));
  if (found == nullptr || gpiod_line_request_both_edges_events(found, "tact-jitter") != 0)
    return Error{fmt::format("line {} of {} cannot be watched: {}; gpioinfo {} shows who uses it",
                             line, chip->name, std::strerror(errno), chip->name)};
  return std::unique_ptr<EdgeWatch>(new GpioEdges(std::move(handle), found));
}

}  // namespace tact::hal::gpio
