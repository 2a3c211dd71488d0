# Copies the libraries of the installed program in STAGE to lib/grainsweep: cmake -D STAGE=FOLDER -P libraries.cmake
# The C library and the loader stay the system's: they must fit its kernel and its name services.
set(folder "${STAGE}/lib/grainsweep")
file(GET_RUNTIME_DEPENDENCIES
  EXECUTABLES "${STAGE}/bin/grainsweep"
  MODULES "${folder}/grainsweep_media.so"
  PRE_EXCLUDE_REGEXES "^ld-linux" "^lib(c|m|dl|rt|pthread|resolv|util|anl)\\.so"
  RESOLVED_DEPENDENCIES_VAR libraries
  UNRESOLVED_DEPENDENCIES_VAR missing)
if(missing)
  message(FATAL_ERROR "libraries are missing: ${missing}")
endif()
foreach(library ${libraries})
  file(COPY "${library}" DESTINATION "${folder}" FOLLOW_SYMLINK_CHAIN)
endforeach()
