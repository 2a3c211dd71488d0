# Writes the commit of the source tree into a header, at build time and only when it changes.
#   cmake -D SOURCE=... -D HEADER=... -P commit.cmake
execute_process(COMMAND git -C "${SOURCE}" rev-parse --short=12 HEAD
  OUTPUT_VARIABLE commit ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed)
if(failed)
  set(commit "unknown")
else()
  execute_process(COMMAND git -C "${SOURCE}" status --porcelain --untracked-files=no
    OUTPUT_VARIABLE changes ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(changes)
    string(APPEND commit "-modified")
  endif()
endif()
set(text "#pragma once\n#define GRAINSWEEP_COMMIT \"${commit}\"\n")
if(EXISTS "${HEADER}")
  file(READ "${HEADER}" old)
endif()
if(NOT "${text}" STREQUAL "${old}")
  file(WRITE "${HEADER}" "${text}")
endif()
