#include "rig/bench/laboratory.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <sstream>

#include "lcmtypes/disk.h"
#include "lcmtypes/error.h"
#include "rig/bench/simulation/devices.h"
#include "rig/settings/toml_reader.h"

namespace waverig::rig::bench {
namespace {

constexpr double kLongestTimeout_s = 3600;  // of an instrument

template <class Item>
const Item* find_named(const std::vector<Item>& items, std::string_view name) {
  const auto found = std::ranges::find(items, name, &Item::name);
  return found == items.end() ? nullptr : &*found;
}

template <class Item>
void refuse_twice(const std::vector<Item>& items, TomlTable& table) {
  if (find_named(items, items.back().name) != &items.back())
    table.refuse("name", "a name that no other one has");
}

double quantity(TomlTable& table, std::string_view key, const std::string& base,
                std::optional<std::string> fallback = {}) {
  return parse_quantity(table.text(key, std::move(fallback)), base,
                        table.place_of(key) + ": " + table.name_of(key))
      .si;
}

Unit unit_of(TomlTable& table) {
  return parse_unit(table.text("unit", "1"), table.place_of("unit") + ": " + table.name_of("unit"));
}

Setting read_setting(TomlTable& table) {
  Setting s;
  s.name = table.text("name", {});
  s.command = table.text("command", {});
  s.query = table.text("query", "");
  s.text = table.boolean("text", false);
  if (table.has("choices")) {
    TomlTable choices = table.table("choices");
    for (const std::string& word : choices.keys()) s.choices[word] = choices.text(word, {});
  } else if (!s.text) {
    s.unit = unit_of(table);
    s.low_si = quantity(table, "low", s.unit.base);
    s.high_si = quantity(table, "high", s.unit.base);
    if (s.low_si > s.high_si) table.refuse("low", "at most high");
  }
  if (s.command.find("{value}") == std::string::npos) table.refuse("command", "a command with {value} in it");
  return s;
}

Reading read_reading(TomlTable& table) {
  Reading r;
  r.name = table.text("name", {});
  r.query = table.text("query", {});
  r.unit = unit_of(table);
  r.low_si = quantity(table, "low", r.unit.base);
  r.high_si = quantity(table, "high", r.unit.base);
  return r;
}

void check_address(const Laboratory& laboratory, const std::string& text, TomlTable& table,
                   const std::vector<std::string>& schemes) {
  const Address address = parse_address(text, table.place_of("address") + ": " + table.name_of("address"));
  if (std::ranges::find(schemes, address.scheme) == schemes.end())
    table.refuse("address",
                 fmt::format("an address that begins with one of {}", fmt::join(schemes, "://, ")) + "://");
  if (address.scheme == "tcp" && address.port == 0) table.refuse("address", "tcp://HOST:PORT");
  if (address.scheme == "gpib") {
    if (find_named(laboratory.gateways, address.host) == nullptr)
      table.refuse("address", "gpib://GATEWAY/0…30 with a known gateway");
    int number = -1;
    std::from_chars(address.path.data(), address.path.data() + address.path.size(), number);
    if (number < 0 || number > 30) table.refuse("address", "a GPIB address from 0 to 30");
  }
  if (address.scheme == "port" && find_named(laboratory.ports, address.host) == nullptr)
    table.refuse("address", "port://NAME with a known port");
}

UnitDescription read_unit(TomlTable& table, const Laboratory& laboratory) {
  UnitDescription unit;
  unit.name = table.text("name", {});
  unit.serial = table.text("serial", {});
  unit.counts_port = table.text("counts_port", {});
  unit.monitor_port = table.text("monitor_port", {});
  for (const auto& [key, port_name] :
       {std::pair{"counts_port", unit.counts_port}, {"monitor_port", unit.monitor_port}})
    if (laboratory.port(port_name) == nullptr) table.refuse(key, "the name of a port of this file");
  unit.tick_s = quantity(table, "tick", "s");
  unit.clock_Hz = quantity(table, "clock", "Hz");
  unit.reference_Hz = quantity(table, "reference", "Hz");
  const FrameLayout& counts = laboratory.port(unit.counts_port)->layout;
  for (const char* field : {"ticks", "clock", "temperature"}) counts.index_of(field);
  for (const char* field : {"ticks", "reference", "temperature"})
    laboratory.port(unit.monitor_port)->layout.index_of(field);
  for (TomlTable& group : table.tables("channels")) {
    UnitDescription::Channel channel;
    channel.K_N0_C = quantity(group, "K_N0", "C");
    channel.K_P0_C = quantity(group, "K_P0", "C");
    channel.noise_A_sqrt_s = quantity(group, "noise_1s", "A");
    channel.bias_wander_A = quantity(group, "bias_wander", "A");
    channel.bias_limit_A = quantity(group, "bias_limit", "A");
    channel.scale_limit = quantity(group, "scale_limit", "1");
    for (const std::string& name : group.texts("names", {})) {
      channel.name = name;
      for (const char* suffix : {"_N", "_P"}) counts.index_of(name + suffix);
      unit.channels.push_back(channel);
    }
  }
  if (unit.channels.empty()) table.refuse("channels", "at least one group of channels");
  return unit;
}

}  // namespace

const Setting* Instrument::setting(std::string_view setting_name) const {
  return find_named(settings, setting_name);
}
const Reading* Instrument::reading(std::string_view reading_name) const {
  return find_named(readings, reading_name);
}
const UnitDescription::Channel* UnitDescription::channel(std::string_view channel_name) const {
  return find_named(channels, channel_name);
}
const Instrument* Laboratory::instrument(std::string_view name) const {
  return find_named(instruments, name);
}
const Port* Laboratory::port(std::string_view name) const { return find_named(ports, name); }

std::string fingerprint(const std::filesystem::path& file) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;  // FNV-1a: to notice a change, not to resist a forger
  for (const char c : content_of(file, "a file of the sequence"))
    hash = (hash ^ static_cast<std::uint8_t>(c)) * 0x100000001b3ULL;
  return fmt::format("{:016x}", hash);
}

Address parse_address(const std::string& text, const std::string& where) {
  Address a;
  const std::size_t scheme = text.find("://");
  if (scheme == std::string::npos)
    throw UserError(fmt::format("{} = \"{}\": expected SCHEME://HOST…", where, text));
  a.scheme = text.substr(0, scheme);
  std::string rest = text.substr(scheme + 3);
  if (const std::size_t mark = rest.find('?'); mark != std::string::npos) {
    std::istringstream options(rest.substr(mark + 1));
    for (std::string option; std::getline(options, option, '&');)
      a.options[option.substr(0, option.find('='))] =
          option.find('=') == std::string::npos ? "" : option.substr(option.find('=') + 1);
    rest.resize(mark);
  }
  const std::size_t slash = rest.find('/');
  a.host = rest.substr(0, slash);
  if (slash != std::string::npos) a.path = rest.substr(slash + 1);
  if (const std::size_t colon = a.host.find(':'); colon != std::string::npos) {
    const std::string digits = a.host.substr(colon + 1);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), a.port);
    if (error != std::errc() || end != digits.data() + digits.size() || a.port < 1 || a.port > 65535)
      throw UserError(fmt::format("{} = \"{}\": expected a port from 1 to 65535", where, text));
    a.host.resize(colon);
  }
  return a;
}

Laboratory load_laboratory(const std::filesystem::path& file) {
  TomlFile document(file);
  TomlTable& root = document.root();
  Laboratory laboratory;
  laboratory.file = file;
  laboratory.fingerprints[file.filename().string()] = fingerprint(file);
  laboratory.files.push_back(file);
  for (TomlTable& table : root.tables("gateway")) {
    laboratory.gateways.push_back({table.text("name", {}), table.text("address", {})});
    refuse_twice(laboratory.gateways, table);
    check_address(laboratory, laboratory.gateways.back().address, table, {"tcp"});
  }
  for (TomlTable& table : root.tables("port")) {
    Port port;
    port.name = table.text("name", {});
    port.address = table.text("address", {});
    check_address(laboratory, port.address, table, {"serial"});
    port.layout_file = file.parent_path() / table.text("layout", {});
    port.layout = load_frame_layout(port.layout_file);
    laboratory.fingerprints[port.layout_file.filename().string()] = fingerprint(port.layout_file);
    laboratory.files.push_back(port.layout_file);
    laboratory.ports.push_back(std::move(port));
    refuse_twice(laboratory.ports, table);
  }
  for (TomlTable& table : root.tables("instrument")) {
    Instrument instrument;
    instrument.name = table.text("name", {});
    std::vector<std::string> kinds = device_kinds();
    kinds.push_back("unit");
    instrument.kind = table.choice("kind", {}, kinds);
    instrument.address = table.text("address", {});
    check_address(laboratory, instrument.address, table, {"tcp", "vxi11", "gpib", "port"});
    instrument.identity = table.text("identity", "");
    instrument.error_query = table.text("error_query", "");
    instrument.timeout_s = quantity(table, "timeout", "s", "3 s");
    if (!(instrument.timeout_s > 0 && instrument.timeout_s <= kLongestTimeout_s))
      table.refuse("timeout", "a time above 0, of an hour at most");
    if (table.has("safe")) instrument.safe = table.texts("safe", {});
    for (TomlTable& setting : table.tables("setting")) instrument.settings.push_back(read_setting(setting));
    for (TomlTable& reading : table.tables("reading")) instrument.readings.push_back(read_reading(reading));
    laboratory.instruments.push_back(std::move(instrument));
    refuse_twice(laboratory.instruments, table);
  }
  const std::filesystem::path unit_file = file.parent_path() / root.text("unit", {});
  root.refuse_unknown_keys();
  load_unit(unit_file, laboratory);
  return laboratory;
}

void load_unit(const std::filesystem::path& file, Laboratory& laboratory) {
  TomlFile document(file);
  laboratory.unit = read_unit(document.root(), laboratory);
  document.root().refuse_unknown_keys();
  laboratory.fingerprints.erase(laboratory.unit_file.filename().string());
  laboratory.unit_file = file;
  laboratory.fingerprints[file.filename().string()] = fingerprint(file);
  laboratory.files.push_back(file);
}

}  // namespace waverig::rig::bench
