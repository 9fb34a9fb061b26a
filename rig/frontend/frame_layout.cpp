#include "rig/frontend/frame_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

#include "lcmtypes/error.h"
#include "rig/frontend/default_frame_text.h"
#include "rig/settings/toml_reader.h"

namespace waverig::rig {
namespace {

constexpr int kLongestFrame = 65536;

std::vector<std::uint8_t> byte_list(TomlTable& table, std::string_view key) {
  std::vector<std::uint8_t> bytes;
  if (!table.has(key)) return bytes;
  for (const double number : table.numbers(key, std::nullopt, {0, 255})) {
    if (number != std::floor(number)) table.refuse(key, "a list of bytes, whole numbers from 0 to 255");
    bytes.push_back(static_cast<std::uint8_t>(number));
  }
  return bytes;
}

ByteOrder byte_order(TomlTable& table) {
  return table.choice("byte_order", "big", {"big", "little"}) == "big" ? ByteOrder::kBig : ByteOrder::kLittle;
}

int whole(TomlTable& table, std::string_view key, Range range) {
  return static_cast<int>(table.integer(key, std::nullopt, range));
}

FrameField read_field(TomlTable& table, int length_bytes) {
  FrameField field;
  field.name = table.text("name", std::nullopt);
  const std::string type = table.choice("type", std::nullopt, {"unsigned", "signed", "float"});
  field.type = type == "unsigned" ? FieldType::kUnsigned
               : type == "signed" ? FieldType::kSigned
                                  : FieldType::kFloat;
  field.bit_offset = whole(table, "bit_offset", {0, 8.0 * length_bytes - 1});
  field.bits = whole(table, "bits", {1, 64});
  field.order = byte_order(table);
  field.unit = table.text("unit", "");
  if (field.bit_offset + field.bits > 8 * length_bytes)
    table.refuse("bits", "a field that ends within the frame");
  if (field.bit_offset % 8 + field.bits > 64) table.refuse("bits", "a field within eight bytes");
  if (field.type == FieldType::kFloat && field.bits != 32 && field.bits != 64)
    table.refuse("bits", "32 or 64 bits of a float");
  if (table.has("polynomial")) field.polynomial = table.numbers("polynomial", std::nullopt);
  if (table.has("segment_raw")) {
    if (!field.polynomial.empty()) table.refuse("segment_raw", "either a polynomial or segments");
    const std::vector<double> raw = table.numbers("segment_raw", std::nullopt);
    const std::vector<double> value = table.numbers("segment_value", std::nullopt);
    if (raw.size() < 2 || !std::ranges::is_sorted(raw, std::less_equal{}))
      table.refuse("segment_raw", "at least two ascending raw numbers");
    if (value.size() != raw.size())
      table.refuse("segment_value", fmt::format("{} values, one a raw number", raw.size()));
    for (std::size_t i = 0; i < raw.size(); ++i) field.segments.push_back({raw[i], value[i]});
  }
  for (TomlTable& limits : table.tables("limits")) {
    field.limits.push_back({limits.text("name", std::nullopt), limits.number("low", std::nullopt), 0});
    field.limits.back().high = limits.number("high", std::nullopt, {field.limits.back().low});
  }
  return field;
}

CrcPlacement read_crc(TomlTable& table, int length_bytes) {
  CrcPlacement crc;
  constexpr Range kWord{0, 4294967295.0};
  const auto word = [&](std::string_view key) {
    return static_cast<std::uint32_t>(table.integer(key, std::nullopt, kWord));
  };
  crc.parameters = {whole(table, "width", {8, 32}),
                    word("poly"),
                    word("init"),
                    table.boolean("refin", std::nullopt),
                    table.boolean("refout", std::nullopt),
                    word("xorout"),
                    word("check")};
  if (crc.parameters.width % 8 != 0) table.refuse("width", "whole bytes: 8, 16, 24 or 32");
  crc.first_byte = whole(table, "first_byte", {0, length_bytes - 1.0});
  crc.last_byte = whole(table, "last_byte", {static_cast<double>(crc.first_byte), length_bytes - 1.0});
  crc.byte_offset =
      whole(table, "byte_offset", {0, static_cast<double>(length_bytes - crc.parameters.width / 8)});
  crc.order = byte_order(table);
  if (crc.byte_offset <= crc.last_byte && crc.byte_offset + crc.parameters.width / 8 > crc.first_byte)
    table.refuse("byte_offset", "a place outside the bytes that the CRC covers");
  try {
    Crc self_test(crc.parameters);
  } catch (const UserError& error) {
    throw UserError(fmt::format("{}: {}", table.place_of("check"), error.what()));
  }
  return crc;
}

FrameLayout read_layout(TomlTable& root) {
  FrameLayout layout;
  layout.name = root.text("name", std::nullopt);
  layout.length_bytes = whole(root, "length_bytes", {1, kLongestFrame});
  layout.sync = byte_list(root, "sync");
  layout.terminator = byte_list(root, "terminator");
  if (layout.sync.empty()) root.refuse("sync", "a list of at least one byte");
  if (layout.sync.size() + layout.terminator.size() > static_cast<std::size_t>(layout.length_bytes))
    root.refuse("length_bytes", "a frame longer than its sync and terminator");
  std::set<std::string> names;
  for (TomlTable& table : root.tables("field")) {
    layout.fields.push_back(read_field(table, layout.length_bytes));
    if (!names.insert(layout.fields.back().name).second)
      table.refuse("name", "a name that no other field has");
  }
  layout.counter = root.text("counter", "");
  if (!layout.counter.empty()) {
    const auto found = std::ranges::find(layout.fields, layout.counter, &FrameField::name);
    if (found == layout.fields.end() || found->type != FieldType::kUnsigned || found->bits < 4 ||
        found->bits > 32)
      root.refuse("counter", "the name of an unsigned field of 4 to 32 bits");
  }
  if (root.has("crc")) {
    TomlTable crc = root.table("crc");
    layout.crc = read_crc(crc, layout.length_bytes);
  }
  root.refuse_unknown_keys();
  return layout;
}

double interpolated(const std::vector<CalibrationPoint>& points, double raw) {
  std::size_t i = 1;
  while (i + 1 < points.size() && raw > points[i].raw) ++i;
  const CalibrationPoint &a = points[i - 1], &b = points[i];
  return a.value + (b.value - a.value) * (raw - a.raw) / (b.raw - a.raw);
}

}  // namespace

double FrameField::value(std::int64_t raw) const {
  double x;
  if (type == FieldType::kFloat) {
    x = bits == 64 ? std::bit_cast<double>(raw)
                   : static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(raw)));
  } else if (type == FieldType::kUnsigned) {
    x = static_cast<double>(static_cast<std::uint64_t>(raw));
  } else {
    x = static_cast<double>(raw);
  }
  if (!segments.empty()) return interpolated(segments, x);
  if (polynomial.empty()) return x;
  double sum = 0;
  for (auto c = polynomial.rbegin(); c != polynomial.rend(); ++c) sum = sum * x + *c;
  return sum;
}

std::size_t FrameLayout::index_of(std::string_view field) const {
  const auto found = std::ranges::find(fields, field, &FrameField::name);
  if (found == fields.end())
    throw UserError(
        fmt::format("frame layout \"{}\": no field \"{}\": expected one of that name", name, field));
  return static_cast<std::size_t>(found - fields.begin());
}

FrameLayout load_frame_layout(const std::filesystem::path& path) {
  TomlFile file(path);
  return read_layout(file.root());
}

FrameLayout parse_frame_layout(std::string_view toml, const std::string& name) {
  TomlFile file(toml, name);
  return read_layout(file.root());
}

const FrameLayout& default_frame_layout() {
  static const FrameLayout layout = parse_frame_layout(kDefaultFrameText, "rig/frontend/default_frame.toml");
  return layout;
}

}  // namespace waverig::rig
