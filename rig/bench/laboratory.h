// Laboratory: the instruments, gateways and ports of a bench, from a file (TOML): addresses, and what each
// instrument is told and asked. rig/sequences/laboratory.toml shows every key.
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "rig/bench/quantity.h"
#include "rig/frontend/frame_layout.h"

namespace waverig::rig::bench {

// Something an instrument is told: a quantity within bounds, one of several words, or free text.
struct Setting {
  std::string name;
  std::string command;                         // "{value}" stands for the number or the word
  std::string query;                           // read back after the command; empty: not
  Unit unit{"1", "1", 1};                      // of the number in the command
  double low_si = 0, high_si = 0;              // where there are no choices
  std::map<std::string, std::string> choices;  // word in the sequence: word in the command
  bool text = false;
};

// Something an instrument is asked: a number.
struct Reading {
  std::string name;
  std::string query;
  Unit unit{"1", "1", 1};
  double low_si = 0, high_si = 0;  // outside: the reading is not believed
};

struct Instrument {
  std::string name, kind;
  std::string address;      // as in session.h
  std::string identity;     // its answer to *IDN? holds this; empty: it is not asked
  std::string error_query;  // asked after each command; empty: it has none
  double timeout_s = 3;
  std::vector<Setting> settings;
  std::vector<Reading> readings;
  std::vector<std::string> safe;  // commands that leave it safe

  const Setting* setting(std::string_view setting_name) const;
  const Reading* reading(std::string_view reading_name) const;
};

struct Gateway {
  std::string name;
  std::string address;  // tcp://host:port
};

struct Port {
  std::string name;
  std::string address;  // serial:///dev/ttyS0?baud=921600
  std::filesystem::path layout_file;
  FrameLayout layout;
};

// Which fields of the frames are what, and how the unit is designed.
struct UnitDescription {
  std::string name, serial;
  std::string counts_port, monitor_port;
  double tick_s = 0.01, clock_Hz = 10e6, reference_Hz = 1e6;
  struct Channel {
    std::string name;
    double K_N0_C = 0, K_P0_C = 0;
    double noise_A_sqrt_s = 0, bias_wander_A = 0;  // what its data sheet says, for the budget
    double bias_limit_A = 0, scale_limit = 0;      // the specification it is held against
  };
  std::vector<Channel> channels;
  const Channel* channel(std::string_view channel_name) const;
};

struct Laboratory {
  std::filesystem::path file;
  std::vector<Gateway> gateways;
  std::vector<Instrument> instruments;
  std::vector<Port> ports;
  std::filesystem::path unit_file;
  UnitDescription unit;
  std::map<std::string, std::string> fingerprints;  // of the files it was read from
  std::vector<std::filesystem::path> files;  // all that were opened: those, and that of a unit replaced since

  const Instrument* instrument(std::string_view name) const;
  const Port* port(std::string_view name) const;
};

// Throws UserError naming file, line, key, value and what was expected.
Laboratory load_laboratory(const std::filesystem::path& file);
// Another unit in the same laboratory. Throws UserError as above.
void load_unit(const std::filesystem::path& file, Laboratory& laboratory);

// Of a file's bytes, as 16 hexadecimal digits; throws UserError where it cannot be read.
std::string fingerprint(const std::filesystem::path& file);

// "tcp://127.0.0.1:5025" in its parts; path is what follows the host, without the slash. Throws UserError.
struct Address {
  std::string scheme, host, path;
  int port = 0;
  std::map<std::string, std::string> options;  // after '?'
};
Address parse_address(const std::string& text, const std::string& where);

}  // namespace waverig::rig::bench
