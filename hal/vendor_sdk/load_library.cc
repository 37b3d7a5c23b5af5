// SPDX-License-Identifier: Apache-2.0
#include "hal/vendor_sdk/load_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include "hal/vendor_sdk/library_trust.h"

namespace tact::hal::vendor_sdk {

using model::Error;
using model::Result;

void* LoadedLibrary::address_of(const char* symbol) const { return dlsym(handle_, symbol); }

std::optional<Error> LoadedLibrary::lacks() {
  if (missing_ == nullptr) return std::nullopt;
  dlclose(handle_);
  return Error{fmt::format(
      "{} has no function {}, so it is not {} library or too old a one; let {} name {} of a "
      "current SDK",
      name_, missing_, of_.whose, of_.setting, of_.file)};
}

Result<LoadedLibrary> load_library(const std::string& name, bool trusted, const VendorSdk& of) {
  const auto not_loaded = [&](const std::string& why) {
    return Error{fmt::format(
        "{} library cannot be loaded: {}; it belongs to its vendor and is no part of tact: get {}, "
        "and let {} name its {} by path",
        of.whose, why, of.source, of.setting, of.file)};
  };
  const auto file = trusted ? Result<std::string>(name) : find_library(name);
  if (!file) return not_loaded(file.error().message);
  const std::string remedy = fmt::format(
      "let root install it (sudo install -D -o root -m 644 {0} {1}/{0}) and {2} name that, or say "
      "--trust-library if you know the file",
      of.file, of.folder, of.setting);
  if (!trusted)
    if (const auto refused = distrust_library(*file, remedy)) return *refused;
  // NOW: no symbol is looked up in the loop. LOCAL: its names do not reach our other libraries.
  void* library = dlopen(file->c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    const char* why = dlerror();
    return not_loaded(why == nullptr ? name : why);
  }
  return LoadedLibrary(library, name, of);
}

}  // namespace tact::hal::vendor_sdk
