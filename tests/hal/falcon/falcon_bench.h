// SPDX-License-Identifier: Apache-2.0
// falcon_bench.h - a FalconDevice on a pipe that a test writes the script of, tick by tick.
//
// The other end answers each command with `report`, as long as `answers` is set.
#pragma once

#include <memory>
#include <vector>

#include "hal/falcon/falcon_device.h"
#include "hal/falcon/falcon_kinematics.h"

namespace tact::tests {

using namespace hal;

/// Never allocates: it runs inside the loop.
class ScriptedPipe final : public falcon::FalconPipe {
 public:
  bool submit(const falcon::FalconPacket& packet) RT_SAFE override {
    if (full || state.end == falcon::FalconPipeEnd::kUnplugged) return false;
    if (gone_at_submit) {
      state = {.end = falcon::FalconPipeEnd::kUnplugged, .error = 19};
      return false;
    }
    command = *falcon::decode_falcon_command(packet);
    ++commands;
    return true;
  }
  bool newest(falcon::FalconReply& out) RT_SAFE override {
    if (!has_reply) return false;
    has_reply = false;
    out = reply;
    return true;
  }
  falcon::FalconPipeHealth health() const RT_SAFE override { return state; }
  int descriptor() const override { return fd; }
  void stop(const falcon::FalconPacket& packet) override {
    last = *falcon::decode_falcon_command(packet), ++stops;
  }

  void answer(const falcon::FalconReport& report, std::int64_t stamp_ns, std::uint64_t times = 1) {
    reply = {.report = report, .stamp_ns = stamp_ns, .sequence = reply.sequence + times};
    has_reply = true;
  }

  bool full = false, gone_at_submit = false, has_reply = false;
  falcon::FalconPipeHealth state;
  falcon::FalconCommand command, last;
  falcon::FalconReply reply;
  int commands = 0, stops = 0, fd = -1;
};

inline hal::falcon::FalconSettings falcon_settings() {
  hal::falcon::FalconSettings settings;
  settings.gain_words_per_Nm = {8000.0, 9000.0, 10000.0};
  return settings;
}

inline falcon::FalconReport homed_at(const Vec3& p_W) {
  const falcon::FalconInverse legs =
      falcon::FalconKinematics().inverse(falcon::falcon_point_D(p_W));
  falcon::FalconReport report{.homed = falcon::kFalconAllHomed};
  for (std::size_t i = 0; i < 3; ++i)
    report.counts[i] = static_cast<int>(std::lround(falcon::falcon_counts(legs.thigh_rad[i])));
  return report;
}

/// The force on the hand of these words: K^T tau, tau = -(word / gain).
inline Vec3 force_of(const falcon::FalconWords& words, const hal::falcon::FalconSettings& s,
                     const Vec3& p_W) {
  const falcon::FalconKinematics kinematics;
  const model::Mat3 k =
      kinematics.joint_rate_matrix(kinematics.inverse(falcon::falcon_point_D(p_W)));
  const Vec3 torque_Nm{-words[0] / s.gain_words_per_Nm[0], -words[1] / s.gain_words_per_Nm[1],
                       -words[2] / s.gain_words_per_Nm[2]};
  const Vec3 force_D = model::transpose(k) * torque_Nm;
  return {force_D.z, force_D.x, force_D.y};
}

struct FalconBench {
  explicit FalconBench(const hal::falcon::FalconSettings& settings = falcon_settings())
      : owned(std::make_unique<ScriptedPipe>()),
        pipe(owned.get()),
        device(settings, std::move(owned)) {}

  Fault read() {
    now_ns += 1'000'000;
    if (answers && pipe->commands > answered) pipe->answer(report, now_ns - 300'000);
    answered = pipe->commands;
    return fault = device.read(sample, now_ns);
  }
  Fault write(const Vec3& force_N = {}) {
    return device.write({.force_N = force_N, .torque_Nm = {}});
  }
  /// One period of the loop; was the sample fresh?
  bool tick(const Vec3& force_N = {}) {
    read();
    write(force_N);
    return sample.fresh;
  }
  void run(int ticks, const Vec3& force_N = {}) {
    for (int i = 0; i < ticks; ++i) tick(force_N);
  }
  /// Homed and fresh at this place, no force yet.
  void home(const Vec3& p_W = {}) {
    report = homed_at(p_W);
    run(3);
  }
  const falcon::FalconWords& words() const { return pipe->command.motor; }

  std::unique_ptr<ScriptedPipe> owned;
  ScriptedPipe* pipe;
  falcon::FalconDevice device;
  falcon::FalconReport report;
  Sample sample;
  Fault fault = Fault::kNone;
  bool answers = true;
  int answered = 0;
  std::int64_t now_ns = 1'000'000'000;
};

}  // namespace tact::tests
