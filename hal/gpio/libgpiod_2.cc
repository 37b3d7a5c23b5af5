// SPDX-License-Identifier: Apache-2.0
// libgpiod_2.cc - line_request.h by libgpiod 2: a request is an object with settings of its own.
#include <gpiod.h>

#include "hal/gpio/line_request.h"

namespace tact::hal::gpio {
namespace {

constexpr std::size_t kMaxEdges = 16;  // that the kernel keeps

template <auto Free>
struct FreeBy {
  template <typename T>
  void operator()(T* one) const {
    Free(one);
  }
};
using LineInfo = std::unique_ptr<gpiod_line_info, FreeBy<gpiod_line_info_free>>;
using Settings = std::unique_ptr<gpiod_line_settings, FreeBy<gpiod_line_settings_free>>;
using LineConfig = std::unique_ptr<gpiod_line_config, FreeBy<gpiod_line_config_free>>;
using RequestConfig = std::unique_ptr<gpiod_request_config, FreeBy<gpiod_request_config_free>>;
using EdgeBuffer = std::unique_ptr<gpiod_edge_event_buffer, FreeBy<gpiod_edge_event_buffer_free>>;

}  // namespace

struct LineRequest::Lines {
  gpiod_line_request* request = nullptr;
  std::size_t count = 0;

  ~Lines() { gpiod_line_request_release(request); }
};

struct Chip::Handle {
  gpiod_chip* chip = nullptr;

  ~Handle() { gpiod_chip_close(chip); }
  LineInfo info(int offset) const {
    return LineInfo(gpiod_chip_get_line_info(chip, static_cast<unsigned>(offset)));
  }
};

// libgpiod copies the values to and from one ioctl, and allocates nothing.
#if defined(__clang__) && __clang_major__ >= 20
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wfunction-effects"
#endif
bool LineRequest::get(Levels& levels) RT_SAFE {
  std::array<gpiod_line_value, kMaxRequestLines> values{};
  if (gpiod_line_request_get_values(lines_->request, values.data()) != 0) return false;
  for (std::size_t i = 0; i < lines_->count; ++i)  // bound: kMaxRequestLines
    levels[i] = values[i] == GPIOD_LINE_VALUE_ACTIVE ? 1 : 0;
  return true;
}
bool LineRequest::set(const Levels& levels) RT_SAFE {
  std::array<gpiod_line_value, kMaxRequestLines> values{};
  for (std::size_t i = 0; i < lines_->count; ++i)  // bound: kMaxRequestLines
    values[i] = levels[i] != 0 ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE;
  return gpiod_line_request_set_values(lines_->request, values.data()) == 0;
}
#if defined(__clang__) && __clang_major__ >= 20
#pragma clang diagnostic pop
#endif

std::vector<Edge> LineRequest::edges(std::chrono::milliseconds longest) {
  std::vector<Edge> edges;
  const std::int64_t timeout_ns = std::chrono::nanoseconds(longest).count();
  // A timeout and an error alike: no edges came.
  if (gpiod_line_request_wait_edge_events(lines_->request, timeout_ns) != 1) return edges;
  const EdgeBuffer buffer(gpiod_edge_event_buffer_new(kMaxEdges));
  const int count = gpiod_line_request_read_edge_events(lines_->request, buffer.get(), kMaxEdges);
  for (int i = 0; i < count; ++i) {
    gpiod_edge_event* e =
        gpiod_edge_event_buffer_get_event(buffer.get(), static_cast<unsigned long>(i));
    edges.push_back({.rising = gpiod_edge_event_get_event_type(e) == GPIOD_EDGE_EVENT_RISING_EDGE,
                     .time_ns = static_cast<std::int64_t>(gpiod_edge_event_get_timestamp_ns(e))});
  }
  return edges;
}

Chip::Chip(const std::string& path) {
  gpiod_chip* chip = gpiod_chip_open(path.c_str());
  if (chip != nullptr) handle_.reset(new Handle{.chip = chip});
}

bool Chip::gives(int offset) const { return handle_->info(offset) != nullptr; }

std::optional<std::string> Chip::user_of(int offset) const {
  const LineInfo info = handle_->info(offset);
  if (info == nullptr || !gpiod_line_info_is_used(info.get())) return std::nullopt;
  const char* user = gpiod_line_info_get_consumer(info.get());
  return user == nullptr ? "" : user;
}

LineRequest Chip::request(LineUse use, std::span<const int> offsets, const char* consumer) {
  const Settings settings(gpiod_line_settings_new());
  const LineConfig lines(gpiod_line_config_new());
  const RequestConfig config(gpiod_request_config_new());
  if (settings == nullptr || lines == nullptr || config == nullptr) return {};
  const bool out = use == LineUse::kOutput;
  gpiod_line_settings_set_direction(settings.get(),
                                    out ? GPIOD_LINE_DIRECTION_OUTPUT : GPIOD_LINE_DIRECTION_INPUT);
  if (out) gpiod_line_settings_set_output_value(settings.get(), GPIOD_LINE_VALUE_INACTIVE);
  if (use == LineUse::kEdges)
    gpiod_line_settings_set_edge_detection(settings.get(), GPIOD_LINE_EDGE_BOTH);
  const std::vector<unsigned> numbers(offsets.begin(), offsets.end());
  if (gpiod_line_config_add_line_settings(lines.get(), numbers.data(), numbers.size(),
                                          settings.get()) != 0)
    return {};
  gpiod_request_config_set_consumer(config.get(), consumer);
  gpiod_line_request* request = gpiod_chip_request_lines(handle_->chip, config.get(), lines.get());
  if (request == nullptr) return {};
  return LineRequest(std::shared_ptr<LineRequest::Lines>(
      new LineRequest::Lines{.request = request, .count = offsets.size()}));
}

}  // namespace tact::hal::gpio
