// SPDX-License-Identifier: Apache-2.0
// page.h - one HTML file from a template and its data: nothing loaded from elsewhere, no script.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace tact::tools::report {

/// `text`: Mustache (https://mustache.github.io/mustache.5.html). It may use {{{style}}}, and
/// {{>mark}} where the data has `holds`. Values are strings, truth, lists and objects; what is
/// empty counts as false. Values are escaped where the template does not say otherwise.
std::string render_page(const char* text, const nlohmann::json& data);

/// A drawing without its XML head, to stand within a page; its ids made its own by the number.
std::string inline_svg(const std::string& svg, std::size_t number);

}  // namespace tact::tools::report
