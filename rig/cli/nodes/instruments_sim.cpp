// waverig node instruments-sim: the other side of every cable of a bench, in real time: raw SCPI, VXI-11, a
// GPIB gateway, two serial ports. Any client may talk to it.
#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <thread>

#include "lcmtypes/atomic_file.h"
#include "lcmtypes/disk.h"
#include "lcmtypes/error.h"
#include "rig/bench/simulation/simulated_laboratory.h"
#include "rig/cli/nodes/nodes.h"
#include "rig/cli/nodes/process.h"

namespace waverig::cli {
namespace {

using namespace rig::bench;

// The laboratory file with the addresses of the simulated one, all else as it was.
std::string readdressed(const Laboratory& as_written, const Laboratory& simulated) {
  std::string text = content_of(as_written.file, "the laboratory");
  const auto replace = [&](const std::string& from, const std::string& to) {
    const std::string quoted = "\"" + from + "\"";
    for (std::size_t at = text.find(quoted); at != std::string::npos; at = text.find(quoted, at + to.size()))
      text.replace(at, quoted.size(), "\"" + to + "\"");
  };
  for (std::size_t i = 0; i < as_written.gateways.size(); ++i)
    replace(as_written.gateways[i].address, simulated.gateways[i].address);
  for (std::size_t i = 0; i < as_written.ports.size(); ++i)
    replace(as_written.ports[i].address, simulated.ports[i].address);
  for (std::size_t i = 0; i < as_written.instruments.size(); ++i)
    if (as_written.instruments[i].address != simulated.instruments[i].address)
      replace(as_written.instruments[i].address, simulated.instruments[i].address);
  return text;
}

}  // namespace

int run_instruments_sim(const InstrumentsSimArguments& arguments) {
  const Laboratory laboratory = load_laboratory(arguments.laboratory);
  SimulationSettings settings;
  if (!arguments.simulation.empty()) settings = load_simulation(arguments.simulation);
  Requests requests;  // before the laboratory's thread
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const SimulatedLaboratory simulated(settings, laboratory, nullptr,
                                      std::chrono::duration_cast<std::chrono::microseconds>(now).count());
  for (const SimulatedLaboratory::Endpoint& e : simulated.endpoints())
    fmt::print("{:<18} {}\n", e.instrument, e.address);
  if (!simulated.has_vxi11())
    fmt::print(stderr, "instruments-sim: no VXI-11: its port mapper needs port 111\n");
  if (!arguments.write.empty())
    write_atomically(arguments.write, readdressed(laboratory, simulated.addressed()));
  std::fflush(stdout);
  while (requests.next() != Request::kStop) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  return 0;
}

}  // namespace waverig::cli
