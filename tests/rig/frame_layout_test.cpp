#include "rig/frontend/frame_layout.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>

#include "lcmtypes/error.h"

namespace waverig::rig {
namespace {

const std::string kSmall = R"(name = "small"
length_bytes = 12
sync = [0xAA, 0x55]
terminator = [0x0D]
counter = "n"
[crc]
width = 8
poly = 0x07
init = 0
refin = false
refout = false
xorout = 0
check = 0xF4
first_byte = 2
last_byte = 9
byte_offset = 10
[[field]]
name = "n"
type = "unsigned"
bit_offset = 16
bits = 8
[[field]]
name = "x"
type = "signed"
bit_offset = 29
bits = 11
byte_order = "little"
unit = "V"
segment_raw = [-10, 0, 10]
segment_value = [-1.0, 0.0, 3.0]
limits = [{ name = "alarm", low = -1.0, high = 2.0 }]
[[field]]
name = "y"
type = "float"
bit_offset = 40
bits = 32
polynomial = [1.0, 2.0, 3.0]
)";

std::string complaint(const std::string& from, const std::string& to) {
  std::string text = kSmall;
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  try {
    parse_frame_layout(text, "small.toml");
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

#define EXPECT_COMPLAINT(from, to, expected) \
  EXPECT_NE(complaint(from, to).find(expected), std::string::npos) << complaint(from, to)

TEST(FrameLayout, ReadsEveryKey) {
  const FrameLayout layout = parse_frame_layout(kSmall, "small.toml");
  EXPECT_EQ(layout.length_bytes, 12);
  EXPECT_EQ(layout.terminator, std::vector<std::uint8_t>{0x0D});
  ASSERT_EQ(layout.fields.size(), 3U);
  EXPECT_EQ(layout.fields[1].order, ByteOrder::kLittle);
  EXPECT_EQ(layout.fields[1].unit, "V");
  EXPECT_EQ(layout.fields[1].limits.at(0).high, 2.0);
  EXPECT_EQ(layout.index_of("y"), 2U);
  EXPECT_THROW(layout.index_of("z"), UserError);
}

TEST(FrameLayout, ConvertsRawNumbersByPolynomialAndSegments) {
  const FrameLayout layout = parse_frame_layout(kSmall, "small.toml");
  EXPECT_DOUBLE_EQ(layout.fields[0].value(200), 200);
  EXPECT_DOUBLE_EQ(layout.fields[1].value(-5), -0.5);
  EXPECT_DOUBLE_EQ(layout.fields[1].value(5), 1.5);
  EXPECT_DOUBLE_EQ(layout.fields[1].value(20), 6);  // the last line goes on
  EXPECT_DOUBLE_EQ(layout.fields[2].value(std::bit_cast<std::int32_t>(2.0F)), 1 + 4 + 12);
}

TEST(FrameLayout, NamesFileLineAndKeyOfWhatDoesNotFit) {
  EXPECT_COMPLAINT("poly = 0x07", "poly = 0x08", "small.toml:13: crc.check = 0xF4");
  EXPECT_COMPLAINT("bit_offset = 40", "bit_offset = 80", "expected a field that ends within the frame");
  EXPECT_COMPLAINT("bits = 32", "bits = 24", "expected 32 or 64 bits of a float");
  EXPECT_COMPLAINT("counter = \"n\"", "counter = \"m\"", "small.toml:5: counter");
  EXPECT_COMPLAINT("name = \"y\"", "name = \"x\"", "expected a name that no other field has");
  EXPECT_COMPLAINT("byte_offset = 10", "byte_offset = 9", "outside the bytes that the CRC covers");
  EXPECT_COMPLAINT("unit = \"V\"", "units = \"V\"", "unknown key");
  EXPECT_COMPLAINT("[-10, 0, 10]", "[10, 0, 10]", "ascending");
  EXPECT_COMPLAINT("[0xAA, 0x55]", "[0xAA, 1.5]", "whole numbers from 0 to 255");
  EXPECT_COMPLAINT("length_bytes = 12", "length_bytes = 0", "length_bytes");
  EXPECT_COMPLAINT("bit_offset = 29\nbits = 11", "bit_offset = 17\nbits = 64", "a field within eight bytes");
  EXPECT_COMPLAINT("length_bytes = 12", "length_bytes = 2", "a frame longer than its sync and terminator");
  for (const char* other : {"x", "y"})
    EXPECT_COMPLAINT("counter = \"n\"", fmt::format("counter = \"{}\"", other),
                     "an unsigned field of 4 to 32 bits");
  EXPECT_COMPLAINT("bits = 8\n", "bits = 3\n", "an unsigned field of 4 to 32 bits");
  EXPECT_COMPLAINT("byte_offset = 10", "byte_offset = 12", "byte_offset");
  EXPECT_COMPLAINT("width = 8", "width = 12", "whole bytes");
  EXPECT_COMPLAINT("sync = [0xAA, 0x55]\n", "", "at least one byte");
  EXPECT_COMPLAINT("type = \"float\"", "type = \"double\"", "expected one of");
}

TEST(FrameLayout, DefaultIsTheFileThatShips) {
  const FrameLayout shipped = load_frame_layout(WAVERIG_SOURCE_DIR "/rig/frontend/default_frame.toml");
  const FrameLayout& compiled = default_frame_layout();
  EXPECT_EQ(shipped.name, compiled.name);
  EXPECT_EQ(shipped.length_bytes, 40);
  ASSERT_EQ(shipped.fields.size(), compiled.fields.size());
  for (std::size_t i = 0; i < shipped.fields.size(); ++i) {
    EXPECT_EQ(shipped.fields[i].name, compiled.fields[i].name);
    EXPECT_EQ(shipped.fields[i].bit_offset, compiled.fields[i].bit_offset);
  }
}

}  // namespace
}  // namespace waverig::rig
