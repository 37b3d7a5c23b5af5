# SPDX-License-Identifier: Apache-2.0
# An older Debian than those of tools/releases is refused with a sentence; another Linux is not
# evaluated. cmake -DTACT_OS_RELEASE=FILE -P tools/cmake/release.cmake evaluates FILE.
if(NOT TACT_OS_RELEASE)
  set(TACT_OS_RELEASE /etc/os-release)
endif()
file(STRINGS ${CMAKE_CURRENT_LIST_DIR}/../releases releases REGEX "^[0-9]")
list(TRANSFORM releases REPLACE " .*" "")
list(GET releases 0 oldest)
list(JOIN releases " or " releases)
if(EXISTS ${TACT_OS_RELEASE})
  file(STRINGS ${TACT_OS_RELEASE} os REGEX "^(ID|VERSION_ID)=")
  if(";${os};" MATCHES ";ID=debian;" AND "${os}" MATCHES "VERSION_ID=\"?([0-9]+)" AND CMAKE_MATCH_1 VERSION_LESS oldest)
    message(FATAL_ERROR "This is Debian ${CMAKE_MATCH_1}; tact needs Debian ${releases}. Upgrade it, or build in a container: debian:${oldest}")
  endif()
endif()
