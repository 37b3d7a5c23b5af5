// SPDX-License-Identifier: Apache-2.0
// variants.h - changes the law's numbers while the loop runs, at the request of a person.
//
// An ordinary thread makes the tissue with the new numbers and checks it as at the start. The loop
// takes it in one tick in which the tool is out of contact (contact_exchange.h), so that no force
// steps. On hardware only the keys of the scene's [[live]] may change.
#pragma once

#include <atomic>
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

namespace tact::firmware::run {

class Variants {
 public:
  /// All of these outlive it. The destructor is called after the loop has ended.
  static model::Result<std::unique_ptr<Variants>> make(const model::scene::Scene& scene,
                                                       const LoopParts& parts,
                                                       loop::Requests& requests,
                                                       loop::ContactExchange& contacts,
                                                       telemetry::Telemetry& telemetry);
  ~Variants();
  Variants(const Variants&) = delete;
  Variants& operator=(const Variants&) = delete;

  /// Takes "KEY=VALUE KEY=VALUE"; keys that are not named keep their values. Answers and returns a
  /// report for the operator if it is refused at once; otherwise a later poll() answers.
  std::optional<std::string> ask(console::ControlRequest request, const std::string& set);
  /// Call regularly: offers the contact that is ready and answers the request. Returns a report for
  /// the operator, or nothing.
  std::optional<std::string> poll();
  /// Tissues that were offered to the loop.
  std::uint32_t count() const { return count_; }

 private:
  Variants(const model::scene::Scene& scene, const LoopParts& parts, loop::Requests& requests,
           loop::ContactExchange& contacts, telemetry::Telemetry& telemetry)
      : scene_(scene),
        parts_(parts),
        requests_(requests),
        contacts_(contacts),
        telemetry_(telemetry) {}
  struct Made {
    explicit Made(model::scene::Variant made)
        : variant(std::move(made)),
          contact{0, model::contact::Contact(variant.tissue->contact_scene())} {}
    model::scene::Variant variant;
    loop::OfferedContact contact;
  };
  using Outcome = model::Result<std::unique_ptr<Made>>;

  std::optional<std::string> why_not(const std::vector<std::string>& set) const;
  std::string refuse(const console::ControlRequest& request, const std::string& why) const;
  void run();
  Outcome make(const std::vector<std::string>& set) const;
  console::ControlRequest take_waiting();
  void offer(std::unique_ptr<Made> made);
  void forget_old();

  const model::scene::Scene& scene_;
  const LoopParts& parts_;
  loop::Requests& requests_;
  loop::ContactExchange& contacts_;
  telemetry::Telemetry& telemetry_;
  std::vector<std::string> set_;    // of the newest tissue, each KEY=VALUE
  std::vector<std::string> asked_;  // in work
  std::string what_, asked_what_;   // of these only what was named, for people
  std::optional<console::ControlRequest> waiting_;
  std::uint32_t count_ = 0;  // tissues offered so far
  bool is_in_work_ = false;  // the numbers that waiting_ asked for
  bool is_offered_ = false;  // numbers that are not reported as used yet
  int turns_left_ = 0;       // polls until waiting_ is answered although the tool touches
  std::list<std::unique_ptr<Made>> kept_;  // offered, and those that telemetry still reads

  std::mutex mutex_;  // guards the rest; the loop never takes it
  std::condition_variable changed_;
  std::optional<std::vector<std::string>> job_;
  std::optional<Outcome> outcome_;
  bool ends_ = false;
  hal::threads::Thread thread_;  // last: it uses the others
};

}  // namespace tact::firmware::run
