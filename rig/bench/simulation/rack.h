// Rack: the simulated instruments by name and bus address, with what is wrong with them at the moment.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rig/bench/laboratory.h"
#include "rig/bench/simulation/devices.h"
#include "rig/bench/simulation/faults.h"

namespace waverig::rig::bench {

struct Answer {
  std::string text;
  std::int64_t due_utime = 0;
};

class Rack {
 public:
  Rack(const Laboratory& laboratory, World& world, const std::vector<Fault>& faults);

  std::size_t size() const { return slots_.size(); }
  const std::string& name(std::size_t index) const { return slots_[index].name; }
  std::optional<std::size_t> at_gpib(int address) const;
  std::optional<std::size_t> named(std::string_view name) const;
  // Behind gpib0,ADDRESS or under its own name or instN, as a VXI-11 device.
  std::optional<std::size_t> vxi11(std::string_view device) const;

  bool present(std::size_t index) const;  // not disappeared
  // Tells an instrument one line; its answer, if the line asked for one and it is well.
  std::optional<Answer> tell(std::size_t index, std::string_view line, std::int64_t now_utime);

 private:
  struct Slot {
    std::string name;
    int gpib = -1;
    std::unique_ptr<ScpiDevice> device;
  };
  double time_s() const { return world_.state().time_s; }

  World& world_;
  const std::vector<Fault>& faults_;
  std::vector<Slot> slots_;
};

}  // namespace waverig::rig::bench
