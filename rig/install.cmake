# What cmake --install gives: the program, and for find_package(waverig) the libraries without simulator and pictures.
install(TARGETS waverig RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
set_target_properties(waverig_messages PROPERTIES EXPORT_NAME messages)
install(TARGETS waverig_messages waverig_lcmtypes waverig_kinematics waverig_motion waverig_calibration waverig_compass
    waverig_estimator waverig_evaluation
  EXPORT waverig-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/lcmtypes ${PROJECT_SOURCE_DIR}/motion ${PROJECT_SOURCE_DIR}/estimator
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/waverig FILES_MATCHING PATTERN *.h PATTERN *.lcm)
install(DIRECTORY ${PROJECT_BINARY_DIR}/lcmtypes/generated/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/waverig/generated)
install(DIRECTORY ${CMAKE_CURRENT_LIST_DIR}/campaigns ${CMAKE_CURRENT_LIST_DIR}/sequences
  DESTINATION ${CMAKE_INSTALL_DATADIR}/waverig)

include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/waverig)
install(EXPORT waverig-targets NAMESPACE waverig:: DESTINATION ${package_dir})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/waverig-config.cmake.in
  ${CMAKE_CURRENT_BINARY_DIR}/waverig-config.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/waverig-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/waverig-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/waverig-config-version.cmake
  DESTINATION ${package_dir})
