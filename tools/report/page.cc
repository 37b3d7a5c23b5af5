// SPDX-License-Identifier: Apache-2.0
#include "tools/report/page.h"

#include <fmt/format.h>

#include <kainjow/mustache.hpp>
#include <nlohmann/json.hpp>

#include "tools/report/page.css.h"

namespace tact::tools::report {
namespace {

namespace mustache = kainjow::mustache;

constexpr const char* kMark =
    "{{#holds}}<span class=ok>pass</span>{{/holds}}{{^holds}}<span class=bad>FAIL</span>{{/holds}}";

mustache::data to_mustache(const nlohmann::json& j) {
  if (j.is_object()) {
    mustache::data object(mustache::data::type::object);
    for (const auto& [name, value] : j.items()) object.set(name, to_mustache(value));
    return object;
  }
  if (j.is_array()) {
    mustache::data list(mustache::data::type::list);
    for (const auto& value : j) list.push_back(to_mustache(value));
    return list;
  }
  if (j.is_string() && !j.empty() && !j.get_ref<const std::string&>().empty())
    return j.get<std::string>();
  return j.is_boolean() && j.get<bool>();
}

}  // namespace

std::string render_page(const char* text, const nlohmann::json& data) {
  mustache::data all = to_mustache(data);
  all.set("style", std::string(kText));
  all.set("mark", mustache::data{mustache::partial([] { return kMark; })});
  return mustache::mustache(text).render(all);
}

std::string inline_svg(const std::string& svg, std::size_t number) {
  const std::size_t begin = svg.find("<svg");
  std::string out = begin == std::string::npos ? std::string() : svg.substr(begin);
  const std::string own = fmt::format("d{}_", number);
  for (const std::string name : {"id=\"", "id='", "href='#", "href=\"#", "url(#"})
    for (std::size_t at = out.find(name); at != std::string::npos;
         at = out.find(name, at + name.size() + own.size()))
      out.insert(at + name.size(), own);
  return out;
}

}  // namespace tact::tools::report
