// SPDX-License-Identifier: Apache-2.0
#include "host/server/http_session.h"

#include <fmt/format.h>

#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <charconv>
#include <chrono>

#include "host/server/download.h"
#include "host/server/frame_json.h"
#include "model/io/one_line.h"

namespace tact::host::server {
namespace {

namespace beast = boost::beast;
namespace http = boost::beast::http;
using beast::error_code;

// Chosen: browsers send some hundred bytes, and no request needs a body.
constexpr std::uint32_t kMaxHeaderBytes = 8192;
constexpr std::uint64_t kMaxBodyBytes = 1024;
// After an error, incoming data is discarded up to these limits, then the connection is dropped.
constexpr std::chrono::seconds kFarewell{2};
constexpr std::size_t kMaxDrained_bytes = 1 << 20;

std::string_view view_of(beast::string_view text) { return {text.data(), text.size()}; }

template <typename Message>
void set_common(Message& message) {
  message.set(http::field::server, "tact-view");
  // No cache: tactd may have started another scene meanwhile.
  message.set(http::field::cache_control, "no-store");
  message.set("X-Content-Type-Options", "nosniff");
  message.set("Referrer-Policy", "no-referrer");
  message.set("Cross-Origin-Resource-Policy", "same-origin");
  // No foreign sources and no framing, so a foreign page cannot inject a script.
  message.set("Content-Security-Policy",
              "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; "
              "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
}

HttpSession::Response make(http::status status, const char* mime, std::string body) {
  HttpSession::Response response{status, 11};
  response.set(http::field::content_type, mime);
  response.body() = std::move(body);
  return response;
}

HttpSession::Response sorry(http::status status, const char* message) {
  return make(status, "text/plain; charset=utf-8", std::string(message) + "\n");
}

std::uint64_t tick_value(std::string_view query, std::string_view key, std::uint64_t otherwise) {
  const std::string_view text = query_value(query, key);
  std::uint64_t tick = 0;
  const auto [end, wrong] = std::from_chars(text.data(), text.data() + text.size(), tick);
  return wrong == std::errc() && end == text.data() + text.size() ? tick : otherwise;
}

std::string bytes_of(const record::MeshBytes& mesh) {
  return {reinterpret_cast<const char*>(mesh.data()), mesh.size()};
}

}  // namespace

HttpSession::HttpSession(beast::tcp_stream stream, Site& site)
    : stream_(std::move(stream)), site_(site) {}

void HttpSession::read_next() {
  // A parser reads one message, so a new one with its limits is needed.
  parser_.emplace();
  parser_->header_limit(kMaxHeaderBytes);
  parser_->body_limit(kMaxBodyBytes);
  stream_.expires_after(site_.request_timeout);
  http::async_read(stream_, in_, *parser_,
                   [self = shared_from_this()](error_code wrong, std::size_t) {
                     if (wrong) return self->refuse(wrong);
                     self->handle(self->parser_->get());
                   });
}

/// A peer that left or was too slow gets no answer.
void HttpSession::refuse(error_code wrong) {
  const bool is_http = wrong.category() == make_error_code(http::error::bad_method).category();
  // The connection ended or timed out: no peer would read an answer.
  if (!is_http || wrong == http::error::end_of_stream || wrong == http::error::partial_message)
    return;
  if (wrong == http::error::header_limit) {
    response_ = sorry(http::status::request_header_fields_too_large,
                      "431: the header of this request is too large");
  } else if (wrong == http::error::body_limit) {
    response_ = sorry(http::status::payload_too_large, "413: nothing is taken in here");
  } else {
    response_ = sorry(http::status::bad_request, "400: this is no HTTP request");
  }
  set_common(response_);
  response_.keep_alive(false);
  response_.prepare_payload();
  send();
}

void HttpSession::handle(const Request& request) {
  const std::string_view target = view_of(request.target());
  const std::size_t mark = target.find('?');
  const std::string_view path = target.substr(0, mark);
  const std::string_view query =
      mark == std::string_view::npos ? std::string_view() : target.substr(mark + 1);
  // Host before token: a page under a foreign name learns nothing.
  if (!site_.access.host_allowed(view_of(request[http::field::host])))
    return turn_away(http::status::forbidden,
                     "403: open this page by its address, not by another name", request);
  // The page's own files are public: they are in the repository.
  const bool is_public = site_.page.find(path) != nullptr;
  if (!is_public &&
      !site_.access.token_allowed(view_of(request[http::field::authorization]),
                                  view_of(request[http::field::sec_websocket_protocol]))) {
    Response response = sorry(http::status::unauthorized,
                              "401: the token is missing or wrong; open the whole link that "
                              "tact-view printed");
    response.set(http::field::www_authenticate, "Bearer");
    return write(std::move(response), request);
  }
  if (!is_public && !has_slot()) slot_ = site_.take_slot();
  if (!is_public && !has_slot())
    return write(sorry(http::status::service_unavailable,
                       "503: too many pages and downloads are open; close some now"),
                 request);
  if (path == "/live") return upgrade(request);
  const std::string_view origin = view_of(request["Tact-Origin"]);
  if (!origin.empty() && !from_own_page(request, origin)) return;
  if (request.method() == http::verb::get && site_.view.has_scene() &&
      (path == "/recording.csv" || path == "/recording.tactview")) {
    return download(request, path, query);
  }
  write(answer(request, path), request);
}

/// Any page can open a WebSocket to this server; the Origin identifies it. A browser sends none
/// with an ordinary request of its own site, so the page names it as "Tact-Origin". False: refused.
bool HttpSession::from_own_page(const Request& request, std::string_view origin) {
  const std::string_view host = view_of(request[http::field::host]);
  if (origin_matches(origin, host)) return true;
  turn_away(http::status::forbidden,
            fmt::format("403: this WebSocket is for tact's own page only: the request came with "
                        "Host {} and Origin {}; a proxy must pass the Host header on (nginx: "
                        "proxy_set_header Host $http_host)",
                        model::io::on_one_line(host), model::io::on_one_line(origin)),
            request);
  return false;
}

/// The reason also goes to the terminal: a page does not see why its WebSocket was refused.
void HttpSession::turn_away(http::status status, const std::string& reason,
                            const Request& request) {
  site_.warn_once(reason);
  write(sorry(status, reason.c_str()), request);
}

void HttpSession::upgrade(const Request& request) {
  if (!beast::websocket::is_upgrade(request))
    return turn_away(http::status::upgrade_required,
                     "426: a request for the WebSocket came without its Upgrade header; a proxy "
                     "must pass it on (nginx: proxy_http_version 1.1, proxy_set_header Upgrade "
                     "$http_upgrade, proxy_set_header Connection upgrade)",
                     request);
  if (!from_own_page(request, view_of(request[http::field::origin]))) return;
  std::make_shared<LiveSession>(std::move(stream_), std::move(slot_), site_.view, site_.move_hand,
                                site_.steer, site_.ask_scene, site_.take_digit)
      ->start(request);
}

void HttpSession::download(const Request& request, std::string_view path, std::string_view query) {
  const DownloadKind kind =
      path == "/recording.csv" ? DownloadKind::kCsv : DownloadKind::kRecording;
  Download::Header header{http::status::ok, request.version()};
  set_common(header);
  header.set(http::field::content_type,
             kind == DownloadKind::kCsv ? "text/csv; charset=utf-8" : "application/octet-stream");
  header.set(http::field::content_disposition, "attachment");  // the page sets the file name
  header.keep_alive(false);
  header.chunked(true);
  record::Snapshot snapshot = site_.view.recent(tick_value(query, "from_tick", 0),
                                                tick_value(query, "to_tick", UINT64_MAX));
  std::make_shared<Download>(std::move(stream_), std::move(slot_), std::move(snapshot), kind)
      ->start(std::move(header));
}

HttpSession::Response HttpSession::answer(const Request& request, std::string_view path) const {
  if (request.method() != http::verb::get && request.method() != http::verb::head)
    return sorry(http::status::method_not_allowed, "405: this server can only be read");
  if (path == "/session") {
    const std::string_view trouble = view_of(request["Tact-Trouble"]);
    if (!trouble.empty()) site_.warn_once("a page reports: " + model::io::on_one_line(trouble));
    return Response{http::status::no_content, 11};
  }
  const bool from_tactd = path == "/scene.json" || path == "/mesh.bin" ||
                          path == "/recording.csv" || path == "/recording.tactview";
  if (from_tactd && !site_.view.has_scene())
    return sorry(http::status::service_unavailable, "503: waiting for tactd");
  if (path == "/scene.json")
    return make(http::status::ok, "application/json", scene_json(site_.view.header()));
  if (path == "/mesh.bin")
    return make(http::status::ok, "application/octet-stream", bytes_of(*site_.view.mesh()));
  if (path == "/scenes.json" && !site_.scenes.empty())
    return make(http::status::ok, "application/json", site_.scenes);
  const PageFile* file = site_.page.find(path);
  if (file == nullptr) return sorry(http::status::not_found, "404: there is no such page");
  return make(http::status::ok, file->mime.c_str(), file->content);
}

void HttpSession::write(Response response, const Request& request) {
  response_ = std::move(response);
  set_common(response_);
  response_.version(request.version());
  response_.keep_alive(request.keep_alive());
  // HEAD: the length of the GET response, without its body.
  if (request.method() == http::verb::head) {
    const std::size_t length = response_.body().size();
    response_.body().clear();
    response_.content_length(length);
  } else {
    response_.prepare_payload();
  }
  send();
}

void HttpSession::send() {
  stream_.expires_after(kTimeout);
  http::async_write(stream_, response_, [self = shared_from_this()](error_code wrong, std::size_t) {
    if (wrong) return;
    self->response_.keep_alive() ? self->read_next() : self->leave();
  });
}

/// Reads pending data first: closing a socket with unread data would discard the response.
void HttpSession::leave() {
  error_code ignored;
  stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
  stream_.expires_after(kFarewell);
  drain();
}

void HttpSession::drain() {
  in_.clear();
  stream_.async_read_some(in_.prepare(4096),
                          [self = shared_from_this()](error_code wrong, std::size_t bytes) {
                            self->drained_bytes_ += bytes;
                            if (!wrong && self->drained_bytes_ < kMaxDrained_bytes) self->drain();
                          });
}

}  // namespace tact::host::server
