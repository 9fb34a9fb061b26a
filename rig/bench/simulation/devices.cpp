#include "rig/bench/simulation/devices.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "lcmtypes/error.h"

namespace waverig::rig::bench {
namespace {

constexpr double kCompliance_A = 2.2;

// A spare instrument's own controls, living as long as it does; a wired one's are the world's.
struct Wiring {
  World& world;
  std::shared_ptr<Controls> spare;
  Controls& controls() const { return spare ? *spare : world.controls; }
};

std::string identity_of(const std::string& maker, const std::string& model, const std::string& name) {
  return fmt::format("{},{},{},1.0", maker, model, name);
}

void output_switch(ScpiDevice& device, const std::function<bool&()>& flag) {
  device.on_set("OUTPut", [flag](const std::string& a) { flag() = scpi_boolean(a); });
  device.on_query("OUTPut", [flag](const std::string&) { return flag() ? "1" : "0"; });
  device.on_set("OUTPut:STATe", [flag](const std::string& a) { flag() = scpi_boolean(a); });
  device.on_query("OUTPut:STATe", [flag](const std::string&) { return flag() ? "1" : "0"; });
}

// It sources only; the level must fit the range.
void make_calibrator(ScpiDevice& device, const Wiring& wiring) {
  const auto controls = [wiring]() -> CalibratorControls& { return wiring.controls().calibrator; };
  device.on_set("SOURce:CURRent:RANGe", [controls](const std::string& a) {
    const double range_A =
        estimator::kCalibratorTable2[range_index(scpi_number(a, 0, kCompliance_A))].full_scale_A;
    if (controls().level_A > range_A) throw ScpiError{-221, "Settings conflict;level above range"};
    controls().range_A = range_A;
  });
  device.on_query("SOURce:CURRent:RANGe",
                  [controls](const std::string&) { return scpi_text(controls().range_A); });
  device.on_set("SOURce:CURRent", [controls](const std::string& a) {
    controls().level_A = scpi_number(a, 0, controls().range_A);
  });
  device.on_query("SOURce:CURRent", [controls](const std::string&) { return scpi_text(controls().level_A); });
  output_switch(device, [controls]() -> bool& { return controls().on; });
  device.on_reset([controls] { controls() = {}; });
}

// ROUTe:PATH OPEN, or a channel and a polarity: ROUTe:PATH GYRO_3,NEG. ROUTe:METer puts the DMM in the unit's
// place.
void make_switch(ScpiDevice& device, const Wiring& wiring) {
  const auto route = [wiring]() -> RouteControls& { return wiring.controls().route; };
  device.on_set("ROUTe:PATH", [route](const std::string& a) {
    if (a == "OPEN") {
      route() = {};
      return;
    }
    const std::size_t comma = a.find(',');
    std::string name = a.substr(0, comma);
    for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    const std::string sign = comma == std::string::npos ? "" : a.substr(comma + 1);
    for (int channel = 0; channel < kChannels; ++channel) {
      if (channel_name(channel) != name || (sign != "POS" && sign != "NEG")) continue;
      route() = {channel, sign == "POS" ? 1 : -1};
      return;
    }
    throw ScpiError{-224, "Illegal parameter value;" + a};
  });
  device.on_query("ROUTe:PATH", [route](const std::string&) {
    if (route().channel < 0) return std::string("OPEN");
    std::string name = channel_name(route().channel);
    for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return name + (route().polarity > 0 ? ",POS" : ",NEG");
  });
  device.on_set("ROUTe:METer",
                [wiring](const std::string& a) { wiring.controls().dmm_in_path = scpi_boolean(a); });
  device.on_query("ROUTe:METer",
                  [wiring](const std::string&) { return wiring.controls().dmm_in_path ? "1" : "0"; });
  device.on_reset([wiring, route] {
    route() = {};
    wiring.controls().dmm_in_path = false;
  });
}

// Speaks as a 34401A does for direct current, so that clients made for one find their way.
void make_dmm(ScpiDevice& device, const Wiring& wiring, bool wired) {
  const auto range_A = std::make_shared<double>(22e-3);
  const auto read = [wiring, range_A, wired](const std::string&) {
    return scpi_text(wired ? wiring.world.dmm_reading_A(*range_A) : 0.0);
  };
  const auto configure = [range_A](const std::string& a) {
    const std::string first = a.substr(0, a.find(','));
    if (!first.empty() && first != "DEF" && first != "AUTO") *range_A = scpi_number(first, 0, 3);
  };
  device.on_set("CONFigure:CURRent:DC", configure);
  device.on_set("CONFigure:CURRent", configure);
  device.on_query("CONFigure", [range_A](const std::string&) {
    return fmt::format("\"CURR {:+.6E},+1.000000E-09\"", *range_A);
  });
  device.on_query("SENSe:FUNCtion", [](const std::string&) { return "\"CURR\""; });
  device.on_query("FUNCtion", [](const std::string&) { return "\"CURR\""; });
  device.on_query("READ", read);
  device.on_query("FETCh", read);
  device.on_query("MEASure:CURRent:DC", read);
  device.on_query("MEASure", read);
  device.on_set("SENSe:CURRent:DC:RANGe", configure);
  device.on_query("SENSe:CURRent:DC:RANGe", [range_A](const std::string&) { return scpi_text(*range_A); });
}

void make_chamber(ScpiDevice& device, const Wiring& wiring, bool wired) {
  const auto controls = [wiring]() -> ChamberControls& { return wiring.controls().chamber; };
  device.on_set("SOURce:TEMPerature",
                [controls](const std::string& a) { controls().target_degC = scpi_number(a, -40, 120); });
  device.on_query("SOURce:TEMPerature",
                  [controls](const std::string&) { return scpi_text(controls().target_degC); });
  device.on_set("SOURce:TEMPerature:RAMP",
                [controls](const std::string& a) { controls().ramp_degC_s = scpi_number(a, 0, 10) / 60; });
  device.on_query("SOURce:TEMPerature:RAMP",
                  [controls](const std::string&) { return scpi_text(controls().ramp_degC_s * 60); });
  device.on_query("MEASure:TEMPerature", [wiring, wired](const std::string&) {
    return scpi_text(wired ? wiring.world.chamber_reading_degC() : 23.0);
  });
  output_switch(device, [controls]() -> bool& { return controls().on; });
  device.on_reset([controls] { controls() = {}; });
}

void make_generator(ScpiDevice& device, const Wiring& wiring) {
  const auto controls = [wiring]() -> GeneratorControls& { return wiring.controls().generator; };
  device.on_set("SOURce:FREQuency",
                [controls](const std::string& a) { controls().frequency_Hz = scpi_number(a, 1, 20e6); });
  device.on_query("SOURce:FREQuency",
                  [controls](const std::string&) { return scpi_text(controls().frequency_Hz); });
  output_switch(device, [controls]() -> bool& { return controls().on; });
  device.on_reset([controls] { controls() = {}; });
}

void make_supply(ScpiDevice& device, const Wiring& wiring) {
  struct Supply {
    double voltage_V = 0, limit_A = 1;
  };
  const auto supply = std::make_shared<Supply>();
  const auto powered = [wiring]() -> bool& { return wiring.controls().unit_powered; };
  device.on_set("SOURce:VOLTage",
                [supply](const std::string& a) { supply->voltage_V = scpi_number(a, 0, 40); });
  device.on_query("SOURce:VOLTage", [supply](const std::string&) { return scpi_text(supply->voltage_V); });
  device.on_set("SOURce:CURRent", [supply](const std::string& a) { supply->limit_A = scpi_number(a, 0, 5); });
  device.on_query("SOURce:CURRent", [supply](const std::string&) { return scpi_text(supply->limit_A); });
  device.on_query("MEASure:VOLTage", [supply, powered](const std::string&) {
    return scpi_text(powered() ? supply->voltage_V : 0.0);
  });
  output_switch(device, powered);
  device.on_reset([supply, powered] {
    *supply = {};
    powered() = false;
  });
}

}  // namespace

const std::vector<std::string>& device_kinds() {
  static const std::vector<std::string> kinds = {"calibrator", "switch_matrix",      "dmm",
                                                 "chamber",    "function_generator", "power_supply"};
  return kinds;
}

std::unique_ptr<ScpiDevice> make_device(const std::string& kind, const std::string& name, World& world,
                                        bool wired) {
  const Wiring wiring{world, wired ? nullptr : std::make_shared<Controls>()};
  const auto device = [&](const std::string& maker, const std::string& model) {
    return std::make_unique<ScpiDevice>(identity_of(maker, model, name));
  };
  std::unique_ptr<ScpiDevice> made;
  if (kind == "calibrator") make_calibrator(*(made = device("WAVERIG", "CAL-2A")), wiring);
  if (kind == "switch_matrix") make_switch(*(made = device("WAVERIG", "MATRIX-10")), wiring);
  if (kind == "dmm") make_dmm(*(made = device("HEWLETT-PACKARD", "34401A")), wiring, wired);
  if (kind == "chamber") make_chamber(*(made = device("WAVERIG", "CHAMBER-60")), wiring, wired);
  if (kind == "function_generator") make_generator(*(made = device("WAVERIG", "GENERATOR-20M")), wiring);
  if (kind == "power_supply") make_supply(*(made = device("WAVERIG", "SUPPLY-40")), wiring);
  if (!made)
    throw UserError(fmt::format("instrument {}: kind = \"{}\": expected one of {}", name, kind,
                                fmt::join(device_kinds(), ", ")));
  return made;
}

void unit_command(World& world, std::string_view line) {
  const std::size_t space = line.find(' ');
  if (space == std::string_view::npos) return;
  double rate_Hz = -1;
  const std::string_view number = line.substr(space + 1);
  std::from_chars(number.data(), number.data() + number.size(), rate_Hz);
  if (!(rate_Hz >= 0 && rate_Hz <= 100)) return;
  const int period = rate_Hz > 0 ? static_cast<int>(std::lround(1 / (rate_Hz * kTick_s))) : 0;
  if (line.substr(0, space) == "RATE") world.controls.unit.counts_period_ticks = period;
  if (line.substr(0, space) == "MONITOR") world.controls.unit.monitor_period_ticks = period;
}

}  // namespace waverig::rig::bench
