# Run by every build: writes OUT anew only where the version has changed. The version of a build is its commit where
# there is one. cmake -DSOURCE=tree -DVERSION=0.1.0 -DTEMPLATE=version.cpp.in -DOUT=version.cpp -P version.cmake
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12
  RESULT_VARIABLE failed OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
set(WAVERIG_VERSION ${VERSION})
if(NOT failed AND commit)
  string(APPEND WAVERIG_VERSION "+${commit}")
endif()
configure_file(${TEMPLATE} ${OUT} @ONLY)
