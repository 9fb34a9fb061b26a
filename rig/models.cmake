# The simulated rig from shaft to frames, and the acquisition from frames to samples.
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)

file(READ ${CMAKE_CURRENT_LIST_DIR}/frontend/default_frame.toml WAVERIG_DEFAULT_FRAME)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/frontend/default_frame.toml)
configure_file(${CMAKE_CURRENT_LIST_DIR}/frontend/default_frame_text.h.in
  ${CMAKE_CURRENT_BINARY_DIR}/generated/rig/frontend/default_frame_text.h @ONLY)

if(NOT TARGET waverig::rig_settings)
  waverig_library(rig_settings SOURCES settings/toml_reader.cpp LINK waverig::lcmtypes PRIVATE_LINK fmt::fmt)
endif()

waverig_library(rig_models
  SOURCES
    mechanism/rotating_arm.cpp
    sensors/accelerometer.cpp sensors/gyroscope.cpp sensors/magnetometer.cpp
    frontend/crc.cpp frontend/frame_codec.cpp frontend/frame_layout.cpp frontend/simulated_unit.cpp
    acquisition/acquisition.cpp acquisition/calibration_report.cpp acquisition/calibration_run.cpp
    acquisition/compass_report.cpp acquisition/compass_run.cpp
    acquisition/serial_port.cpp
  LINK waverig::kinematics waverig::calibration
  PRIVATE_LINK waverig::rig_settings fmt::fmt nlohmann_json::nlohmann_json)
target_include_directories(waverig_rig_models PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/generated)
