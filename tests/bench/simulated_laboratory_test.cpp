// The simulated laboratory over its real transports, and independent clients talking to it.
#include "rig/bench/simulation/simulated_laboratory.h"

#include <gtest/gtest.h>
#include <netdb.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>

#include "rig/acquisition/serial_port.h"
#include "rig/bench/session.h"

namespace waverig::rig::bench {
namespace {

const std::filesystem::path kSequences = std::filesystem::path(WAVERIG_SOURCE_DIR) / "rig" / "sequences";

// Bench and laboratory in virtual time, without a sequence.
struct Pair {
  Laboratory laboratory = load_laboratory(kSequences / "laboratory.toml");
  VirtualTime time{1'000'000'000};
  SimulatedLaboratory simulated;
  Laboratory addressed;
  Reactor reactor{&time};
  std::shared_ptr<PrologixGateway> rack;

  explicit Pair(SimulationSettings settings = {})
      : simulated(settings, laboratory, &time, time.now()), addressed(simulated.addressed()) {
    const Address gateway = parse_address(addressed.gateways.front().address, "gateway");
    rack = std::make_shared<PrologixGateway>(reactor, "rack", gateway.host, gateway.port);
  }
  std::string address(const std::string& instrument, const std::string& scheme) const {
    for (const auto& e : simulated.endpoints())
      if (e.instrument == instrument && e.address.starts_with(scheme)) return e.address;
    return {};
  }
  std::unique_ptr<Session> raw(const std::string& instrument) {
    const Address a = parse_address(address(instrument, "tcp"), instrument);
    return std::make_unique<ScpiTcpSession>(reactor, instrument, a.host, a.port);
  }
};

TEST(SimulatedLaboratory, AnswersOnRawScpi) {
  Pair pair;
  const auto calibrator = pair.raw("calibrator");
  EXPECT_NE(calibrator->query("*IDN?", 3).find("CAL-2A"), std::string::npos);
  calibrator->write("SOUR:CURR:RANG 0.0022", 3);
  calibrator->write("source:current 0.002", 3);
  EXPECT_EQ(std::stod(calibrator->query("SOUR:CURR?", 3)), 0.002);
  EXPECT_EQ(calibrator->query("SYST:ERR?", 3), "+0,\"No error\"");
}

TEST(SimulatedLaboratory, KeepsAnErrorQueue) {
  Pair pair;
  const auto calibrator = pair.raw("calibrator");
  calibrator->write("SOUR:CURR -0.001", 3);   // it sources only
  calibrator->write("NO:SUCH 1", 3);
  EXPECT_TRUE(calibrator->query("SYST:ERR?", 3).starts_with("-222"));
  EXPECT_TRUE(calibrator->query("SYST:ERR?", 3).starts_with("-113"));
  EXPECT_TRUE(calibrator->query("SYST:ERR?", 3).starts_with("+0"));
}

TEST(SimulatedLaboratory, FourteenInstrumentsAnswerBehindOneGateway) {
  Pair pair;
  int answered = 0;
  for (const Instrument& instrument : pair.laboratory.instruments) {
    const Address address = parse_address(instrument.address, instrument.name);
    if (address.scheme != "gpib") continue;
    GpibSession session(pair.rack, instrument.name, std::stoi(address.path));
    EXPECT_NE(session.query("*IDN?", 3).find(instrument.identity), std::string::npos) << instrument.name;
    ++answered;
  }
  EXPECT_EQ(answered, 14);
}

TEST(SimulatedLaboratory, AnAbsentGpibInstrumentIsSilenceAndTheNextOneStillAnswers) {
  Pair pair;
  GpibSession absent(pair.rack, "absent", 17), calibrator(pair.rack, "calibrator", 4);
  const std::int64_t before = pair.reactor.now();
  try {
    absent.query("*IDN?", 3);
    FAIL() << "an answer from nobody";
  } catch (const InstrumentError& error) {
    EXPECT_EQ(error.kind, FaultKind::kTimeout);
    EXPECT_EQ(error.instrument, "absent");
  }
  EXPECT_EQ(pair.reactor.now() - before, 3'000'000);   // silence takes exactly the time-out
  EXPECT_NE(calibrator.query("*IDN?", 3).find("CAL-2A"), std::string::npos);
}

TEST(SimulatedLaboratory, ALateAnswerArrivesAtItsVirtualTimeAndIsNotTakenForTheNextOne) {
  SimulationSettings settings;
  settings.faults = {{"dmm", FaultType::kSlow, 0, 20, 5.0}};
  Pair pair(settings);
  const auto dmm = pair.raw("dmm");
  EXPECT_THROW(dmm->query("*IDN?", 3), InstrumentError);
  EXPECT_EQ(pair.reactor.now(), 1'000'000'000 + 3'000'000);
  const std::int64_t before = pair.reactor.now();
  EXPECT_NE(dmm->query("*IDN?", 10).find("34401A"), std::string::npos);
  EXPECT_EQ(pair.reactor.now() - before, 5'000'000);
  pair.reactor.sleep_until(pair.reactor.now() + 20'000'000);
  EXPECT_EQ(dmm->query("*OPC?", 3), "1");
}

TEST(SimulatedLaboratory, AHungInstrumentAndACutGatewayAreNamed) {
  SimulationSettings settings;
  settings.faults = {{"calibrator", FaultType::kHang, 0, 60, 0}, {"rack", FaultType::kDisappear, 100, 200, 0}};
  Pair pair(settings);
  GpibSession calibrator(pair.rack, "calibrator", 4), chamber(pair.rack, "chamber", 9);
  const auto kind_of = [](GpibSession& session) {
    try {
      session.query("*IDN?", 2);
    } catch (const InstrumentError& error) {
      return std::string(name_of(error.kind));
    }
    return std::string("fine");
  };
  EXPECT_EQ(kind_of(calibrator), "no answer in time");
  EXPECT_EQ(kind_of(chamber), "fine");
  pair.reactor.sleep_until(1'000'000'000 + 61'000'000);
  EXPECT_EQ(kind_of(calibrator), "fine");
  pair.reactor.sleep_until(1'000'000'000 + 101'000'000);
  EXPECT_EQ(kind_of(chamber), "connection lost");
  pair.reactor.sleep_until(1'000'000'000 + 201'000'000);
  EXPECT_EQ(kind_of(chamber), "fine");
}

TEST(SimulatedLaboratory, SpeaksVxi11ToLiblxi) {
  Pair pair;
  if (!pair.simulated.has_vxi11()) GTEST_SKIP() << "no right to the port mapper's port 111";
  if (::getservbyname("sunrpc", "tcp") == nullptr) GTEST_SKIP() << "the RPC library finds no port mapper without /etc/services";
  const Address a = parse_address(pair.address("generator", "vxi11"), "generator");
  Vxi11Session generator(pair.reactor, "generator", a.host, a.path);
  EXPECT_NE(generator.query("*IDN?", 3).find("GENERATOR"), std::string::npos);
  generator.write("SOUR:FREQ 2e6", 3);
  EXPECT_EQ(std::stod(generator.query("SOUR:FREQ?", 3)), 2e6);
  EXPECT_THROW(generator.query("SOUR:FREQ 1e6", 2), InstrumentError);   // a command has no answer
  EXPECT_EQ(std::stod(generator.query("SOUR:FREQ?", 3)), 1e6);
}

TEST(SimulatedLaboratory, StreamsCheckedFramesInVirtualTime) {
  Pair pair;
  GpibSession supply(pair.rack, "supply", 5);
  supply.write("SOUR:VOLT 28", 3);
  supply.write("OUTP 1", 3);
  supply.query("*OPC?", 3);
  const Address a = parse_address(pair.address("counts", "serial"), "counts");
  SerialPort port("/" + a.path, 921600);
  FrameDecoder decoder(pair.laboratory.port("counts")->layout);
  std::vector<std::int64_t> ticks;
  pair.reactor.serve(port.descriptor(), [&] {
    std::array<std::uint8_t, 65536> buffer;
    const auto got = port.read(buffer, 0);
    pair.time.received(VirtualTime::serial_cable(a.path), static_cast<std::int64_t>(got.size()));
    decoder.add(got);
    while (const Frame* frame = decoder.next()) ticks.push_back(frame->raw[1]);
  });
  const std::string command = "RATE 100\n";
  pair.time.sent(VirtualTime::serial_cable(a.path), static_cast<std::int64_t>(command.size()));
  port.write({reinterpret_cast<const std::uint8_t*>(command.data()), command.size()}, 1000);
  pair.reactor.sleep_until(pair.reactor.now() + 100'000'000);
  ASSERT_GE(ticks.size(), 9990U);
  for (std::size_t i = 1; i < ticks.size(); ++i) ASSERT_EQ(ticks[i], ticks[i - 1] + 1);
  EXPECT_EQ(decoder.statistics().broken, 0);
  pair.reactor.forget(port.descriptor());
}

// The output of a program that is not ours, or nothing where it is not installed.
std::string witness(const std::string& command) {
  std::string output;
  std::FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return output;
  std::array<char, 256> bytes;
  while (std::fgets(bytes.data(), bytes.size(), pipe) != nullptr) output += bytes.data();
  ::pclose(pipe);
  return output;
}

bool installed(const std::string& program) { return !witness("command -v " + program).empty(); }

TEST(IndependentClient, LxiToolsReadTheInstruments) {
  if (!installed("lxi")) GTEST_SKIP() << "lxi-tools is not installed";
  const Laboratory laboratory = load_laboratory(kSequences / "laboratory.toml");
  SimulatedLaboratory simulated({}, laboratory, nullptr, 0);
  for (const auto& e : simulated.endpoints()) {
    const Address a = parse_address(e.address, e.instrument);
    if (e.instrument == "chamber" && a.scheme == "tcp") {
      EXPECT_NE(witness("timeout 20 lxi scpi -r -a 127.0.0.1 -p " + std::to_string(a.port) + " '*IDN?'").find("CHAMBER-60"),
                std::string::npos);
    }
    if (e.instrument == "chamber" && a.scheme == "vxi11" && ::getservbyname("sunrpc", "tcp") != nullptr) {
      EXPECT_NE(witness("timeout 20 lxi scpi -a " + a.host + " '*IDN?'").find("CAL-2A"), std::string::npos);   // inst0
    }
  }
}

TEST(IndependentClient, SigrokReadsTheMultimeter) {
  if (!installed("sigrok-cli")) GTEST_SKIP() << "sigrok-cli is not installed";
  const Laboratory laboratory = load_laboratory(kSequences / "laboratory.toml");
  SimulatedLaboratory simulated({}, laboratory, nullptr, 0);
  Reactor reactor(nullptr);
  const auto tell = [&](const std::string& name, const std::vector<std::string>& commands) {
    for (const auto& e : simulated.endpoints()) {
      const Address a = parse_address(e.address, e.instrument);
      if (e.instrument != name || a.scheme != "tcp") continue;
      ScpiTcpSession session(reactor, name, a.host, a.port);
      for (const std::string& command : commands) session.write(command, 3);
      EXPECT_EQ(session.query("*OPC?", 3), "1");
    }
  };
  tell("calibrator", {"SOUR:CURR:RANG 0.022", "SOUR:CURR 0.0125", "OUTP ON"});
  tell("switch", {"ROUT:MET ON"});
  reactor.sleep_until(reactor.now() + 2'000'000);   // ten time constants of the calibrator's output
  for (const auto& e : simulated.endpoints()) {
    if (e.instrument != "dmm" || !e.address.starts_with("tcp")) continue;
    const Address a = parse_address(e.address, e.instrument);
    const std::string output =
        witness("timeout 30 sigrok-cli --driver scpi-dmm:conn=tcp-raw/127.0.0.1/" + std::to_string(a.port) + " --samples 2");
    const std::size_t at = output.find("P1: ");
    ASSERT_NE(at, std::string::npos) << output;
    EXPECT_NEAR(std::stod(output.substr(at + 4)), 12.5, 0.01) << output;
  }
}

}  // namespace
}  // namespace waverig::rig::bench
