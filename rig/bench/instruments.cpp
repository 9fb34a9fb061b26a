#include "rig/bench/instruments.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace waverig::rig::bench {
namespace {

// A serial port that only listens, as an instrument.
class PortSession : public Session {
 public:
  explicit PortSession(PortReader& port) : port_(port) {}
  void write(const std::string& command, double) override { port_.write(command); }
  std::string query(const std::string& command, double) override {
    throw InstrumentError(FaultKind::kUnexpected, port_.port().name, command + ": a port is told, not asked");
  }

 private:
  PortReader& port_;
};

std::string filled(const std::string& command, const std::string& value) {
  std::string result = command;
  result.replace(result.find("{value}"), 7, value);
  return result;
}

std::optional<double> number(const std::string& text) {
  double value = 0;
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), value);
  if (error != std::errc() || end == begin) return std::nullopt;
  return value;
}

}  // namespace

Instruments::Instruments(const Laboratory& laboratory, Reactor& reactor)
    : laboratory_(laboratory), reactor_(reactor) {
  for (const Gateway& gateway : laboratory.gateways) {
    const Address a = parse_address(gateway.address, gateway.name);
    gateways_[gateway.name] = std::make_shared<PrologixGateway>(reactor, gateway.name, a.host, a.port);
  }
  for (const Port& port : laboratory.ports)
    ports_[port.name] = std::make_unique<PortReader>(reactor, port, laboratory.unit);
}

Session& Instruments::session(const Instrument& instrument) {
  std::unique_ptr<Session>& session = sessions_[instrument.name];
  if (session) return *session;
  const Address a = parse_address(instrument.address, instrument.name);
  if (a.scheme == "tcp")
    session = std::make_unique<ScpiTcpSession>(reactor_, instrument.name, a.host, a.port);
  if (a.scheme == "vxi11")
    session = std::make_unique<Vxi11Session>(reactor_, instrument.name, a.host, a.path);
  if (a.scheme == "gpib")
    session = std::make_unique<GpibSession>(gateways_.at(a.host), instrument.name, std::atoi(a.path.c_str()));
  if (a.scheme == "port") session = std::make_unique<PortSession>(port(a.host));
  return *session;
}

std::map<std::string, std::string> Instruments::identify() {
  std::map<std::string, std::string> identities;
  for (const Instrument& instrument : laboratory_.instruments) {
    if (instrument.identity.empty()) continue;
    const std::string answer = session(instrument).query("*IDN?", instrument.timeout_s);
    if (answer.find(instrument.identity) == std::string::npos)
      throw InstrumentError(FaultKind::kUnexpected, instrument.name,
                            fmt::format("it is \"{}\" at {}: expected \"{}\"", answer, instrument.address,
                                        instrument.identity));
    identities[instrument.name] = answer;
  }
  return identities;
}

void Instruments::check_errors(const Instrument& instrument) {
  if (instrument.error_query.empty()) return;
  std::string all;
  for (int i = 0; i < 30; ++i) {  // a queue is never longer
    const std::string answer = session(instrument).query(instrument.error_query, instrument.timeout_s);
    if (number(answer).value_or(-1) == 0) break;
    all += (all.empty() ? "" : "; ") + answer;
  }
  if (!all.empty()) throw InstrumentError(FaultKind::kErrorQueue, instrument.name, all);
}

void Instruments::set(const Instrument& instrument, const Setting& setting,
                      const std::string& command_value) {
  const std::string command = filled(setting.command, command_value);
  session(instrument).write(command, instrument.timeout_s);
  check_errors(instrument);
  if (setting.query.empty()) return;
  const std::string answer = session(instrument).query(setting.query, instrument.timeout_s);
  const auto told = number(command_value), is = number(answer);
  const bool same = told && is && !setting.text
                        ? std::abs(*told - *is) <= 1e-6 * std::abs(*told) + 1e-15
                        : std::ranges::equal(answer, command_value, [](unsigned char a, unsigned char b) {
                            return std::tolower(a) == std::tolower(b);
                          });
  if (!same)
    throw InstrumentError(FaultKind::kUnexpected, instrument.name,
                          fmt::format("{} reads back {} after \"{}\"", setting.name, answer, command));
}

double Instruments::read(const Instrument& instrument, const Reading& reading) {
  const std::string answer = session(instrument).query(reading.query, instrument.timeout_s);
  const auto value = number(answer);
  if (!value)
    throw InstrumentError(FaultKind::kUnexpected, instrument.name,
                          fmt::format("\"{}\" to {}: expected a number", answer, reading.query));
  const double si = *value * reading.unit.factor;
  if (!(si >= reading.low_si && si <= reading.high_si))
    throw InstrumentError(
        FaultKind::kOutOfRange, instrument.name,
        fmt::format("{} = {}: expected {} to {}", reading.name, show_quantity(si, reading.unit.base),
                    show_quantity(reading.low_si, reading.unit.base),
                    show_quantity(reading.high_si, reading.unit.base)));
  return si;
}

std::vector<std::string> Instruments::make_safe() {
  std::vector<std::string> complaints;
  for (const Instrument& instrument : laboratory_.instruments) {
    for (const std::string& command : instrument.safe) {
      try {
        session(instrument).write(command, instrument.timeout_s);
        check_errors(instrument);
      } catch (const std::runtime_error& first) {
        try {  // once more: the first use after a broken connection only finds it out
          session(instrument).write(command, instrument.timeout_s);
          check_errors(instrument);
        } catch (const std::runtime_error& second) {
          complaints.push_back(
              fmt::format("{} could not be made safe (\"{}\"): {}", instrument.name, command, second.what()));
        }
      }
    }
  }
  return complaints;
}

}  // namespace waverig::rig::bench
