// SPDX-License-Identifier: Apache-2.0
// Every request and word of waking a Falcon, in order: requests of the USB adapter by name, words
// of the boot loader.
#include "hal/falcon/falcon_boot.h"

#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "hal/falcon/falcon_packets.h"
#include "hal/falcon/ftdi_requests.h"
#include "tools/verify/can.h"

namespace tact::tools::verify {
namespace falcon_boot_cases {

using hal::falcon::FalconBootAction;
using hal::falcon::FtdiRequest;
using nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

FtdiRequest named(const std::string& name, Report& report) {
  if (name == "purge_rx") return hal::falcon::kFtdiPurgeRx;
  if (name == "purge_tx") return hal::falcon::kFtdiPurgeTx;
  if (name == "latency_1ms") return hal::falcon::ftdi_latency_ms(1);
  if (name == "latency_16ms") return hal::falcon::ftdi_latency_ms(16);
  if (name == "baud_9600") return hal::falcon::ftdi_divisor(hal::falcon::kFtdi9600);
  if (name == "baud_142857") return hal::falcon::ftdi_divisor(hal::falcon::kFtdi142857);
  if (name == "baud_1500000") return hal::falcon::ftdi_divisor(hal::falcon::kFtdi1500000);
  if (name == "data_8n1") return hal::falcon::kFtdi8n1;
  if (name == "flow_none") return hal::falcon::kFtdiFlowNone;
  if (name == "rts_low") return hal::falcon::kFtdiRtsLow;
  if (name == "dtr_low") return hal::falcon::kFtdiDtrLow;
  if (name == "dtr_high") return hal::falcon::kFtdiDtrHigh;
  report.call_damaged("no request is called " + name);
  return {};
}
json to_json(const FtdiRequest& r) {
  return {{"bmRequestType", r.type},
          {"bRequest", r.request},
          {"wValue", r.value},
          {"wIndex", r.index},
          {"wLength", r.length}};
}

/// What is sent, in order, to a device that replies so; a reply to each write, none: silence.
using Reply = std::function<Bytes(const std::string& written)>;
json sent_while_booting(const Bytes& image, const Reply& reply) {
  // One way through: a second one would send everything again.
  hal::falcon::FalconBoot boot(image, {.attempts = 1});
  json sent = json::array();
  Bytes pending;
  std::int64_t now_ms = 0;
  FalconBootAction action = boot.next({.now_ms = now_ms});
  // A boot that never ends must fail the file, not hang the program.
  for (int step = 0; step < 10'000; ++step) {
    hal::falcon::FalconBootInput input;
    Bytes heard;
    switch (action.what) {
      case FalconBootAction::What::kControl:
        sent.push_back(to_json(action.request));
        break;
      case FalconBootAction::What::kWrite:
        sent.push_back(to_hex(action.bytes));
        pending = reply(to_hex(action.bytes));
        break;
      case FalconBootAction::What::kRead:
        heard.swap(pending);
        // Time passes by waiting in vain alone, so that every timeout is met at once.
        if (heard.empty()) now_ms += action.wait_ms;
        input.bytes = heard;
        input.clear_to_send = true;
        break;
      default:
        return sent;
    }
    input.now_ms = now_ms;
    action = boot.next(input);
  }
  return sent;
}

int count(const json& sent, const json& word) {
  return static_cast<int>(std::count(sent.begin(), sent.end(), word));
}

/// One run from open to ready must send what the file says, entry by entry; a run against silence
/// as often as it says.
class BootCheck {
 public:
  BootCheck(const json& ftdi, Report& report) : ftdi_(ftdi), report_(report) {
    for (const json& step : ftdi.at("bootloader"))
      if (step.contains("bulk_out"))
        replies_[step.at("bulk_out")] = from_hex(step.at("expect_in"), report);
    // Two whole chunks and a rest of 26, and no byte twice: what is out of place is reported.
    for (int i = 0; i < 150; ++i) image_.push_back(static_cast<std::uint8_t>(i * 7 + 1));
    sent_ = sent_while_booting(image_, device(false, ""));
  }

  void run() {
    check_requests("open");
    const std::size_t first_normal = at_;
    // Checked at the end, against the second time: the file has the block once.
    at_ += ftdi_.at("normal").size();
    const int asked = hal::falcon::FalconBootSettings{}.report_tries;
    for (int i = 0; i < asked; ++i) report_.equal("ask", next(), ask_);
    report_.each("ftdi/bootloader", ftdi_.at("bootloader"),
                 [this](const json& step) { check_step(step); });
    const std::size_t second_normal = at_;
    check_requests("normal");
    report_.equal("ask", next(), ask_);
    report_.equal("end", at_, sent_.size());
    for (std::size_t i = 0; i < second_normal && second_normal + i < at_ - 1; ++i)
      report_.equal("before the image", sent_.at(first_normal + i), sent_.at(second_normal + i));
  }

 private:
  /// It may begin each reply with a zero, and be silent to one word.
  Reply device(bool null_first, const std::string& silent) const {
    return [this, null_first, silent, last = std::string()](const std::string& written) mutable {
      const std::string before = std::exchange(last, written);
      if (written == silent) return Bytes{};
      // It runs, and reports, only when the rest of the image has come.
      if (written == ask_)
        return from_hex(before == to_hex(std::span(image_).last(26)) ? report_hex_ : "", report_);
      const auto known = replies_.find(written);
      if (known == replies_.end()) return from_hex(written, report_);  // the echo of the image
      Bytes out = known->second;
      // An extra zero may come after a change of the baud rate.
      if (null_first) out.insert(out.begin(), 0);
      return out;
    };
  }

  json next() { return at_ < sent_.size() ? sent_.at(at_++) : json("nothing"); }

  void check_request(json want) {
    const json got = next();
    // The name and the numbers, each by itself: the file must not contradict itself either.
    report_.equal("name", to_json(named(want.at("name"), report_)), got);
    want.erase("name");
    report_.equal("request", got, want);
  }

  void check_requests(const std::string& block) {
    report_.each("ftdi/" + block, ftdi_.at(block), [this](const json& one) { check_request(one); });
  }

  void check_step(const json& want) {
    if (want.contains("name")) return check_request(want);
    if (want.contains("bulk_out")) return check_word(want);
    report_.equal("upload", want.at("upload"), true);
    report_.equal("echo", want.at("echo"), true);
    const auto chunk = want.at("chunk").get<std::size_t>();
    for (std::size_t done = 0; done < image_.size(); done += chunk) {
      const auto rest = std::span(image_).subspan(done);
      report_.equal("chunk", next(), to_hex(rest.first(std::min(chunk, rest.size()))));
    }
  }

  void check_word(const json& want) {
    const std::string word = want.at("bulk_out");
    report_.equal("bulk_out", next(), word);
    report_.equal("retry", count(sent_while_booting(image_, device(false, word)), word),
                  want.at("retry"));
    report_.equal("null first", sent_while_booting(image_, device(true, "")), sent_);
  }

  const json& ftdi_;
  Report& report_;
  const std::string ask_ =
      to_hex(encode(hal::falcon::FalconCommand{.lights = hal::falcon::kFalconRed, .homing = true}));
  const std::string report_hex_ = to_hex(encode(hal::falcon::FalconReport{}));
  std::map<std::string, Bytes> replies_;
  Bytes image_;
  json sent_;
  std::size_t at_ = 0;  // in sent_
};

}  // namespace falcon_boot_cases

void verify_falcon_boot(const nlohmann::json& ftdi, Report& report) {
  falcon_boot_cases::BootCheck(ftdi, report).run();
}

}  // namespace tact::tools::verify
