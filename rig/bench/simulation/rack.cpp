#include "rig/bench/simulation/rack.h"

#include <charconv>
#include <set>

namespace waverig::rig::bench {

Rack::Rack(const Laboratory& laboratory, World& world, const std::vector<Fault>& faults)
    : world_(world), faults_(faults) {
  std::set<std::string> wired;  // the first of each kind is; the others are spares
  int free_address = 30;
  for (const Instrument& instrument : laboratory.instruments) {
    if (instrument.kind == "unit") continue;
    const Address address = parse_address(instrument.address, instrument.name);
    int gpib = free_address;
    if (address.scheme == "gpib")
      std::from_chars(address.path.data(), address.path.data() + address.path.size(), gpib);
    else
      --free_address;
    slots_.push_back(
        {instrument.name, gpib,
         make_device(instrument.kind, instrument.name, world, wired.insert(instrument.kind).second)});
  }
}

std::optional<std::size_t> Rack::at_gpib(int address) const {
  for (std::size_t i = 0; i < slots_.size(); ++i)
    if (slots_[i].gpib == address) return i;
  return std::nullopt;
}

std::optional<std::size_t> Rack::named(std::string_view name) const {
  for (std::size_t i = 0; i < slots_.size(); ++i)
    if (slots_[i].name == name) return i;
  return std::nullopt;
}

std::optional<std::size_t> Rack::vxi11(std::string_view device) const {
  int number = -1;
  const auto parse = [&](std::string_view digits) {
    std::from_chars(digits.data(), digits.data() + digits.size(), number);
    return number;
  };
  if (device.starts_with("gpib0,")) return at_gpib(parse(device.substr(6)));
  if (device.starts_with("inst") && parse(device.substr(4)) >= 0 && static_cast<std::size_t>(number) < size())
    return static_cast<std::size_t>(number);
  return named(device);
}

bool Rack::present(std::size_t index) const {
  return active(faults_, slots_[index].name, FaultType::kDisappear, time_s()) == nullptr;
}

std::optional<Answer> Rack::tell(std::size_t index, std::string_view line, std::int64_t now_utime) {
  Slot& slot = slots_[index];
  const auto fault = [&](FaultType type) { return active(faults_, slot.name, type, time_s()); };
  if (!present(index) || fault(FaultType::kHang) != nullptr) return std::nullopt;
  std::optional<std::string> text = slot.device->execute(line);
  if (fault(FaultType::kError) != nullptr && line.find("ERR") == std::string_view::npos)
    slot.device->push_error(-300, "Device-specific error");
  if (!text) return std::nullopt;
  if (const Fault* wrong = fault(FaultType::kWrong);
      wrong != nullptr && (line.starts_with("MEAS") || line.starts_with("READ")))
    text = scpi_text(wrong->value);
  const Fault* slow = fault(FaultType::kSlow);
  return Answer{*text, now_utime + (slow != nullptr ? static_cast<std::int64_t>(slow->value * 1e6) : 0)};
}

}  // namespace waverig::rig::bench
