// SPDX-License-Identifier: Apache-2.0
// access.h - access control: decisions on the text of one HTTP request, nothing else.
//
// The page's own files are public. Data needs the random token printed at the start, on loopback,
// too, because other users of this PC reach its loopback address. The token is in the link's
// fragment, which no browser sends. The page keeps it for its tab and shows it with each request; a
// cookie would go to every port of this PC, so to servers of other users. On loopback the Host must
// also be a loopback name, which refuses a foreign page whose name resolves to 127.0.0.1.
// WebSockets also need an Origin equal to the Host, which a foreign page cannot forge.
#pragma once

#include <string>
#include <string_view>

#include "model/result.h"

namespace tact::host::server {

struct Access {
  bool loopback = true;
  std::string bind_address;  // as in a URL
  std::string public_url{};  // of a proxy in front, "https://name:port"; empty: none
  std::string token;

  bool host_allowed(std::string_view host) const;
  /// By the header Authorization, "Bearer TOKEN", or, of a browser's WebSocket, by the header
  /// Sec-WebSocket-Protocol, "tact, token.TOKEN".
  bool token_allowed(std::string_view authorization, std::string_view protocols) const;
};

/// What a WebSocket that showed its token so is answered: a browser wants one of its protocols.
inline constexpr std::string_view kProtocol = "tact";

/// "name:port" of "http://name:port/" or "https://name:port/"; empty for any other URL, also one
/// with a path, because the page and its WebSocket must be at the root of their server.
std::string_view authority_of(std::string_view url);

/// "http://name:port" or "https://name:port" against "name:port".
bool origin_matches(std::string_view origin, std::string_view host);

/// Value of a key in "a=1&b=2", empty if absent.
std::string_view query_value(std::string_view query, std::string_view key);

/// 32 hex digits from the kernel's random numbers; an error if it gives none.
model::Result<std::string> make_token();

}  // namespace tact::host::server
