// SimulatedLaboratory: the other side of every cable of a bench, on this machine: a raw SCPI port for each
// instrument, VXI-11 with its port mapper, a GPIB gateway with all of them, and two pseudo-terminals with the
// unit's frames.
//
// One thread serves everything. In virtual time it runs beside a bench in the same program and tells
// VirtualTime when it is busy; in real time anybody may talk to it. All listening is on the loopback
// interface, on ports the system chooses; the port mapper needs port 111 of an address of its own in 127/8,
// and where that cannot be had there is no VXI-11.
#pragma once
#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "rig/bench/laboratory.h"
#include "rig/bench/simulation/faults.h"
#include "rig/bench/virtual_time.h"

namespace waverig::rig::bench {

class LaboratoryServer;

class SimulatedLaboratory {
 public:
  // time: nullptr for real time. start_utime: of the world. world: a snapshot to go on from, or empty.
  SimulatedLaboratory(const SimulationSettings& settings, const Laboratory& laboratory, VirtualTime* time,
                      std::int64_t start_utime, const std::string& world = "");
  ~SimulatedLaboratory();
  SimulatedLaboratory(const SimulatedLaboratory&) = delete;
  SimulatedLaboratory& operator=(const SimulatedLaboratory&) = delete;

  // The same laboratory with the addresses of this one. Where there is no VXI-11, raw SCPI takes its place.
  Laboratory addressed() const;
  bool has_vxi11() const;
  struct Endpoint {
    std::string instrument, address;
  };
  std::vector<Endpoint> endpoints() const;  // every way to every instrument

  // The physical state, while the laboratory is idle.
  std::string snapshot() const;
  UnitTruth unit_truth() const;
  double source_A() const;  // what the calibrator puts out now
  double chamber_target_degC() const;

 private:
  Laboratory laboratory_;
  std::unique_ptr<LaboratoryServer> server_;
  std::atomic<bool> stop_{false};
  int stop_descriptor_;
  std::thread thread_;
};

}  // namespace waverig::rig::bench
