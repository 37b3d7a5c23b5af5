// SPDX-License-Identifier: Apache-2.0
// stub_library.h - a stand-in for a vendor SDK, loaded by a test that steers it.
#pragma once

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

namespace tact::tests {

/// Loads the stand-in once more (it is the same one) and finds its control functions.
class StubLibrary {
 public:
  explicit StubLibrary(const std::string& path)
      : handle_(dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL)) {
    if (handle_ == nullptr) {
      ADD_FAILURE() << dlerror();
      std::abort();
    }
  }
  ~StubLibrary() { dlclose(handle_); }
  StubLibrary(const StubLibrary&) = delete;
  StubLibrary& operator=(const StubLibrary&) = delete;

 protected:
  template <typename Function>
  void find(const char* symbol, Function& function) {
    function = reinterpret_cast<Function>(dlsym(handle_, symbol));
    ASSERT_NE(function, nullptr) << symbol;
  }

 private:
  void* handle_;
};

}  // namespace tact::tests
