// FrameLayout: what a telemetry frame looks like, from a layout file (TOML); rig/frontend/default_frame.toml
// shows every key. Frames have a fixed length: sync bytes, fields anywhere, a counter, a CRC, terminator
// bytes if wanted.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rig/frontend/crc.h"

namespace waverig::rig {

enum class FieldType { kUnsigned, kSigned, kFloat };  // float: IEEE 754 of 32 or 64 bits
enum class ByteOrder { kBig, kLittle };

struct NamedLimits {
  std::string name;  // e.g. "warning", "alarm"
  double low = 0, high = 0;
};

struct CalibrationPoint {
  double raw = 0, value = 0;
};

struct FrameField {
  std::string name;
  FieldType type = FieldType::kUnsigned;
  // Big: counted from the most significant bit of the frame's first byte; little: from the least significant
  // one.
  int bit_offset = 0;
  int bits = 16;  // all within eight bytes
  ByteOrder order = ByteOrder::kBig;
  std::string unit{};                        // of value()
  std::vector<double> polynomial{};          // value = sum c_i raw^i; empty: the raw number
  std::vector<CalibrationPoint> segments{};  // or straight lines between points, raw ascending
  std::vector<NamedLimits> limits{};

  double value(std::int64_t raw) const;  // in unit; raw as the decoder gives it
};

struct CrcPlacement {
  CrcParameters parameters;
  int first_byte = 0, last_byte = 0;  // what it covers, both inclusive
  int byte_offset = 0;                // where it stands
  ByteOrder order = ByteOrder::kBig;
};

struct FrameLayout {
  std::string name;
  int length_bytes = 0;
  std::vector<std::uint8_t> sync, terminator;
  std::vector<FrameField> fields;
  std::string counter;  // name of the field that grows by one a frame; empty: none
  std::optional<CrcPlacement> crc;

  // Index of a field; throws UserError where the layout has none of that name.
  std::size_t index_of(std::string_view field) const;
};

// Throws UserError, naming file, line and key, for anything that does not fit together.
FrameLayout load_frame_layout(const std::filesystem::path& path);
FrameLayout parse_frame_layout(std::string_view toml, const std::string& name);

// rig/frontend/default_frame.toml, compiled in: the frame of the simulated unit.
const FrameLayout& default_frame_layout();

}  // namespace waverig::rig
