// SPDX-License-Identifier: Apache-2.0
#include "firmware/telemetry/telemetry.h"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "firmware/loop/rt_loop.h"
#include "hal/registry/open_device.h"
#include "host/server/frame_json.h"
#include "tests/support/message.h"
#include "tests/support/test_scene.h"

namespace tact::firmware::telemetry::telemetry_test {

using tests::message_of;

std::string fresh_socket_path() {
  static int count = 0;
  return "/tmp/tact-telemetry-test-" + std::to_string(getpid()) + "-" + std::to_string(++count);
}

// A viewer with a will of its own.
class Viewer {
 public:
  explicit Viewer(const std::string& path) : fd_(socket(AF_UNIX, SOCK_SEQPACKET, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    connected_ = connect(fd_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  }
  ~Viewer() { close(fd_); }
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  bool connected() const { return connected_; }
  void send_garbage() const {
    const char garbage[1000] = {'x'};
    (void)::send(fd_, garbage, sizeof garbage, MSG_DONTWAIT | MSG_NOSIGNAL);
  }
  template <typename T>
  bool receive(T& message) const {
    return recv(fd_, &message, sizeof message, MSG_DONTWAIT) == sizeof message;
  }
  /// The hello with the mesh file's descriptor.
  bool receive_hello(Hello& hello, int& mesh_fd) const {
    iovec bytes{&hello, sizeof hello};
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))];
    msghdr message{};
    message.msg_iov = &bytes;
    message.msg_iovlen = 1;
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    if (recvmsg(fd_, &message, MSG_DONTWAIT) != sizeof hello) return false;
    const cmsghdr* rights = CMSG_FIRSTHDR(&message);
    if (rights == nullptr) return false;
    std::memcpy(&mesh_fd, CMSG_DATA(rights), sizeof mesh_fd);
    return true;
  }

 private:
  int fd_;
  bool connected_ = false;
};

// A whole controller on simulated time; the test is its telemetry thread.
class WholeController {
 public:
  explicit WholeController(const std::string& path)
      : tissue_(std::move(*model::scene::make_tissue(scene_))),
        device_(std::move(*hal::registry::open_device(scene_))),
        controller_(tissue_->contact_scene(), gate::Gate(scene_.limits, 0.001, 1.0),
                    /*hard_real_time=*/true),
        loop_({.period_ns = 1'000'000}, *device_, lines_, controller_, clock_, requests_, *ring_),
        telemetry_(*ring_, FrameBuilder(tissue_->law().contact_law(), controller_.shapes(), true),
                   FramePace{}, {.socket = open(path)}) {
    requests_.arm_at_start.store(true);
  }

  void ticks(int n) {
    for (int i = 0; i < n; ++i) {
      loop_.step();
      telemetry_.drain();
      if (i % 16 == 0) telemetry_.publish();
    }
  }
  const loop::LoopStatistics& statistics() const { return loop_.statistics(); }
  Telemetry& telemetry() { return telemetry_; }
  const model::scene::Scene& scene() const { return scene_; }

 private:
  std::optional<TelemetrySocket> open(const std::string& path) {
    const Hello hello =
        make_hello(scene_, *tissue_, {.device = device_->info(), .torque_limit_Nm = 0.0495});
    return std::move(*TelemetrySocket::open(path, hello, *make_mesh_file(scene_)));
  }

  model::scene::Scene scene_ = tests::make_plate_scene();
  std::unique_ptr<model::scene::Tissue> tissue_;
  hal::registry::OpenDevice device_;
  hal::NoSafetyLines lines_;
  loop::Controller controller_;
  loop::SimulatedClock clock_;
  loop::Requests requests_;
  std::unique_ptr<loop::TickRing> ring_ = std::make_unique<loop::TickRing>();
  loop::RtLoop loop_;
  Telemetry telemetry_;
};

TEST(Telemetry, GreetsAViewerWithTheMeshesAndFramesFollow) {
  const std::string path = fresh_socket_path();
  WholeController run(path);
  const Viewer viewer(path);
  ASSERT_TRUE(viewer.connected());
  run.ticks(1600);
  Hello hello;
  int mesh_fd = -1;
  ASSERT_TRUE(viewer.receive_hello(hello, mesh_fd));
  EXPECT_EQ(hello.header.magic, kTelemetryMagic);
  EXPECT_EQ(hello.header.kind, MessageKind::kHello);
  EXPECT_EQ(hello.organ_vertices, run.scene().organ_mesh.vertex_m.size());
  EXPECT_EQ(hello.ring_count, 24u);
  EXPECT_STREQ(hello.scene_name, "plate");
  EXPECT_EQ(hello.torque_limit_mNm, 50);
  EXPECT_STREQ(hello.organ_material, "skin");
  EXPECT_STREQ(hello.tool_material, "steel");
  ASSERT_EQ(hello.piece_count, 1u);
  EXPECT_EQ(hello.piece_color_ratio[0][2], 0.5f);
  struct stat info{};
  ASSERT_EQ(fstat(mesh_fd, &info), 0);
  const std::size_t expected = 12u * (hello.organ_vertices + hello.organ_triangles +
                                      hello.tool_vertices + hello.tool_triangles);
  EXPECT_EQ(static_cast<std::size_t>(info.st_size), expected);
  EXPECT_EQ(mmap(nullptr, expected, PROT_READ | PROT_WRITE, MAP_SHARED, mesh_fd, 0), MAP_FAILED)
      << "sealed: nobody can change what others see";
  close(mesh_fd);
  Frame frame;
  int frames = 0;
  bool touched = false;
  while (viewer.receive(frame)) {
    ++frames;
    touched = touched || frame.site[0].state == SiteState::kTouching;
  }
  EXPECT_GT(frames, 20);
  EXPECT_TRUE(touched);
}

TEST(Telemetry, FramesCarryTheProfileOfTheTouchedSite) {
  const std::string path = fresh_socket_path();
  WholeController run(path);
  run.ticks(1500);
  const Frame frame = run.telemetry().newest_frame();
  ASSERT_EQ(frame.site[0].state, SiteState::kTouching);
  EXPECT_GT(frame.site[0].depth_m, 0.001f);
  EXPECT_NEAR(frame.site[0].profile_m[0], frame.site[0].depth_m, 1e-7f);
  EXPECT_LT(frame.site[0].profile_m[5], frame.site[0].profile_m[0]);
  EXPECT_EQ(frame.site[0].profile_m[23], 0.0f);
  EXPECT_GT(frame.peak_force_N, 0.05f);
  EXPECT_EQ(frame.non_rt, 1);
}

TEST(Telemetry, IsForItsOwnerOnly) {
  const std::string path = fresh_socket_path();
  const WholeController run(path);
  struct stat info{};
  ASSERT_EQ(stat(path.c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777, 0600u);
}

TEST(Telemetry, ViewersThatStallCrashOrTalkChangeNothingInTheLoop) {
  std::uint64_t quiet_hash = 0;
  {
    WholeController quiet(fresh_socket_path());
    quiet.ticks(8000);
    quiet.telemetry().stop();
    quiet_hash = quiet.telemetry().force_hash();
  }
  const std::string path = fresh_socket_path();
  WholeController run(path);
  const Viewer stalled(path);  // never reads
  const Viewer talker(path);
  auto crasher = std::make_unique<Viewer>(path);
  run.ticks(2000);
  talker.send_garbage();
  crasher.reset();  // gone in the middle of a stream
  run.ticks(2000);
  talker.send_garbage();
  run.ticks(4000);
  run.telemetry().stop();
  EXPECT_GT(run.telemetry().dropped_frames(), 0u) << "the stalled viewer's frames are dropped";
  EXPECT_EQ(run.statistics().late_ticks, 0u);
  EXPECT_EQ(run.telemetry().force_hash(), quiet_hash) << "same forces, bit for bit";
  EXPECT_NE(quiet_hash, 0u);
}

TEST(Telemetry, TheRingHoldsASecondOfTicksAtEveryRate) {
  const loop::TickRecord record;
  for (const double rate_Hz : {100.0, 4000.0, 10'000.0}) {
    loop::TickRing ring(rate_Hz);
    for (int i = 0; i < static_cast<int>(rate_Hz); ++i) ring.push(record);
    EXPECT_EQ(ring.dropped(), 0u) << rate_Hz;
  }
}

TEST(Telemetry, ThreadAndLoopShareOnlyTheRing) {  // for the thread sanitizer
  const std::string path = fresh_socket_path();
  const model::scene::Scene scene = tests::make_plate_scene();
  const auto tissue = std::move(*model::scene::make_tissue(scene));
  const auto ring = std::make_unique<loop::TickRing>();  // large: not on the stack
  const auto shapes = std::make_unique<loop::ShapeSlot>();
  Telemetry telemetry(*ring, FrameBuilder(tissue->law().contact_law(), *shapes, false),
                      {.frame_rate_Hz = 200.0}, Sinks{});
  telemetry.start();
  loop::TickRecord record;
  for (int i = 0; i < 20000; ++i) {
    record.tick = static_cast<std::uint64_t>(i);
    ring->push(record);
    if (i % 1000 == 0) usleep(2000);
  }
  EXPECT_EQ(tests::message_of(telemetry.stop()), "");
  EXPECT_GT(telemetry.newest_frame().tick, 0u);
}

// The whole way of a patch: springs, shape, slot, frame, text for the page. One thread steps, the
// other tells; what arrives names only what the organ has. (That no shape is half of another is for
// latest_slot_test and, here, the thread sanitizer.)
TEST(Telemetry, TheShapeOfAPatchReachesThePageWhole) {
  const auto scene = model::scene::load_scene(TACT_SOURCE_DIR "/model/scenes/gum.toml", {});
  ASSERT_TRUE(scene) << scene.error().message;
  const auto tissue = std::move(*model::scene::make_tissue(*scene));
  const auto device = std::move(*hal::registry::open_device(*scene));
  loop::Controller controller(tissue->contact_scene(), gate::Gate(scene->limits, 0.001, 1.0),
                              /*hard_real_time=*/true);
  loop::SimulatedClock clock;
  hal::NoSafetyLines lines;
  loop::Requests requests;
  requests.arm_at_start.store(true);
  const auto ring = std::make_unique<loop::TickRing>();
  loop::RtLoop loop({.period_ns = 1'000'000, .ticks_per_shape = 4}, *device, lines, controller,
                    clock, requests, *ring);
  Telemetry telemetry(*ring, FrameBuilder(tissue->law().contact_law(), controller.shapes(), false),
                      {.frame_rate_Hz = 1000.0}, Sinks{});
  const Hello hello = make_hello(
      *scene, *tissue, {.device = device->info(), .limits_checksum = "", .hand_socket = ""});
  telemetry.start();
  std::uint32_t displaced = 0;
  for (int i = 0; i < 8000; ++i) {
    loop.step();
    if (i % 50 != 0) continue;
    const Frame frame = telemetry.newest_frame();
    ASSERT_EQ(message_of(host::record::check_frame(frame, hello)), "") << "tick " << frame.tick;
    const auto patch = nlohmann::json::parse(host::server::frame_json(frame, hello)).at("patch");
    ASSERT_EQ(patch.at("count"), frame.patch.vertex_count);
    ASSERT_EQ(patch.at("cut").size(), frame.patch.cut_count);
    displaced = std::max(displaced, frame.patch.vertex_count);
    usleep(500);
  }
  EXPECT_EQ(tests::message_of(telemetry.stop()), "");
  EXPECT_GT(displaced, 10u);
  EXPECT_GT(telemetry.newest_frame().patch.cut_total, 5u);
  EXPECT_EQ(telemetry.newest_frame().fault, 0);
}

TEST(Telemetry, ASecondControllerOnTheSameSocketIsRefused) {
  const std::string path = fresh_socket_path();
  const WholeController run(path);
  const auto second = TelemetrySocket::open(path, Hello{}, -1);
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().message.find("another tactd"), std::string::npos);
}

TEST(Telemetry, TheSocketOfADeadControllerIsReplaced) {
  const std::string path = fresh_socket_path();
  const int dead = socket(AF_UNIX, SOCK_SEQPACKET, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  ASSERT_EQ(bind(dead, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  close(dead);  // the file stays, nobody listens
  EXPECT_TRUE(TelemetrySocket::open(path, Hello{}, -1));
}

TEST(Telemetry, APathThatIsTooLongIsRefusedWithTheRemedy) {
  const auto refused = TelemetrySocket::open(std::string(200, 'x'), Hello{}, -1);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("--socket"), std::string::npos);
}

}  // namespace tact::firmware::telemetry::telemetry_test
