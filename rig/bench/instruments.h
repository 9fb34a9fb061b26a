// Instruments: the bench's hands: opens sessions by address, sets and reads with checks, makes everything
// safe.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "rig/bench/laboratory.h"
#include "rig/bench/port_reader.h"
#include "rig/bench/session.h"

namespace waverig::rig::bench {

class Instruments {
 public:
  Instruments(const Laboratory& laboratory, Reactor& reactor);

  // Opens the ports and asks every instrument who it is. Throws InstrumentError where one is missing or
  // another one.
  std::map<std::string, std::string> identify();
  // Tells, asks for errors, reads back. Throws InstrumentError.
  void set(const Instrument& instrument, const Setting& setting, const std::string& command_value);
  // In SI. Throws InstrumentError; a reading outside its believable range is one.
  double read(const Instrument& instrument, const Reading& reading);
  // Every instrument's safe commands, whatever goes wrong; what did.
  std::vector<std::string> make_safe();

  PortReader& port(const std::string& name) { return *ports_.at(name); }
  std::map<std::string, std::unique_ptr<PortReader>>& ports() { return ports_; }

 private:
  Session& session(const Instrument& instrument);
  void check_errors(const Instrument& instrument);

  const Laboratory& laboratory_;
  Reactor& reactor_;
  std::map<std::string, std::shared_ptr<PrologixGateway>> gateways_;
  std::map<std::string, std::unique_ptr<Session>> sessions_;
  std::map<std::string, std::unique_ptr<PortReader>> ports_;
};

}  // namespace waverig::rig::bench
