// SPDX-License-Identifier: Apache-2.0
#include "firmware/black_box/black_box.h"

#include <fmt/format.h>

#include <exception>
#include <utility>

namespace tact::firmware::black_box {

BlackBox::BlackBox(BlackBoxRun run, double rate_Hz, double frame_rate_Hz)
    : run_(std::move(run)),
      ticks_(static_cast<std::size_t>(kKeep_s * rate_Hz)),
      frames_(static_cast<std::size_t>(kKeep_s * frame_rate_Hz)),
      ticks_after_(static_cast<std::uint64_t>(kAfter_s * rate_Hz)),
      spare_(kSpare_bytes, 1) {
  // Touched, too: what a fault needs is there before the loop.
  ticks_.reserve(kept_.ticks);
  frames_.reserve(kept_.frames);
  news_.reserve(kMaxNews);
}

model::Result<std::unique_ptr<BlackBox>> BlackBox::make(BlackBoxRun run, double rate_Hz,
                                                        double frame_rate_Hz) {
  std::unique_ptr<BlackBox> box(new BlackBox(std::move(run), rate_Hz, frame_rate_Hz));
  auto thread = hal::threads::start_thread("tact-box", [&box = *box] { box.keep_writing(); });
  if (!thread) return thread.error();
  box->writer_ = std::move(*thread);
  return box;
}

BlackBox::~BlackBox() {
  if (!writer_.joinable()) return;
  finish();
  ending_ = true;
  due_.release();
}

void BlackBox::add(const protocol::LoggedTick& tick) {
  ticks_.add(tick);
  if (to_wait_ > 0) --to_wait_;
  const model::Fault fault = tick.output.fault;
  // A fault during the 0.25 s of an earlier one goes into the same file, with its ticks.
  if (fault != before_ && fault != model::Fault::kNone && waiting_ == model::Fault::kNone) {
    waiting_ = fault;
    to_wait_ = ticks_after_;
  }
  before_ = fault;
}

void BlackBox::report_fault(model::Fault fault) {
  if (fault == model::Fault::kNone || before_ != model::Fault::kNone) return;
  // The loop no longer ticks, so the file does not wait. before_: each fault is recorded once.
  before_ = waiting_ = fault;
  to_wait_ = 0;
}

void BlackBox::work() {
  // While a file is being written, the next one stays pending and this thread continues.
  if (waiting_ == model::Fault::kNone || to_wait_ > 0 || !idle_.try_acquire()) return;
  // Copied in this thread, because the buffers keep changing; formatted and written in the other.
  kept_.fault = std::exchange(waiting_, model::Fault::kNone);
  kept_.variants = variants_;
  ticks_.copy_to(kept_.ticks);
  frames_.copy_to(kept_.frames);
  due_.release();
}

void BlackBox::finish() {
  to_wait_ = 0;
  // The file in work, then the pending one.
  idle_.acquire();
  idle_.release();
  work();
  idle_.acquire();
  idle_.release();
}

void BlackBox::keep_writing() {
  for (;;) {
    due_.acquire();
    if (ending_) return;
    write();
    idle_.release();
  }
}

void BlackBox::write() {
  std::string lost = "black box: no memory is left to write it";  // made while there is some
  std::vector<char>().swap(spare_);                               // for what writing needs
  try {
    // The disk first, without the lock: news() and files() must not wait for it.
    const auto path = write_black_box(run_, kept_);
    std::string news = path ? fmt::format("black box of fault {}: {}; tact-view --open shows it",
                                          static_cast<int>(kept_.fault), *path)
                            : "black box: " + path.error().message;
    if (const std::size_t old = remove_oldest(run_.folder))
      news += fmt::format("; the folder keeps {} MB: {} older ones were removed",
                          kMaxFolder_bytes >> 20, old);
    const std::lock_guard lock(reported_mutex_);
    if (path) files_.push_back(*path);
    report(std::move(news));
    lost.clear();
    spare_.assign(kSpare_bytes, 1);
  } catch (const std::exception&) {  // the only kind left is std::bad_alloc
    const std::lock_guard lock(reported_mutex_);
    if (!lost.empty()) report(std::move(lost));
  }
}

void BlackBox::report(std::string news) {
  if (news_.size() < kMaxNews) news_.push_back(std::move(news));
}

std::vector<std::string> BlackBox::news() {
  const std::lock_guard lock(reported_mutex_);
  std::vector<std::string> out;
  out.reserve(kMaxNews);
  news_.swap(out);
  return out;
}

std::vector<std::string> BlackBox::files() const {
  const std::lock_guard lock(reported_mutex_);
  return files_;
}

}  // namespace tact::firmware::black_box
