// SPDX-License-Identifier: Apache-2.0
#include "firmware/loop/supervisor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "firmware/gate/gate.h"

namespace tact::firmware::loop::supervisor_test {

constexpr Commands kArm{.arm = true};
constexpr Commands kIdle{};
constexpr Commands kReset{.reset = true};

Supervisor armed_supervisor() {
  Supervisor s;
  s.step(kIdle, {.sample_good = true, .ready = true, .fault = Fault::kNone});
  s.step(kArm, {.sample_good = true, .ready = true, .fault = Fault::kNone});
  EXPECT_TRUE(s.armed());
  return s;
}

TEST(Supervisor, IsOffUntilTheDeviceGivesAGoodSample) {
  Supervisor s;
  EXPECT_EQ(s.step(kArm, {.sample_good = false, .ready = true, .fault = Fault::kNone}),
            State::kOff);
  EXPECT_EQ(s.step(kIdle, {.sample_good = true, .ready = true, .fault = Fault::kNone}),
            State::kReady);
}

TEST(Supervisor, NeedsARequestToArm) {
  Supervisor s;
  for (int i = 0; i < 5; ++i)
    s.step(kIdle, {.sample_good = true, .ready = true, .fault = Fault::kNone});
  EXPECT_EQ(s.state(), State::kReady);
  EXPECT_EQ(s.step(kArm, {.sample_good = true, .ready = true, .fault = Fault::kNone}),
            State::kArmed);
}

TEST(Supervisor, StopsOnRequestWithoutAFault) {
  Supervisor s = armed_supervisor();
  EXPECT_EQ(s.step({.stop = true}, {.sample_good = true, .ready = true, .fault = Fault::kNone}),
            State::kStopped);
  EXPECT_EQ(s.fault(), Fault::kNone);
}

TEST(Supervisor, DisarmsToReadyAndCanBeArmedAgain) {
  Supervisor s = armed_supervisor();
  EXPECT_EQ(s.step({.disarm = true}, {.sample_good = true}), State::kReady);
  EXPECT_EQ(s.fault(), Fault::kNone);
  EXPECT_EQ(s.step({.arm = true, .disarm = true}, {.sample_good = true}), State::kReady);
  s.step(kIdle, {.sample_good = true});
  EXPECT_EQ(s.step(kArm, {.sample_good = true}), State::kArmed);
  EXPECT_EQ(s.step({.arm = true, .disarm = true}, {.sample_good = true}), State::kReady);
}

TEST(Supervisor, LatchesTheFirstFault) {
  Supervisor s = armed_supervisor();
  s.step(kIdle, {.sample_good = true, .ready = true, .fault = Fault::kDeviceFailed});
  s.step(kIdle, {.sample_good = true, .ready = true, .fault = Fault::kDeviceLost});
  EXPECT_EQ(s.state(), State::kStopped);
  EXPECT_EQ(s.fault(), Fault::kDeviceFailed);
}

TEST(Supervisor, GoesOnWhileALimitActs) {
  Supervisor s = armed_supervisor();
  EXPECT_EQ(s.step(kIdle, {.sample_good = true, .ready = true, .fault = Fault::kForceLimited}),
            State::kArmed);
  s.trip(Fault::kSlewLimited);
  EXPECT_EQ(s.state(), State::kArmed);
}

TEST(Supervisor, AFaultFromTheGateStopsInTheSameTick) {
  Supervisor s = armed_supervisor();
  s.trip(Fault::kForceNotFinite);
  EXPECT_FALSE(s.armed());
  EXPECT_EQ(s.fault(), Fault::kForceNotFinite);
}

TEST(Supervisor, OnlyAResetEdgeWithAllInputsGoodLeavesStopped) {
  Supervisor s = armed_supervisor();
  s.step(kReset, {.sample_good = true,
                  .ready = true,
                  .fault = Fault::kDeviceLost});  // the edge came with the fault: not good
  EXPECT_EQ(s.step(kReset, {.sample_good = true, .ready = true, .fault = Fault::kNone}),
            State::kStopped)
      << "a level is no edge";
  s.step(kIdle, {.sample_good = true, .ready = true, .fault = Fault::kNone});
  EXPECT_EQ(s.step(kReset, {.sample_good = false, .ready = true, .fault = Fault::kNone}),
            State::kStopped)
      << "no good sample";
  s.step(kIdle, {.sample_good = true, .ready = true, .fault = Fault::kNone});
  EXPECT_EQ(s.step({.arm = true, .reset = true},
                   {.sample_good = true, .ready = true, .fault = Fault::kNone}),
            State::kStopped)
      << "an arm request that lasts is no good input";
  s.step(kIdle, {.sample_good = true, .ready = true, .fault = Fault::kNone});
  EXPECT_EQ(s.step(kReset, {.sample_good = true, .ready = true, .fault = Fault::kNone}),
            State::kReady);
  EXPECT_EQ(s.fault(), Fault::kNone);
}

TEST(Supervisor, ResetNeverArms) {
  Supervisor s = armed_supervisor();
  s.step(kIdle, {.sample_good = true, .ready = true, .fault = Fault::kDeviceLost});
  s.step(kReset, {.sample_good = true, .ready = true, .fault = Fault::kNone});
  for (int i = 0; i < 5; ++i)
    s.step(kReset, {.sample_good = true, .ready = true, .fault = Fault::kNone});
  EXPECT_EQ(s.state(), State::kReady);
}

TEST(Supervisor, ARequestThatCouldNotArmIsSpent) {
  for (const Findings& found : {Findings{.sample_good = false}, Findings{.ready = false}}) {
    Supervisor s;
    EXPECT_EQ(s.step(kArm, {.sample_good = true}), State::kReady)
        << "asked for before it was ready";
    EXPECT_EQ(s.step(kArm, {.sample_good = true}), State::kReady);
    s.step(kIdle, {.sample_good = true});
    EXPECT_EQ(s.step(kArm, found), State::kReady) << "no power, or no sample";
    EXPECT_EQ(s.step(kArm, {.sample_good = true}), State::kReady) << "the request still lasts";
    s.step(kIdle, {.sample_good = true});
    EXPECT_EQ(s.step(kArm, {.sample_good = true}), State::kArmed);
  }
}

TEST(Supervisor, PowerThatComesBackBringsNoForceWithIt) {
  Supervisor s;
  s.step(kIdle, {.sample_good = true, .ready = true, .fault = Fault::kNone});
  s.step(kArm, {.sample_good = true, .ready = true, .fault = Fault::kNone});
  s.step(kArm, {.sample_good = true, .ready = false, .fault = Fault::kNone});
  EXPECT_EQ(s.step(kArm, {.sample_good = true, .ready = true, .fault = Fault::kNone}),
            State::kStopped);
  EXPECT_EQ(s.fault(), Fault::kPowerLost);
}

// tests/spin/supervisor_rules.inc: what Spin has proved the properties of.
struct Rule {
  std::string from, to, latched;
  std::vector<std::string> when;  // names, with ! before those that must be false
};

std::vector<Rule> load_rules() {
  std::ifstream file(TACT_SOURCE_DIR "/tests/spin/supervisor_rules.inc");
  const std::regex row(R"(RULE\((\w+), +(\w+), +(\w+), +([^)]*)\))");
  std::vector<Rule> rules;
  for (std::string line; std::getline(file, line);) {
    std::smatch found;
    if (!std::regex_match(line, found, row)) continue;
    Rule rule{found[1], found[2], found[3], {}};
    std::istringstream words(found[4]);
    for (std::string word; words >> word;)
      if (word != "&&") rule.when.push_back(word);
    rules.push_back(rule);
  }
  return rules;
}

using Inputs = std::map<std::string, bool>;

bool holds(const Rule& rule, const Inputs& inputs) {
  return std::all_of(rule.when.begin(), rule.when.end(), [&](const std::string& word) {
    return word[0] == '!' ? !inputs.at(word.substr(1)) : inputs.at(word);
  });
}

const std::map<std::string, State> kStates{{"OFF", State::kOff},
                                           {"READY", State::kReady},
                                           {"ARMED", State::kArmed},
                                           {"STOPPED", State::kStopped}};

struct Outcome {
  State state;
  Fault fault;
};

Outcome by_the_rules(const std::vector<Rule>& rules, Outcome now, const Inputs& inputs) {
  for (const Rule& rule : rules) {
    const bool here = rule.from == "ANY" || kStates.at(rule.from) == now.state;
    if (!here || !holds(rule, inputs)) continue;
    const Fault found = rule.latched == "POWER_LOST" ? Fault::kPowerLost : Fault::kDeviceFailed;
    if (rule.latched == "CLEAR") now.fault = Fault::kNone;
    if (rule.latched != "CLEAR" && rule.latched != "KEEP" && now.fault == Fault::kNone)
      now.fault = found;
    now.state = kStates.at(rule.to);
    return now;
  }
  return now;
}

// Every state that it can be in: with a kept fault and without, after each request and without.
Supervisor supervisor_in(State state, bool faulty, const Commands& before) {
  Supervisor s;
  if (state == State::kArmed) {
    s.step({}, {.sample_good = true});
    s.step(kArm, {.sample_good = true});
  }
  Commands last = before;
  last.stop = state == State::kStopped;
  s.step(last, {.sample_good = state != State::kOff});
  if (faulty) s.trip(Fault::kLoopLate);
  return s;
}

TEST(Supervisor, DoesWhatItsRulesSayInEveryStateForEveryInput) {
  const std::vector<Rule> rules = load_rules();
  ASSERT_EQ(rules.size(), 7u);
  int cases = 0;
  for (const auto& [name, from] : kStates)
    for (int bits = 0; bits < 2048; ++bits) {
      const auto bit = [bits](int i) { return (bits >> i & 1) != 0; };
      const bool faulty = bit(8);
      const Commands before{.arm = bit(7), .reset = bit(6), .disarm = bit(10)};
      if (faulty && from != State::kStopped) continue;  // a kept fault is a stop
      // A request to disarm leaves Armed in its own tick, and nothing arms while it lasts.
      if (before.disarm && from == State::kArmed) continue;
      Supervisor s = supervisor_in(from, faulty, before);
      ASSERT_EQ(s.state(), from);
      const Commands commands{.arm = bit(0), .stop = bit(1), .reset = bit(2), .disarm = bit(9)};
      const Findings found{.sample_good = bit(3),
                           .ready = bit(4),
                           .fault = bit(5) ? Fault::kDeviceFailed : Fault::kForceLimited};
      const Outcome wanted = by_the_rules(rules, {from, s.fault()},
                                          {{"arm", commands.arm},
                                           {"arm_edge", commands.arm && !before.arm},
                                           {"stop", commands.stop},
                                           {"reset_edge", commands.reset && !before.reset},
                                           {"disarm", commands.disarm},
                                           {"disarm_edge", commands.disarm && !before.disarm},
                                           {"sample_good", found.sample_good},
                                           {"ready", found.ready},
                                           {"fault_found", bit(5)}});
      s.step(commands, found);
      ASSERT_EQ(s.state(), wanted.state) << name << ", bits " << bits;
      ASSERT_EQ(s.fault(), wanted.fault) << name << ", bits " << bits;
      ++cases;
    }
  EXPECT_EQ(cases, 4 * 1024 + 1024 - 512);
}

int model_constant(const std::string& name) {
  std::ifstream file(TACT_SOURCE_DIR "/tests/spin/supervisor.pml");
  const std::regex row("#define " + name + R"( (\d+).*)");
  for (std::string line; std::getline(file, line);) {
    std::smatch found;
    if (std::regex_match(line, found, row)) return std::stoi(found[1]);
  }
  return 0;
}

// What tests/spin/supervisor.pml says of the gate, at 1 kHz.
TEST(Supervisor, TheModelRampsDownAndLosesAfterAsManyMissedAsTheGate) {
  const model::Limits limits{.force_N = 8.0,
                             .torque_Nm = 0.2,
                             .slew_N_per_s = 1000.0,
                             .ramp_s = 0.1,
                             .workspace_radius_m = 0.18,
                             .workspace_half_length_m = 0.15};
  gate::Gate gate(limits, 0.001, 1.0);
  gate::GateInput input{.wanted = {{1, 0, 0}, {}}, .tool = {}, .fresh = true, .armed = true};
  for (int i = 0; i < 200; ++i) gate.limit(input);
  input.fresh = false;
  int missed_to_zero = 0, missed_to_lost = 0;
  for (int missed = 1; missed < 100 && missed_to_lost == 0; ++missed) {
    const gate::LimitedForce v = gate.limit(input);
    if (missed_to_zero == 0 && norm(v.wrench.force_N) < 1e-12) missed_to_zero = missed;
    if (latches(v.fault)) missed_to_lost = missed;
  }
  EXPECT_EQ(missed_to_zero, 1 + model_constant("FADE"));
  EXPECT_EQ(missed_to_lost, model_constant("LOST"));
}

TEST(Supervisor, AFaultOfTheGateStopsFromEveryStateAndTheFirstIsKept) {
  for (const auto& [name, from] : kStates) {
    Supervisor s = supervisor_in(from, false, {});
    s.trip(Fault::kEnergyOverdrawn);
    s.trip(Fault::kPowerExceeded);
    EXPECT_EQ(s.state(), State::kStopped) << name;
    EXPECT_EQ(s.fault(), Fault::kEnergyOverdrawn) << name;
  }
}

}  // namespace tact::firmware::loop::supervisor_test
