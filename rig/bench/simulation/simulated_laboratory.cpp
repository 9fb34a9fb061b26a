#include "rig/bench/simulation/simulated_laboratory.h"

#include <fmt/format.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include "rig/bench/simulation/laboratory_server.h"

namespace waverig::rig::bench {

using Kind = LaboratoryServer::Listener::Kind;

SimulatedLaboratory::SimulatedLaboratory(const SimulationSettings& settings, const Laboratory& laboratory,
                                         VirtualTime* time, std::int64_t start_utime,
                                         const std::string& world)
    : laboratory_(laboratory),
      server_(std::make_unique<LaboratoryServer>(settings, laboratory, time, start_utime)),
      stop_descriptor_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  if (!world.empty()) server_->world().restore(world);
  thread_ = std::thread([this] { server_->run(stop_, stop_descriptor_); });
}

SimulatedLaboratory::~SimulatedLaboratory() {
  stop_ = true;
  const std::uint64_t one = 1;
  while (::write(stop_descriptor_, &one, sizeof one) < 0 && errno == EINTR) {
  }
  thread_.join();
  ::close(stop_descriptor_);
}

bool SimulatedLaboratory::has_vxi11() const { return !server_->vxi11_host().empty(); }

std::vector<SimulatedLaboratory::Endpoint> SimulatedLaboratory::endpoints() const {
  std::vector<Endpoint> list;
  for (const auto& listener : server_->listeners()) {
    if (listener.kind == Kind::kGateway)
      list.push_back({"gateway", fmt::format("tcp://127.0.0.1:{}", listener.port)});
    if (listener.kind == Kind::kScpi)
      list.push_back(
          {server_->rack().name(listener.device), fmt::format("tcp://127.0.0.1:{}", listener.port)});
  }
  if (has_vxi11())
    for (std::size_t i = 0; i < server_->rack().size(); ++i)
      list.push_back({server_->rack().name(i), fmt::format("vxi11://{}/inst{}", server_->vxi11_host(), i)});
  for (const auto& line : server_->lines())
    list.push_back({line.name, "serial://" + line.path + "?baud=921600"});
  return list;
}

Laboratory SimulatedLaboratory::addressed() const {
  Laboratory result = laboratory_;
  const std::vector<Endpoint> all = endpoints();
  const auto find = [&](const std::string& name, const std::string& scheme) {
    for (const Endpoint& e : all)
      if (e.instrument == name && e.address.starts_with(scheme)) return e.address;
    return std::string();
  };
  for (Gateway& gateway : result.gateways) gateway.address = find("gateway", "tcp");
  for (Port& port : result.ports) port.address = find(port.name, "serial");
  for (Instrument& instrument : result.instruments) {
    if (instrument.address.starts_with("vxi11"))
      instrument.address = find(instrument.name, has_vxi11() ? "vxi11" : "tcp");
    if (instrument.address.starts_with("tcp")) instrument.address = find(instrument.name, "tcp");
  }
  return result;
}

std::string SimulatedLaboratory::snapshot() const {
  const std::lock_guard lock(server_->mutex());
  return server_->world().snapshot();
}

UnitTruth SimulatedLaboratory::unit_truth() const {
  const std::lock_guard lock(server_->mutex());
  return server_->world().unit_truth();
}

double SimulatedLaboratory::source_A() const {
  const std::lock_guard lock(server_->mutex());
  return server_->world().source_A();
}

double SimulatedLaboratory::chamber_target_degC() const {
  const std::lock_guard lock(server_->mutex());
  return server_->world().controls.chamber.target_degC;
}

}  // namespace waverig::rig::bench
