// SPDX-License-Identifier: Apache-2.0
#include "host/server/access.h"

#include <fmt/format.h>
#include <openssl/crypto.h>
#include <sys/random.h>

#include <algorithm>
#include <array>

namespace tact::host::server {
namespace {

/// "name:port" without the port; an IPv6 address keeps its brackets.
std::string_view name_of(std::string_view host) {
  const std::size_t colon = host.rfind(':');
  const std::size_t bracket = host.rfind(']');
  const bool has_port =
      colon != std::string_view::npos && (bracket == std::string_view::npos || colon > bracket);
  return has_port ? host.substr(0, colon) : host;
}

/// The part after "http://" or "https://"; empty for any other URL.
std::string_view behind_scheme(std::string_view url) {
  for (const std::string_view scheme : {"http://", "https://"})
    if (url.starts_with(scheme)) return url.substr(scheme.size());
  return {};
}

/// Constant time: independent of the position of the first difference.
bool same_secret(std::string_view a, std::string_view b) {
  return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

}  // namespace

bool Access::host_allowed(std::string_view host) const {
  // On other addresses DNS rebinding is harmless: a foreign page still lacks the token.
  if (!loopback) return !host.empty();  // the token decides
  const std::string_view name = name_of(host);
  return name == "localhost" || name == "127.0.0.1" || name == "[::1]" || name == bind_address ||
         (!public_url.empty() && name == name_of(authority_of(public_url)));
}

bool Access::token_allowed(std::string_view authorization, std::string_view protocols) const {
  // An unset token would match an empty header.
  if (token.empty()) return false;
  constexpr std::string_view kScheme = "Bearer ";
  if (authorization.starts_with(kScheme) &&
      same_secret(authorization.substr(kScheme.size()), token))
    return true;
  constexpr std::string_view kToken = "token.";
  for (std::string_view rest = protocols; !rest.empty();) {
    const std::size_t end = std::min(rest.find(','), rest.size());
    std::string_view item = rest.substr(0, end);
    while (item.starts_with(' ')) item.remove_prefix(1);
    if (item.starts_with(kToken) && same_secret(item.substr(kToken.size()), token)) return true;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return false;
}

std::string_view authority_of(std::string_view url) {
  const std::string_view rest = behind_scheme(url);
  const std::string_view authority = rest.substr(0, rest.find('/'));
  // A path would break the page's own links, which are absolute.
  const bool is_whole = rest.size() - authority.size() <= 1;
  return is_whole && authority.find_first_of("?#@ ") == std::string_view::npos ? authority : "";
}

bool origin_matches(std::string_view origin, std::string_view host) {
  return !host.empty() && behind_scheme(origin) == host;
}

std::string_view query_value(std::string_view query, std::string_view key) {
  while (!query.empty()) {
    const std::size_t end = std::min(query.find('&'), query.size());
    const std::string_view item = query.substr(0, end);
    if (item.size() > key.size() && item.starts_with(key) && item[key.size()] == '=')
      return item.substr(key.size() + 1);
    query.remove_prefix(std::min(end + 1, query.size()));
  }
  return {};
}

model::Result<std::string> make_token() {
  std::array<unsigned char, 16> bytes{};
  // Not std::random_device, whose source is unspecified; the token must be unpredictable.
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    return model::Error{"the kernel gives no random numbers for the token"};
  std::string out;
  for (const unsigned byte : bytes) out += fmt::format("{:02x}", byte);
  return out;
}

}  // namespace tact::host::server
