// SPDX-License-Identifier: Apache-2.0
// OpenIGTLink is for the eyes: a server that sends poses of every body, and bytes that are none,
// changes no bit of a force.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <thread>

#include "host/igtl/igtl_wire.h"
#include "host/record/recording.h"
#include "tests/support/program.h"

namespace tact::igtl_forces_test {

namespace fs = std::filesystem;
namespace igtl = host::igtl;
using boost::asio::ip::tcp;
using host::tracking::BodyRole;
using host::tracking::BodyState;

const std::string kLiver = TACT_SOURCE_DIR "/model/scenes/liver.toml";

/// Sends all that it can to one client after the other.
class Trackers {
 public:
  Trackers() : thread_([this] { serve(); }) {}
  ~Trackers() {
    done_ = true;
    boost::system::error_code ignored;
    tcp::socket(io_).connect(at_, ignored);  // so that it accepts a last time
    thread_.join();
  }
  std::string at() const { return "127.0.0.1:" + std::to_string(at_.port()); }

 private:
  void serve() {
    while (!done_) {
      tcp::socket client(io_);
      acceptor_.accept(client);
      boost::system::error_code gone;
      for (int i = 0; !done_ && !gone; ++i) {
        boost::asio::write(client, boost::asio::buffer(batch(i)), gone);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
      }
    }
  }
  static std::string batch(int i) {
    const double x_m = 0.1 * std::sin(0.01 * i);
    const host::pose::Pose pose{.position_m = {x_m, 0.0, 0.02}};
    std::string out;
    for (const char* body : {"Hand", "Tool", "ToolToDevice", "ForceToDevice"})
      out += igtl::transform(body, 0.0, pose);
    out += igtl::force_sensor("Force", 0.0, {9.0, 9.0, 9.0});
    out += igtl::status("Tact", 0.0, {.code = 1, .subcode = 0, .name = "arm", .words = "armed"});
    std::string wrong = igtl::transform("Hand", 0.0, pose);
    wrong.back() = static_cast<char>(wrong.back() ^ 1);
    return out + wrong + igtl::transform("Hand", 0.0, pose, 1e6);
  }

  boost::asio::io_context io_;
  tcp::acceptor acceptor_{io_, {boost::asio::ip::address_v4::loopback(), 0}};
  tcp::endpoint at_ = acceptor_.local_endpoint();
  std::atomic<bool> done_ = false;
  std::thread thread_;
};

class IgtlForces : public testing::Test {
 protected:
  IgtlForces() : folder_("/tmp/tact-igtl-" + std::to_string(getpid())) {
    fs::create_directory(folder_);
    std::ofstream(in("index.html")) << "<html>";
  }
  ~IgtlForces() override { fs::remove_all(folder_); }

  std::string in(const std::string& name) const { return folder_ + "/" + name; }
  nlohmann::json run(const std::string& name, const std::string& options) const {
    const tests::Outcome done = tests::run_program(
        "tactd", kLiver + " --free-run --seconds 120 --no-black-box --json " + in(name) + options);
    EXPECT_EQ(done.status, 0) << done.output;
    std::ifstream file(in(name));
    return nlohmann::json::parse(file, nullptr, false);
  }
  std::size_t tracked_frames() const {
    const auto read = host::record::read_recording(in("view.tact"));
    return static_cast<std::size_t>(std::ranges::count_if(
        read.recording.operators,
        [](const auto& seen) { return seen[BodyRole::kHand].state == BodyState::kTracked; }));
  }

  const std::string folder_;
};

TEST_F(IgtlForces, FreeRunForcesAreBitEqualWithAndWithoutTrackers) {
  const auto alone = run("alone.json", " --no-telemetry");
  const Trackers trackers;
  nlohmann::json seen;
  {
    tests::StartedProgram viewer(
        "tact-view", {"--port", "0", "--page", folder_, "--socket", in("t.sock"), "--igtl", "0",
                      "--igtl-from", trackers.at(), "--record", in("view.tact")});
    std::this_thread::sleep_for(std::chrono::seconds(1));  // it has met the trackers
    seen = run("seen.json", " --socket " + in("t.sock"));
    std::this_thread::sleep_for(std::chrono::seconds(1));
  }
  EXPECT_GT(tracked_frames(), 10u);
  EXPECT_EQ(alone["force_hash"], seen["force_hash"]);
  EXPECT_EQ(alone["ticks"], seen["ticks"]);
  EXPECT_FALSE(alone["force_hash"].get<std::string>().empty());
}

}  // namespace tact::igtl_forces_test
