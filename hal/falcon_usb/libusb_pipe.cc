// SPDX-License-Identifier: Apache-2.0
#include "hal/falcon_usb/libusb_pipe.h"

#include <fmt/core.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>

#include "hal/monotonic.h"

namespace tact::hal::falcon_usb {
namespace {

constexpr int kPollWait_ms = 100;  // as LoopSilence: on a mute bus its end looks after the loop
constexpr int kDrainTurns = 400;   // of FalconTurns::kPause_ns: 0.2 s

int error_of(libusb_transfer_status status) {
  switch (status) {
    case LIBUSB_TRANSFER_COMPLETED:
      return 0;
    case LIBUSB_TRANSFER_CANCELLED:
      return ECANCELED;
    case LIBUSB_TRANSFER_NO_DEVICE:
      return ENODEV;
    case LIBUSB_TRANSFER_STALL:
      return EPIPE;
    case LIBUSB_TRANSFER_OVERFLOW:
      return EOVERFLOW;
    default:
      return EPROTO;
  }
}

// The call the kernel must answer: the compiler cannot see that it is bounded.
#if defined(__clang__) && __clang_major__ >= 20
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wfunction-effects"
#endif
bool wake(int fd) RT_SAFE {
  const std::uint64_t one = 1;
  return ::write(fd, &one, sizeof one) == sizeof one;
}
#if defined(__clang__) && __clang_major__ >= 20
#pragma clang diagnostic pop
#endif

}  // namespace

model::Result<std::unique_ptr<falcon::FalconPipe>> LibusbPipe::start(
    std::unique_ptr<FalconUsb> usb) {
  std::unique_ptr<LibusbPipe> pipe(new LibusbPipe(std::move(usb)));
  if (auto error = pipe->prepare()) return std::move(*error);
  return std::unique_ptr<falcon::FalconPipe>(std::move(pipe));
}

std::optional<model::Error> LibusbPipe::prepare() {
  const auto refuse = [](const char* why) {
    return model::Error{fmt::format(
        "the Falcon's USB transfers cannot be started ({}): unplug it and plug it in again", why)};
  };
  wake_fd_ = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  if (wake_fd_ < 0) return refuse(std::strerror(errno));
  for (std::size_t i = 0; i < transfers_.size(); ++i) {
    transfers_[i] = std::make_unique<Transfer>();
    Transfer& t = *transfers_[i];
    t.pipe = this;
    t.is_in = i < kIn;
    // All memory before the loop; what libusb allocates at each submit stays in the thread (UB-1).
    t.transfer = libusb_alloc_transfer(0);
    if (t.transfer == nullptr) return refuse("no memory");
    // No timeout (the last 0): an IN transfer waits as long as the device is silent.
    libusb_fill_bulk_transfer(
        t.transfer, usb_->handle(),
        t.is_in ? falcon::kFalconEndpointIn : falcon::kFalconEndpointOut, t.buffer.data(),
        static_cast<int>(t.is_in ? kFalconTransfer : falcon::kFalconPacketSize), on_completed, &t,
        0);
    if (t.is_in) submit_transfer(t);
  }
  if (!receiver_.open()) return refuse("the device takes none");
  fds_.push_back({.fd = wake_fd_, .events = POLLIN, .revents = 0});
  const libusb_pollfd** list = libusb_get_pollfds(usb_->context());
  if (list == nullptr) return refuse("libusb has no descriptors to wait for");
  for (const libusb_pollfd** fd = list; *fd != nullptr; ++fd)
    fds_.push_back({.fd = (*fd)->fd, .events = (*fd)->events, .revents = 0});
  libusb_free_pollfds(list);
  const int error = thread_.start([](void* self) { static_cast<LibusbPipe*>(self)->run(); }, this);
  if (error != 0) return refuse(std::strerror(error));
  return std::nullopt;
}

LibusbPipe::~LibusbPipe() {
  stop(encode(falcon::FalconCommand{.lights = falcon::kFalconRed}));
  if (wake_fd_ >= 0) close(wake_fd_);
}

bool LibusbPipe::submit(const falcon::FalconPacket& command) RT_SAFE {
  if (receiver_.gone()) return false;
  // The slot first, then the wake: a thread that wakes finds the command.
  commands_.write({.packet = command, .number = ++submitted_});
  return wake(wake_fd_);
}

void LibusbPipe::finish(int error) RT_SAFE {
  receiver_.finish(error == ENODEV  ? falcon::FalconPipeEnd::kUnplugged
                   : error == EPIPE ? falcon::FalconPipeEnd::kStalled
                                    : falcon::FalconPipeEnd::kBroken,
                   error);
}

void LIBUSB_CALL LibusbPipe::on_completed(libusb_transfer* transfer) {
  auto& t = *static_cast<Transfer*>(transfer->user_data);
  t.pipe->completed(t);
}

void LibusbPipe::completed(Transfer& t) {
  t.busy = false;
  const int error = error_of(t.transfer->status);
  const int size = std::clamp(t.transfer->actual_length, 0, t.transfer->length);
  // At once; other errors may be noise, and end the pipe only by number (FalconTurns).
  if (error == ENODEV || error == EPIPE) finish(error);
  if (error == 0) {
    if (t.is_in) receiver_.take({t.buffer.data(), static_cast<std::size_t>(size)}, monotonic_ns());
    if (!t.is_in) sent_.store(t.number, std::memory_order_relaxed);
    if (!t.is_in || size >= static_cast<int>(falcon::kFtdiStatusSize)) ++results_;
  } else {
    last_error_ = error;
    if (!t.is_in && error == EPIPE) out_halted_ = true;
  }
  if (!t.is_in) over_.store(t.number, std::memory_order_release);  // with sent_
  if (t.is_in && error != ECANCELED && !stopping_.load(std::memory_order_acquire))
    submit_transfer(t);
}

void LibusbPipe::submit_transfer(Transfer& t) {
  if (receiver_.gone() || (t.is_in && !receiver_.open())) return;
  const int error = libusb_submit_transfer(t.transfer);
  t.busy = error == 0;
  if (error == LIBUSB_ERROR_NO_DEVICE) finish(ENODEV);
  // A refused IN would never come back, and four of them are all that hear the device.
  if (error != 0 && t.is_in) finish(EIO);
  if (error != 0 && !t.is_in) over_.store(t.number, std::memory_order_release);
}

/// Also what waits behind a refused command may be a force, and goes.
void LibusbPipe::clear_command_halt() {
  for (const auto& t : transfers_)
    if (!t->is_in && t->busy) libusb_cancel_transfer(t->transfer);
  out_halted_ = false;  // refused: the next command stalls again
  static_cast<void>(libusb_clear_halt(usb_->handle(), falcon::kFalconEndpointOut));
}

/// The newest command, on a transfer that is free; else it waits for one.
void LibusbPipe::submit_command() {
  if (commands_.read(waiting_)) {
    ++results_;
    heard_ = waiting_.number;
  }
  if (waiting_.number == 0) return;
  for (const auto& t : transfers_) {
    if (t->is_in || t->busy) continue;
    std::copy(waiting_.packet.begin(), waiting_.packet.end(), t->buffer.begin());
    t->number = waiting_.number;
    submit_transfer(*t);
    waiting_.number = 0;
    return;
  }
}

/// Under the number of the loop's last command: that is over, or this one replaces it.
void LibusbPipe::stand_in_for_loop(std::int64_t now_ns) {
  if (!silence_.is_due(heard_, now_ns)) return;
  receiver_.stand_in();
  waiting_ = {.packet = LoopSilence::zero(), .number = heard_};
}

/// Leaves for good as soon as the device is gone: waiting would then return at once, without end.
void LibusbPipe::run() {
  // A thread's first allocation makes its arena, which takes 0.3 ms: now, not beside the loop.
  libusb_free_transfer(libusb_alloc_transfer(0));
  FalconTurns turns;
  while (!receiver_.gone() && !stopping_.load(std::memory_order_acquire)) {
    results_ = 0;
    const int ready = poll(fds_.data(), fds_.size(), kPollWait_ms);
    if (ready == 0) {
      stand_in_for_loop(monotonic_ns());
      submit_command();
      continue;
    }
    turn();
    const FalconTurns::Next next = turns.turn(results_ > 0);
    if (next == FalconTurns::Next::kEnd) finish(last_error_);
    if (next != FalconTurns::Next::kGoOn) usb_pause_ns(FalconTurns::kPause_ns);
  }
}

void LibusbPipe::turn() {
  if ((fds_[0].revents & POLLIN) != 0) {
    std::uint64_t woken = 0;
    static_cast<void>(::read(wake_fd_, &woken, sizeof woken));
  }
  const bool gone = std::any_of(fds_.begin() + 1, fds_.end(), [](const pollfd& fd) {
    return (fd.revents & (POLLERR | POLLHUP | POLLNVAL)) != 0;
  });
  const bool ready =
      std::any_of(fds_.begin() + 1, fds_.end(), [](const pollfd& fd) { return fd.revents != 0; });
  timeval now{};
  // Also when it is gone: the transfers that it still hands back carry the reason.
  if (ready) libusb_handle_events_timeout_completed(usb_->context(), &now, nullptr);
  if (gone) return finish(ENODEV);  // nothing comes after a hang-up
  if (out_halted_) clear_command_halt();
  stand_in_for_loop(monotonic_ns());  // a reply may be older than the command
  submit_command();
}

bool LibusbPipe::any_busy() const {
  return std::any_of(transfers_.begin(), transfers_.end(),
                     [](const auto& t) { return t != nullptr && t->busy; });
}

bool LibusbPipe::drain() {
  for (const auto& t : transfers_)
    if (t != nullptr && t->busy) libusb_cancel_transfer(t->transfer);
  for (int i = 0; i < kDrainTurns && any_busy(); ++i) {
    timeval now{};
    libusb_handle_events_timeout_completed(usb_->context(), &now, nullptr);
    if (any_busy()) usb_pause_ns(FalconTurns::kPause_ns);
  }
  return !any_busy();
}

/// Has the device taken it?
bool LibusbPipe::send_last(const falcon::FalconPacket& last) {
  const std::int64_t until_ns = monotonic_ns() + falcon::kFalconLastCommand_ns;
  const auto may_wait = [&] {
    return !receiver_.gone() && !thread_.ended() && monotonic_ns() < until_ns;
  };
  while (may_wait()) {
    if (!submit(last)) return false;
    // Acquire with the release of over_: then sent_ of that command is known, too.
    while (over_.load(std::memory_order_acquire) < submitted_ && may_wait())
      usb_pause_ns(FalconTurns::kPause_ns / 2);
    if (sent_.load(std::memory_order_relaxed) == submitted_) return true;
  }
  return false;
}

void LibusbPipe::stop(const falcon::FalconPacket& last) {
  if (stopping_.load(std::memory_order_acquire)) return;
  if (thread_.started()) static_cast<void>(send_last(last));
  // After the last command: a thread that stops sends nothing more.
  stopping_.store(true, std::memory_order_release);
  if (wake_fd_ >= 0) wake(wake_fd_);
  thread_.join();
  release();
}

/// A transfer that the library keeps must outlive it: then nothing of the library is freed.
void LibusbPipe::release() {
  const bool all_back = drain();
  const bool stalled =
      receiver_.health().end == falcon::FalconPipeEnd::kStalled && !receiver_.gone();
  if (stalled && usb_)  // for whoever opens it next
    static_cast<void>(libusb_clear_halt(usb_->handle(), falcon::kFalconEndpointIn));
  for (std::unique_ptr<Transfer>& t : transfers_) {
    if (!all_back) static_cast<void>(t.release());
    if (t) libusb_free_transfer(t->transfer);
    t.reset();
  }
  if (!all_back) static_cast<void>(usb_.release());
  usb_.reset();
}

}  // namespace tact::hal::falcon_usb
