# SPDX-License-Identifier: Apache-2.0
# find_package(tact): the target tact::controller, and the Debian packages libfmt-dev, libssl-dev and
# libtomlplusplus-dev that it links.
include(CMakeFindDependencyMacro)
find_dependency(fmt)
find_dependency(OpenSSL)
find_dependency(tomlplusplus)
include(${CMAKE_CURRENT_LIST_DIR}/tactTargets.cmake)
