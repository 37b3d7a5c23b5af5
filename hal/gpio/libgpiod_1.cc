// SPDX-License-Identifier: Apache-2.0
// libgpiod_1.cc - line_request.h by libgpiod 1.6: a line belongs to its chip, a bulk moves some.
#include <gpiod.h>

#include "hal/gpio/line_request.h"
#include "model/time_ns.h"

namespace tact::hal::gpio {
namespace {

constexpr unsigned kMaxEdges = 16;  // that the kernel keeps

}  // namespace

struct LineRequest::Lines {
  gpiod_line_bulk bulk{};

  ~Lines() { gpiod_line_release_bulk(&bulk); }
};

struct Chip::Handle {
  gpiod_chip* chip = nullptr;

  ~Handle() { gpiod_chip_close(chip); }
  gpiod_line* line(int offset) const {
    return gpiod_chip_get_line(chip, static_cast<unsigned>(offset));
  }
};

// libgpiod copies the values to and from one ioctl, and allocates nothing.
#if defined(__clang__) && __clang_major__ >= 20
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wfunction-effects"
#endif
bool LineRequest::get(Levels& levels) RT_SAFE {
  return gpiod_line_get_value_bulk(&lines_->bulk, levels.data()) == 0;
}
bool LineRequest::set(const Levels& levels) RT_SAFE {
  return gpiod_line_set_value_bulk(&lines_->bulk, levels.data()) == 0;
}
#if defined(__clang__) && __clang_major__ >= 20
#pragma clang diagnostic pop
#endif

std::vector<Edge> LineRequest::edges(std::chrono::milliseconds longest) {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(longest);
  const timespec timeout{.tv_sec = seconds.count(),
                         .tv_nsec = std::chrono::nanoseconds(longest - seconds).count()};
  std::vector<Edge> edges;
  gpiod_line* line = gpiod_line_bulk_get_line(&lines_->bulk, 0);
  // A timeout and an error alike: no edges came.
  if (gpiod_line_event_wait(line, &timeout) != 1) return edges;
  std::array<gpiod_line_event, kMaxEdges> events{};
  const int count = gpiod_line_event_read_multiple(line, events.data(), kMaxEdges);
  for (int i = 0; i < count; ++i) {
    const gpiod_line_event& e = events.at(static_cast<std::size_t>(i));
    edges.push_back({.rising = e.event_type == GPIOD_LINE_EVENT_RISING_EDGE,
                     .time_ns = e.ts.tv_sec * model::kSecond_ns + e.ts.tv_nsec});
  }
  return edges;
}

Chip::Chip(const std::string& path) {
  gpiod_chip* chip = gpiod_chip_open(path.c_str());
  if (chip != nullptr) handle_.reset(new Handle{.chip = chip});
}

bool Chip::gives(int offset) const { return handle_->line(offset) != nullptr; }

std::optional<std::string> Chip::user_of(int offset) const {
  gpiod_line* line = handle_->line(offset);
  if (line == nullptr || !gpiod_line_is_used(line)) return std::nullopt;
  const char* user = gpiod_line_consumer(line);
  return user == nullptr ? "" : user;
}

LineRequest Chip::request(LineUse use, std::span<const int> offsets, const char* consumer) {
  gpiod_line_bulk bulk = GPIOD_LINE_BULK_INITIALIZER;
  for (const int offset : offsets) {
    gpiod_line* line = handle_->line(offset);
    if (line == nullptr) return {};
    gpiod_line_bulk_add(&bulk, line);
  }
  const Levels low{};
  int refused = -1;
  if (use == LineUse::kInput)
    refused = gpiod_line_request_bulk_input(&bulk, consumer);
  else if (use == LineUse::kOutput)
    refused = gpiod_line_request_bulk_output(&bulk, consumer, low.data());
  else
    refused = gpiod_line_request_bulk_both_edges_events(&bulk, consumer);
  if (refused != 0) return {};
  return LineRequest(std::shared_ptr<LineRequest::Lines>(new LineRequest::Lines{.bulk = bulk}));
}

}  // namespace tact::hal::gpio
