// SPDX-License-Identifier: Apache-2.0
// law_updater.h - changes the law's numbers while the loop runs, at the request of a person.
//
// An ordinary thread makes the tissue with the new numbers and checks it as at the start. The loop
// takes it in one tick in which the tool is out of contact (contact_exchange.h), so that no force
// steps. On hardware only the keys of the scene's [[live]] may change.
#pragma once

#include <condition_variable>
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "firmware/console/control_socket.h"
#include "firmware/loop/contact_exchange.h"
#include "firmware/loop/requests.h"
#include "firmware/run/loop_parts.h"
#include "firmware/telemetry/telemetry.h"
#include "hal/threads/thread.h"
#include "model/scene/variant.h"
#include "model/time_ns.h"

namespace tact::firmware::run {

class LawUpdater {
 public:
  enum class State {
    kIdle,       // no request waits; the loop uses the newest tissue
    kPreparing,  // the thread makes the tissue, the client waits
    kOffered,    // the loop may take the tissue, the client waits
    kDeferred,   // the loop may take the tissue, the client was answered: still in contact
    kReplacing,  // as kPreparing, while the loop may take an older tissue
  };
  enum class Event { kRequested, kFailed, kPrepared, kUsed, kTimedOut };
  /// All transitions. kRequested only where !waits(); kUsed and kTimedOut only after kPrepared.
  static State next(State state, Event event);
  /// Does a client wait for its answer? A further request is refused.
  static bool waits(State state) { return state != State::kIdle && state != State::kDeferred; }

  /// Time between two calls of poll() while a client waits; within a second it has its answer, also
  /// while the tool is in contact.
  static constexpr std::int64_t kPollPeriod_ns = 20 * model::kMillisecond_ns;
  static constexpr int kMaxPolls = model::kSecond_ns / kPollPeriod_ns;

  /// All of these outlive it. The destructor is called after the loop has ended.
  struct Use {
    const model::scene::Scene& scene;
    const hal::Device& device;
    loop::Requests& requests;
    loop::ContactExchange& contacts;
    telemetry::Telemetry& telemetry;
  };
  static model::Result<std::unique_ptr<LawUpdater>> make(const Use& use);
  ~LawUpdater();
  LawUpdater(const LawUpdater&) = delete;
  LawUpdater& operator=(const LawUpdater&) = delete;

  /// Takes "KEY=VALUE KEY=VALUE"; keys that are not named keep their values. If the request is
  /// refused, answers it and returns a report for the operator; otherwise a later poll() answers.
  std::optional<std::string> request(console::ControlRequest request, const std::string& set);
  /// Call regularly: offers the contact that is ready and answers the request. Returns a report for
  /// the operator, or nothing.
  std::optional<std::string> poll();
  State state() const { return state_; }
  /// Tissues that were offered to the loop.
  std::uint32_t count() const { return count_; }

 private:
  explicit LawUpdater(const Use& use) : use_(use) {}
  struct Numbers {
    std::vector<std::string> set;  // each KEY=VALUE
    std::string named;             // those of the request, for people
  };
  struct Prepared {
    explicit Prepared(model::scene::Variant made)
        : variant(std::move(made)),
          contact{0, model::contact::Contact(variant.tissue->contact_scene())} {}
    model::scene::Variant variant;
    loop::OfferedContact contact;
  };
  using Outcome = model::Result<std::unique_ptr<Prepared>>;

  std::optional<std::string> why_not(const std::vector<std::string>& set) const;
  std::string refuse(const console::ControlRequest& request, const std::string& why) const;
  void run();
  Outcome prepare(const std::vector<std::string>& set) const;
  console::ControlRequest take_waiting();
  void offer(std::unique_ptr<Prepared> prepared);
  void forget_old();

  const Use use_;
  State state_ = State::kIdle;
  Numbers requested_, offered_;  // the newest of each
  std::optional<console::ControlRequest> waiting_;
  std::uint32_t count_ = 0;  // tissues offered so far
  int polls_left_ = 0;       // until waiting_ is answered although the tool is in contact
  std::list<std::unique_ptr<Prepared>> kept_;  // offered, and those that telemetry still reads

  std::mutex mutex_;  // guards the rest; the loop never takes it
  std::condition_variable changed_;
  std::optional<std::vector<std::string>> job_;
  std::optional<Outcome> outcome_;
  bool ends_ = false;
  hal::threads::Thread thread_;  // last: it uses the others
};

}  // namespace tact::firmware::run
