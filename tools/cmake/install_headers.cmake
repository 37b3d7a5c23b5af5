# SPDX-License-Identifier: Apache-2.0
# Run by cmake --install: the `headers` of the tree `source`, and what they include of it, below the folder `include`
# of the prefix.
cmake_minimum_required(VERSION 3.25)
set(installed)
while(headers)
  list(POP_FRONT headers header)
  if(header IN_LIST installed)
    continue()
  endif()
  list(APPEND installed ${header})
  cmake_path(GET header PARENT_PATH folder)
  file(INSTALL ${source}/${header} DESTINATION ${CMAKE_INSTALL_PREFIX}/${include}/${folder})
  file(STRINGS ${source}/${header} lines REGEX "^#include \"")
  list(TRANSFORM lines REPLACE "^#include \"([^\"]*)\".*" "\\1")
  list(APPEND headers ${lines})
endwhile()
