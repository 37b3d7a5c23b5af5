// SPDX-License-Identifier: Apache-2.0
#include "firmware/telemetry/telemetry.h"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "firmware/loop/rt_loop.h"
#include "firmware/protocol/run_file.h"
#include "firmware/protocol/tick_log.h"
#include "hal/registry/open_device.h"
#include "tests/support/message.h"
#include "tests/support/test_scene.h"

namespace tact::firmware::telemetry::telemetry_test {

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
  /// The next message that is a whole frame.
  bool receive(Frame& frame) const {
    char bytes[65536];
    const ssize_t size = recv(fd_, bytes, sizeof bytes, MSG_DONTWAIT);
    if (size <= 0) return false;
    const auto chunk = protocol::chunk_in({bytes, static_cast<std::size_t>(size)});
    return chunk && chunk->kind == protocol::ChunkKind::kFrame &&
           protocol::Unpacker::make(json_of(Frame::fields(1)), Frame::fields())
               ->unpack(chunk->content, &frame);
  }
  /// The first message, with the descriptor of the memory file.
  bool receive_start(std::string& magic, int& memory_file) const {
    magic.resize(100);
    iovec bytes{magic.data(), magic.size()};
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))];
    msghdr message{};
    message.msg_iov = &bytes;
    message.msg_iovlen = 1;
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    const ssize_t size = recvmsg(fd_, &message, MSG_DONTWAIT);
    const cmsghdr* rights = size > 0 ? CMSG_FIRSTHDR(&message) : nullptr;
    if (rights == nullptr) return false;
    magic.resize(static_cast<std::size_t>(size));
    std::memcpy(&memory_file, CMSG_DATA(rights), sizeof memory_file);
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
                   FramePace{}, {.socket = open(path), .frame_fields = Frame::fields(1)}) {
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
    const std::string start = start_of_run(header_of(scene_, *tissue_), mesh_bytes(scene_),
                                           {protocol::schema_of<Frame>(Frame::fields(1))});
    return std::move(*TelemetrySocket::open(path, *make_memory_file(start)));
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
  std::string magic;
  int memory_file = -1;
  ASSERT_TRUE(viewer.receive_start(magic, memory_file));
  EXPECT_EQ(magic, protocol::kMagic);
  struct stat info{};
  ASSERT_EQ(fstat(memory_file, &info), 0);
  const auto size = static_cast<std::size_t>(info.st_size);
  EXPECT_EQ(mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, memory_file, 0), MAP_FAILED)
      << "sealed: no client can change what others see";
  std::string bytes(size, '\0');
  ASSERT_EQ(pread(memory_file, bytes.data(), size, 0), info.st_size);
  close(memory_file);
  auto start = protocol::RunReader::of_bytes(bytes);
  ASSERT_TRUE(start) << start.error().message;
  const RunHeader& header = start->header();
  EXPECT_EQ(header.organ_vertices, run.scene().organ_mesh.vertex_m.size());
  EXPECT_EQ(header.profile_points, 24u);
  EXPECT_EQ(header.scene_name, "plate");
  EXPECT_EQ(header.organ_material, "skin");
  EXPECT_EQ(header.tool_material, "steel");
  ASSERT_EQ(header.piece_color_ratio.size(), 1u);
  EXPECT_EQ(header.piece_color_ratio[0][2], 0.5f);
  protocol::Chunk meshes;
  ASSERT_TRUE(start->next(meshes));
  EXPECT_EQ(meshes.kind, protocol::ChunkKind::kMeshes);
  EXPECT_EQ(meshes.content.size(), 12u * (header.organ_vertices + header.organ_triangles +
                                          header.tool_vertices + header.tool_triangles));
  Frame frame;
  int frames = 0;
  bool in_contact = false;
  while (viewer.receive(frame)) {
    ++frames;
    in_contact = in_contact || frame.contact[0].state == model::ContactState::kInContact;
  }
  EXPECT_GT(frames, 20);
  EXPECT_TRUE(in_contact);
}

TEST(Telemetry, FramesCarryTheProfileOfTheTouchedSite) {
  const std::string path = fresh_socket_path();
  WholeController run(path);
  run.ticks(1500);
  const Frame frame = run.telemetry().newest_frame();
  ASSERT_EQ(frame.contact[0].state, model::ContactState::kInContact);
  EXPECT_GT(frame.contact[0].depth_m, 0.001f);
  EXPECT_NEAR(frame.contact[0].profile_m[0], frame.contact[0].depth_m, 1e-7f);
  EXPECT_LT(frame.contact[0].profile_m[5], frame.contact[0].profile_m[0]);
  EXPECT_EQ(frame.contact[0].profile_m[23], 0.0f);
  EXPECT_GT(frame.peak_force_N, 0.05f);
  EXPECT_TRUE(frame.non_rt);
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
  ASSERT_FALSE(telemetry.start());
  loop::TickRecord record;
  for (int i = 0; i < 20000; ++i) {
    record.tick = static_cast<std::uint64_t>(i);
    ring->push(record);
    if (i % 1000 == 0) usleep(2000);
  }
  EXPECT_EQ(tests::message_of(telemetry.stop()), "");
  EXPECT_GT(telemetry.newest_frame().tick, 0u);
}

TEST(Telemetry, TheLogGrowsWithEachFrame) {
  const std::string path = fresh_socket_path() + ".tactlog";
  const auto tissue = std::move(*model::scene::make_tissue(tests::make_plate_scene()));
  const auto ring = std::make_unique<loop::TickRing>();
  const auto shapes = std::make_unique<loop::ShapeSlot>();
  Sinks sinks;
  sinks.log.emplace(std::move(*protocol::RunWriter::create(
      path, protocol::start_of_run({}, {}, {protocol::schema_of<LoggedTick>()}))));
  Telemetry telemetry(*ring, FrameBuilder(tissue->law().contact_law(), *shapes, false), FramePace{},
                      std::move(sinks));
  for (std::uint64_t tick = 1; tick <= 3; ++tick) {
    loop::TickRecord record;
    record.tick = tick;
    ring->push(record);
    telemetry.drain();
    telemetry.publish();
    auto log = protocol::TickLog::open(path);
    ASSERT_TRUE(log);
    LoggedTick read;
    while (log->next(read)) continue;
    EXPECT_EQ(read.tick, tick) << "who follows the log waits for it";
  }
  EXPECT_EQ(tests::message_of(telemetry.stop()), "");
  telemetry.publish();  // after the end nothing is written
  std::remove(path.c_str());
}

TEST(Telemetry, ASecondControllerOnTheSameSocketIsRefused) {
  const std::string path = fresh_socket_path();
  const WholeController run(path);
  const auto second = TelemetrySocket::open(path, -1);
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
  close(dead);  // the file stays, no process listens
  EXPECT_TRUE(TelemetrySocket::open(path, -1));
}

TEST(Telemetry, APathThatIsTooLongIsRefusedWithTheRemedy) {
  const auto refused = TelemetrySocket::open(std::string(200, 'x'), -1);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("--socket"), std::string::npos);
}

}  // namespace tact::firmware::telemetry::telemetry_test
