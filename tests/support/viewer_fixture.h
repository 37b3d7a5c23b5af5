// SPDX-License-Identifier: Apache-2.0
// viewer_fixture.h - the viewer in a thread of its own, made-up telemetry at its socket, and a
// small HTTP and WebSocket client.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <boost/asio/post.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "host/run/telemetry_client.h"
#include "host/server/viewer_server.h"
#include "tests/support/message.h"
#include "tests/support/telemetry_source.h"

namespace tact::test {

namespace fs = std::filesystem;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using boost::asio::ip::tcp;
using boost::system::error_code;
using Socket = websocket::stream<tcp::socket>;

class Viewer : public ::testing::Test {
 protected:
  Viewer()
      : folder_(fs::temp_directory_path() / ("tact-viewer-" + std::to_string(getpid()))),
        client_(io_, (folder_ / "t.sock").string(),
                {.start =
                     [this](const RunHeader& header, host::record::MeshBytes mesh) {
                       view_.begin(header, std::move(mesh), host::server::Link::kLive);
                     },
                 .frame = [this](const Frame& frame) { view_.add(frame), ++frames_; },
                 .lost = [this](const std::string& reason) { view_.lose(reason); },
                 .silent = [this](double seconds) { silences_s_.push_back(seconds); }}),
        server_(
            io_, view_,
            [this](const host::server::HandRequest& request) {
              client_.move_hand(request.position_m, request.rotation_rad, request.grip_ratio);
            },
            [this](const std::string& message) { warnings_.push_back(message); }) {
    fs::create_directories(folder_);
    std::ofstream(folder_ / "index.html") << "<html>page";
  }
  ~Viewer() override {
    boost::asio::post(io_, [this] { io_.stop(); });
    if (thread_.joinable()) thread_.join();
    fs::remove_all(folder_);
  }

  void start(const std::string& bind_address = "127.0.0.1",
             std::chrono::milliseconds request_timeout = std::chrono::seconds(10)) {
    ASSERT_EQ(tests::message_of(server_.open({.bind_address = bind_address,
                                              .port = 0,
                                              .page_folder = folder_,
                                              .request_timeout = request_timeout})),
              "");
    server_.start();
    client_.start();
    thread_ = std::thread([this] { io_.run(); });
  }

  /// Runs the source until a condition of the viewer's thread holds, at most a minute.
  template <typename Condition>
  bool wait_until(const Condition& condition) {
    for (int i = 0; i < 6000; ++i) {
      if (source_) source_->accept(header_, meshes_);
      bool holds = false;
      std::atomic<bool> asked = false;
      boost::asio::post(io_, [&] { holds = condition(), asked = true; });
      while (!asked) std::this_thread::yield();
      if (holds) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }
  void start_source() {
    source_ = std::make_unique<TelemetrySource>((folder_ / "t.sock").string());
    ASSERT_TRUE(source_->ok());
    ASSERT_TRUE(wait_until([this] { return view_.has_scene(); }));
  }

  template <typename Request>
  void show_token(Request& request) const {
    const std::string bearer = bearer_.value_or("Bearer " + server_.token());
    if (!bearer.empty()) request.set(http::field::authorization, bearer);
    if (!protocols_.empty()) request.set(http::field::sec_websocket_protocol, protocols_);
  }

  using Headers = std::vector<std::pair<std::string, std::string>>;
  http::response<http::string_body> get(const std::string& target,
                                        const std::string& host = "localhost",
                                        const Headers& headers = {}) {
    tcp::socket socket = connect();
    http::request<http::empty_body> request{http::verb::get, target, 11};
    request.set(http::field::host, host);
    for (const auto& [name, value] : headers) request.set(name, value);
    show_token(request);
    http::write(socket, request);
    boost::beast::flat_buffer buffer;
    http::response_parser<http::string_body> parser;
    parser.body_limit(1 << 28);
    error_code wrong;
    http::read(socket, buffer, parser, wrong);
    EXPECT_FALSE(wrong) << wrong.message();
    return parser.release();
  }

  tcp::socket connect() {
    tcp::socket socket(client_io_);
    socket.connect({boost::asio::ip::make_address("127.0.0.1"), server_.port()});
    return socket;
  }
  /// All that comes back for these bytes until the connection ends.
  std::string say(const std::string& bytes) {
    tcp::socket socket = connect();
    error_code wrong;
    boost::asio::write(socket, boost::asio::buffer(bytes), wrong);
    std::string answer;
    boost::asio::read(socket, boost::asio::dynamic_buffer(answer), wrong);
    EXPECT_EQ(wrong, boost::asio::error::eof);
    return answer;
  }

  error_code open_live(Socket& socket, const std::string& origin) {
    socket.next_layer().connect({boost::asio::ip::make_address("127.0.0.1"), server_.port()});
    socket.set_option(
        websocket::stream_base::decorator([this, origin](websocket::request_type& request) {
          request.set(http::field::origin, origin);
          show_token(request);
        }));
    error_code wrong;
    socket.handshake("localhost:1", "/live", wrong);
    return wrong;
  }
  static nlohmann::json read(Socket& socket) {
    boost::beast::flat_buffer buffer;
    error_code wrong;
    socket.read(buffer, wrong);
    EXPECT_FALSE(wrong) << wrong.message();
    return nlohmann::json::parse(boost::beast::buffers_to_string(buffer.data()), nullptr, false);
  }

  fs::path folder_;
  host::server::LiveView view_;
  boost::asio::io_context io_{1}, client_io_{1};
  host::run::TelemetryClient client_;
  host::server::ViewerServer server_;
  std::unique_ptr<TelemetrySource> source_;
  RunHeader header_ = make_header(3, 1, 3, 1);
  std::vector<std::byte> meshes_ = TinyMeshes{}.bytes();
  std::atomic<std::uint64_t> frames_ = 0;
  std::vector<double> silences_s_;     // as they were reported; of the viewer's thread
  std::vector<std::string> warnings_;  // as well
  std::thread thread_;
  std::optional<std::string> bearer_;  // none: that of the server's token
  std::string protocols_;
};

}  // namespace tact::test
