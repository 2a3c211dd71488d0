# What the sources are called: the version from the newest tag v1.2.3, the commit, and whether the tree was changed.
#   include(version.cmake); read_version(SOURCE FALLBACK)    sets GRAINSWEEP_VERSION and GRAINSWEEP_COMMIT
#   cmake -D SOURCE=... -D FALLBACK=... -D HEADER=... -P version.cmake
#                                              writes both into a header, at build time and only when they change
# A tagged commit is 1.2.3, the fifth after it 1.2.3+5. Without git or tags: FALLBACK, commit "unknown" where git is missing.
function(read_version source fallback)
  execute_process(COMMAND git -C "${source}" rev-parse --short=12 HEAD
    OUTPUT_VARIABLE commit ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed)
  set(version "${fallback}")
  if(failed)
    set(commit "unknown")
  else()
    execute_process(COMMAND git -C "${source}" status --porcelain --untracked-files=no
      OUTPUT_VARIABLE changes ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
    if(changes)
      string(APPEND commit "-modified")
    endif()
    execute_process(COMMAND git -C "${source}" describe --tags --long --match "v[0-9]*"
      OUTPUT_VARIABLE tag ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
    if(tag MATCHES "^v([0-9][0-9A-Za-z.]*)-([0-9]+)-g")
      set(version "${CMAKE_MATCH_1}")
      if(NOT CMAKE_MATCH_2 EQUAL 0)
        string(APPEND version "+${CMAKE_MATCH_2}")
      endif()
    endif()
  endif()
  set(GRAINSWEEP_VERSION "${version}" PARENT_SCOPE)
  set(GRAINSWEEP_COMMIT "${commit}" PARENT_SCOPE)
endfunction()

if(CMAKE_SCRIPT_MODE_FILE)
  read_version("${SOURCE}" "${FALLBACK}")
  set(text "#pragma once\n#define GRAINSWEEP_VERSION \"${GRAINSWEEP_VERSION}\"\n")
  string(APPEND text "#define GRAINSWEEP_COMMIT \"${GRAINSWEEP_COMMIT}\"\n")
  if(EXISTS "${HEADER}")
    file(READ "${HEADER}" old)
  endif()
  if(NOT "${text}" STREQUAL "${old}")
    file(WRITE "${HEADER}" "${text}")
  endif()
endif()
