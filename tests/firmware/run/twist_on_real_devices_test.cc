// SPDX-License-Identifier: Apache-2.0
// Press, grip, twist, pull and tear of liver_twist on the stand-ins for the vendor SDKs of
// Force Dimension and of PHANTOM: the handle goes exactly as the scene's hand wants, three times as
// fast. The jaws close by the gripper, or by a button.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "firmware/admission/notes.h"
#include "firmware/gate/limits_for.h"
#include "firmware/loop/rt_loop.h"
#include "hal/mounting.h"
#include "hal/phantom/phantom_device.h"
#include "hal/registry/open_device.h"
#include "model/scene/tissue.h"
#include "model/time_ns.h"
#include "model/units.h"
#include "tests/support/message.h"
#include "tests/support/mountings.h"
#include "tests/support/scene_loop.h"
#include "tests/support/stepped_time.h"
#include "tests/support/stub_dhd/stub_client.h"
#include "tests/support/stub_hd/hd_client.h"

namespace tact::firmware::run::twist_on_real_devices_test {

using model::Vec3;
using model::operator""_deg;

constexpr double kStrokes_s = 3e-3;  // of the scene in a tick of 1 ms

using Rows = double[3][3];

/// A stand-in whose handle a test leads, in the axes of the base.
class LedDevice {
 public:
  virtual ~LedDevice() = default;
  virtual std::vector<std::string> keys() const = 0;
  virtual void lead(const Vec3& at_m, const Rows& turn, double grip_ratio) = 0;
  /// What its library was given last.
  virtual model::Wrench given() const = 0;
};

class LedDhd : public LedDevice {
 public:
  explicit LedDhd(int type) { stub_.set_type(type); }
  std::vector<std::string> keys() const override {
    return {"device.kind=\"force-dimension\"",
            "device.force_dimension.library=\"" + tests::kStubLibrary + "\""};
  }
  void lead(const Vec3& at_m, const Rows& turn, double grip_ratio) override {
    stub_.hold(at_m.x, at_m.y, at_m.z);
    stub_.turn(turn);
    stub_.grip(0.5236 * (1.0 - grip_ratio), grip_ratio > 0.7 ? 1 : 0);
  }
  model::Wrench given() const override {
    double f[6] = {};
    stub_.last_force(f);
    return {{f[0], f[1], f[2]}, {f[3], f[4], f[5]}};
  }

 private:
  tests::StubDhd stub_;
};

class LedHd : public LedDevice {
 public:
  std::vector<std::string> keys() const override {
    const auto scene = tests::phantom_scene();
    return {
        "device.kind=\"phantom\"", "device.phantom.library=\"" + tests::kStubHdLibrary + "\"",
        "device.phantom.name=\"" + scene.device.of<hal::phantom::PhantomSettings>().name + "\""};
  }
  void lead(const Vec3& at_m, const Rows& turn, double grip_ratio) override {
    constexpr unsigned kButtons = 0x2000;
    stub_.hold(1e3 * at_m.y + kMiddle_mm.x, 1e3 * at_m.z + kMiddle_mm.y,
               1e3 * at_m.x + kMiddle_mm.z);
    stub_.turn(turn);
    stub_.set_number(kButtons, grip_ratio > 0.7 ? 1.0 : 0.0);
  }
  model::Wrench given() const override {
    double f[3] = {};
    return stub_.last_force(f) == 0 ? model::Wrench{} : model::Wrench{{f[2], f[0], f[1]}, {}};
  }

 private:
  static constexpr Vec3 kMiddle_mm{0.0, 10.0, 5.0};
  tests::StubHd stub_;
};

constexpr int kPhantom = 0;

/// Each is mounted in another way.
struct RealDevice {
  const char* name;
  int type;  // of Force Dimension
  bool has_torque;
  const tests::MountingCase& mounted;

  friend void PrintTo(const RealDevice& one, std::ostream* out) { *out << one.name; }
};

const RealDevice kDevices[] = {{"omega7", 35, false, tests::kMountings[0]},
                               {"lambda7", 108, true, tests::kMountings[1]},
                               {"delta6", 64, true, tests::kMountings[2]},
                               {"sigma7", 104, true, tests::kMountings[3]},
                               {"phantom", kPhantom, false, tests::kMountings[4]},
                               {"delta6_upside_down", 64, true, tests::kMountings[5]}};

/// The force on the hand, from the first tick to the last.
struct Rendered {
  double press_N = 0.0, pull_N = 0.0, twist_rad = 0.0, torque_Nm = 0.0;
  bool held = false, torn = false;
  int arrived = 0, others = 0;  // forces of the stub with a torque that the loop wrote, or not
  model::Fault fault = model::Fault::kNone;
};

class TwistOnRealDevices : public testing::TestWithParam<RealDevice> {
 protected:
  void SetUp() override {
    if (GetParam().type == kPhantom)
      led_ = std::make_unique<LedHd>();
    else
      led_ = std::make_unique<LedDhd>(GetParam().type);
    const Vec3& turned_deg = GetParam().mounted.orientation_deg;
    // The liver 93 mm lower: the handle, not the jaws, is in the middle of a small workspace.
    std::vector<std::string> keys = led_->keys();
    keys.insert(keys.end(), {fmt::format("device.base_orientation_deg=[{}, {}, {}]", turned_deg.x,
                                         turned_deg.y, turned_deg.z),
                             "organ.position_m=[0, 0, -0.123]", "hand.site_m=[0, 0, -0.093]",
                             "hand.home_m=[0, 0, -0.073]"});
    auto loaded = hal::registry::load_scene(TACT_SOURCE_DIR "/model/scenes/liver_twist.toml", keys);
    ASSERT_EQ(tests::message_of(loaded), "");
    scene_ = std::move(*loaded);
    scene_.device.trust_library = true;
    mounting_ = hal::mounting_of(scene_.device);
    lead(scene_.hand.path.front());
    auto tissue = model::scene::make_tissue(scene_);
    ASSERT_EQ(tests::message_of(tissue), "");
    tissue_ = std::move(*tissue);
    auto device = hal::registry::open_device(scene_);
    ASSERT_EQ(tests::message_of(device), "");
    device_ = std::move(*device);
    controller_ = std::make_unique<loop::Controller>(
        tissue_->contact_scene(),
        gate::Gate(gate::limits_for(scene_.limits, device_->info()), 1.0 / scene_.rate_Hz, 1.0),
        /*hard_real_time=*/false);
    loop_ = std::make_unique<loop::RtLoop>(loop::LoopSettings{}, *device_, lines_, *controller_,
                                           clock_, requests_, *ring_);
    requests_.arm_at_start.store(true);
  }
  void TearDown() override {
    if (loop_) loop_->release_device();
  }

  void lead(const model::HandWaypoint& at) {
    const model::Quat turn =
        conjugate(mounting_.turn) * model::quat_from_rotation_vector(at.rotation_rad);
    const Vec3 p = mounting_.point_in_base(at.position_m);
    std::array<Vec3, 3> column{rotate(turn, {1, 0, 0}), rotate(turn, {0, 1, 0}),
                               rotate(turn, {0, 0, 1})};
    const double r[3][3] = {{column[0].x, column[1].x, column[2].x},
                            {column[0].y, column[1].y, column[2].y},
                            {column[0].z, column[1].z, column[2].z}};
    led_->lead(p, r, at.grip_ratio);
  }

  loop::TickRecord step(Rendered& rendered) {
    loop_->step();
    loop::TickRecord record;
    EXPECT_TRUE(ring_->pop(record));
    const model::Wrench& w = record.output.written;
    written_.push_back(
        {mounting_.force_in_base(w.force_N), mounting_.direction_in_base(w.torque_Nm)});
    if (written_.size() > 1000) written_.pop_front();
    const model::Quat& q = record.input.sample.tool.orientation;
    const bool held = tests::any_in(record, model::ContactState::kHeld);
    rendered.held |= held;
    rendered.fault = std::max(rendered.fault, record.output.fault);
    rendered.torque_Nm = std::max(rendered.torque_Nm, norm(w.torque_Nm));
    if (held) rendered.twist_rad = std::max(rendered.twist_rad, 2.0 * std::asin(std::abs(q.z)));
    if (held) rendered.pull_N = std::max(rendered.pull_N, -w.force_N.z);
    if (!rendered.held) rendered.press_N = std::max(rendered.press_N, w.force_N.z);
    if (rendered.pull_N > 0.0 && !held && record.input.sample.tool.grip_ratio == 1.0)
      rendered.torn = true;
    compare(rendered);
    return record;
  }

  /// What the library was given last is a wrench that the loop wrote, to the last digit.
  void compare(Rendered& rendered) {
    const model::Wrench given = led_->given();
    if (norm(given.force_N) == 0.0) return;
    const bool known = std::any_of(written_.begin(), written_.end(), [&](const model::Wrench& w) {
      return w.force_N == given.force_N && w.torque_Nm == given.torque_Nm;
    });
    ++(known ? rendered.arrived : rendered.others);
  }

  Rendered render_force() {
    Rendered rendered;
    for (int i = 0; i < 2000 && step(rendered).output.state != loop::State::kArmed; ++i) continue;
    const double end_s = scene_.hand.path.back().time_s;
    for (double t = 0.0; t < end_s; t += kStrokes_s) {
      lead(hand_target(scene_.hand.path, false, t));
      step(rendered);
    }
    return rendered;
  }

  std::unique_ptr<LedDevice> led_;
  model::scene::Scene scene_;
  hal::Mounting mounting_;
  std::unique_ptr<model::scene::Tissue> tissue_;
  hal::registry::OpenDevice device_;
  hal::NoSafetyLines lines_;
  tests::SteppedTime clock_;
  loop::Requests requests_;
  std::unique_ptr<loop::TickRing> ring_ = std::make_unique<loop::TickRing>();
  std::unique_ptr<loop::Controller> controller_;
  std::unique_ptr<loop::RtLoop> loop_;
  std::deque<model::Wrench> written_;
};

TEST_P(TwistOnRealDevices, PressGripTwistPullAndTearAreRendered) {
  const Rendered rendered = render_force();
  EXPECT_EQ(rendered.fault, model::Fault::kNone) << model::describe(rendered.fault).name;
  EXPECT_GT(rendered.press_N, 0.1);
  EXPECT_TRUE(rendered.held);
  EXPECT_GT(rendered.twist_rad, 19_deg);
  EXPECT_GT(rendered.pull_N, 0.3);
  EXPECT_TRUE(rendered.torn);
  EXPECT_GT(rendered.arrived, 500);
  EXPECT_EQ(rendered.others, 0);
  const bool lost = !admission::torque_note(scene_, device_->info()).empty();
  EXPECT_NE(lost, GetParam().has_torque);
  if (GetParam().has_torque)
    EXPECT_GT(rendered.torque_Nm, 0.015) << "of 0.2 N m";
  else
    EXPECT_EQ(rendered.torque_Nm, 0.0);
  EXPECT_LT(rendered.torque_Nm, 0.06);
}

INSTANTIATE_TEST_SUITE_P(Devices, TwistOnRealDevices, testing::ValuesIn(kDevices),
                         [](const auto& one) { return one.param.name; });

}  // namespace tact::firmware::run::twist_on_real_devices_test
