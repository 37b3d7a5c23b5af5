// SPDX-License-Identifier: Apache-2.0
// What is no request: an answer in numbers that browsers know, and the end of the connection.
#include "host/server/http_session.h"

#include <gtest/gtest.h>

#include <list>

#include "tests/support/viewer_fixture.h"

namespace tact::test::http_session_test {

class HttpSession : public Viewer {};

TEST_F(HttpSession, MalformedRequestGetsItsStatusAndClosesTheConnection) {
  start();
  const std::string head = "GET / HTTP/1.1\r\nHost: localhost\r\n";
  const std::pair<const char*, std::string> cases[] = {
      {"400", "nonsense\r\n\r\n"},
      {"400", "GET / HTTP/9.9\r\nHost: localhost\r\n\r\n"},
      {"400", "GET  / HTTP/1.1\r\n\r\n"},
      {"400", "GET / HTTP/1.1\nHost: localhost\n\n"},
      {"400", head + "no colon\r\n\r\n"},
      {"400", head + std::string("a: b\0c\r\n\r\n", 10)},
      {"400", head + "Content-Length: x\r\n\r\n"},
      {"400", head + "Content-Length: 1\r\nContent-Length: 2\r\n\r\n"},
      {"400", head + "Content-Length: 99999999999999999999999\r\n\r\n"},
      {"400", head + "Transfer-Encoding: chunked\r\n\r\nZZ\r\n"},
      {"400", std::string("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 11)},  // TLS
      {"413", head + "Content-Length: 2000\r\n\r\n" + std::string(2000, 'a')},
      {"413", head + "Content-Length: 18446744073709551615\r\n\r\n"},
      {"413", head + "Transfer-Encoding: chunked\r\n\r\nFFFFFFF\r\n"},
      {"431", head + "A: " + std::string(9000, 'a') + "\r\n\r\n"},
      {"431", "GET /" + std::string(100'000, 'a')},
  };
  for (const auto& [status, bytes] : cases) {
    const std::string answer = say(bytes);
    EXPECT_EQ(answer.substr(0, 13), std::string("HTTP/1.1 ") + status + " ")
        << bytes.substr(0, 80) << "\n"
        << answer;
    EXPECT_NE(answer.find("Connection: close"), std::string::npos);
  }
  EXPECT_EQ(get("/").result(), http::status::ok) << "and goes on";
}

TEST_F(HttpSession, EndsAConnectionWhoseRequestComesTooSlowly) {
  start("127.0.0.1", std::chrono::milliseconds(300));
  tcp::socket slow = connect();
  error_code wrong;
  int sent = 0;
  for (; sent < 500 && !wrong; ++sent) {  // a byte each 10 ms: never silent, never done
    boost::asio::write(slow, boost::asio::buffer("a", 1), wrong);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_TRUE(wrong) << "still open after " << sent << " bytes";
}

TEST_F(HttpSession, EndsAConnectionThatSaysNothing) {
  start("127.0.0.1", std::chrono::milliseconds(300));
  EXPECT_EQ(say(""), "");
}

TEST_F(HttpSession, TurnsTheSixtyFifthPageAwayWithTheReason) {
  start();
  start_source();
  std::list<Socket> pages;
  for (int i = 0; i < 64; ++i)
    ASSERT_FALSE(open_live(pages.emplace_back(client_io_), "http://localhost:1"));
  for (int i = 0; i < 3; ++i) {
    const auto answer = get("/session");
    EXPECT_EQ(answer.result(), http::status::service_unavailable);
    EXPECT_EQ(answer.body().substr(0, 5), "503: ");
  }
  EXPECT_EQ(get("/").result(), http::status::ok) << "the page itself is public";
  EXPECT_TRUE(wait_until([this] {
    return warnings_.size() == 1 && warnings_[0].starts_with("64 pages and downloads are open");
  })) << "reported once";
  pages.pop_back();
  EXPECT_TRUE(wait_until([this] { return view_.listeners() == 63; }));
  EXPECT_EQ(get("/session").result(), http::status::no_content) << "there is room again";
}

TEST_F(HttpSession, AConnectionWithoutTheTokenTakesNoSlot) {
  start();
  start_source();
  Socket page(client_io_);
  ASSERT_FALSE(open_live(page, "http://localhost:1"));
  std::vector<tcp::socket> silent;
  for (int i = 0; i < 200; ++i) {
    silent.push_back(connect());
    if (i % 10 == 0) EXPECT_EQ(get("/session").result(), http::status::no_content) << i;
  }
  EXPECT_EQ(view_.listeners(), 1u) << "who has shown the token stays";
  EXPECT_TRUE(warnings_.empty());
}

// As a proxy that replaces Host, or drops Upgrade: the page asks the reason with its next request.
TEST_F(HttpSession, ARefusedWebSocketIsReportedToPageAndTerminalOnce) {
  start();
  for (int i = 0; i < 3; ++i) {
    Socket socket(client_io_);
    EXPECT_EQ(open_live(socket, "http://proxy:9"), websocket::error::upgrade_declined);
    const auto session = get("/session", "localhost:1", {{"Tact-Origin", "http://proxy:9"}});
    EXPECT_EQ(session.result(), http::status::forbidden);
    EXPECT_NE(session.body().find("Host localhost:1 and Origin http://proxy:9"), std::string::npos);
    EXPECT_EQ(get("/live").result(), http::status::upgrade_required);
  }
  EXPECT_EQ(get("/session", "proxy:9", {{"Tact-Origin", "http://proxy:9"}}).result(),
            http::status::forbidden)
      << "the name of the proxy alone is not enough";
  EXPECT_EQ(get("/session", "localhost:1", {{"Tact-Origin", "http://localhost:1"}}).result(),
            http::status::no_content);
  EXPECT_TRUE(wait_until([this] { return warnings_.size() == 3; })) << warnings_.size();
}

TEST_F(HttpSession, ProblemReportedByAPageIsPrintedOnce) {
  start();
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(get("/session", "localhost", {{"Tact-Trouble", "no WebGL"}}).result(),
              http::status::no_content);
  bearer_ = "";
  get("/session", "localhost", {{"Tact-Trouble", "of a stranger"}});
  EXPECT_TRUE(wait_until([this] {
    return warnings_ == std::vector<std::string>{"a page reports: no WebGL"};
  })) << (warnings_.empty() ? "" : warnings_[0]);
}

TEST(LiveView, SharesItsFramesAndMeshesWithAllDownloads) {
  host::server::LiveView view;
  view.begin(make_header(3, 1, 3, 1), TinyMeshes{}.bytes(), host::server::Link::kLive);
  Frame frame;
  for (frame.tick = 1; frame.tick <= 9; ++frame.tick) view.add(frame);
  const auto early = view.recent(0, UINT64_MAX);
  for (; frame.tick <= 20; ++frame.tick) view.add(frame);
  const auto late = view.recent(5, 12);
  ASSERT_EQ(early.frames.size(), 9u);
  ASSERT_EQ(late.frames.size(), 8u);
  EXPECT_EQ(early.frames[4], late.frames[0]) << "one frame, however many want it";
  EXPECT_EQ(early.mesh, late.mesh);
  EXPECT_EQ(late.frames.back()->frame.tick, 12u);
}

}  // namespace tact::test::http_session_test
