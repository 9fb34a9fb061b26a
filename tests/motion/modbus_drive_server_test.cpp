// What a client may send to the drive's server, meant or not.
#include "motion/modbus_drive_server.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "motion/kinematics/random.h"
#include "motion/modbus_drive.h"
#include "motion/modbus_registers.h"
#include "tests/motion/modbus_bench.h"

namespace waverig::motion {
namespace {

// Client of a server at `port`, with nothing of libmodbus between it and the wire.
class RawClient {
 public:
  explicit RawClient(int port) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval patience{.tv_sec = 20, .tv_usec = 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    EXPECT_EQ(connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  ~RawClient() { close(socket_); }
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  void send_pdu(std::vector<std::uint8_t> pdu) const {
    const auto size = static_cast<std::uint8_t>(pdu.size() + 1);
    const std::array<std::uint8_t, 7> header{0, 1, 0, 0, 0, size, 1};
    pdu.insert(pdu.begin(), header.begin(), header.end());
    send_bytes(pdu);
  }
  void send_bytes(std::span<const std::uint8_t> bytes) const {
    send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }
  ssize_t receive() const {  // 0 where the server has hung up
    std::array<std::uint8_t, 300> reply{};
    return recv(socket_, reply.data(), reply.size(), 0);
  }

 private:
  int socket_;
};

TEST(ModbusDriveServer, SurvivesHostileBytesAndServesTheOthers) {
  Bench bench({.port = 0, .response_timeout_s = 10, .byte_timeout_s = 0.02});
  ModbusDrive remote(patient(bench.port()));
  RandomStream random(5, "hostile");
  for (int trial = 0; trial < 60; ++trial) {
    const RawClient client(bench.port());
    std::array<std::uint8_t, 300> bytes{};
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random.bits());
    // Every other one a plausible header: protocol 0, unit 1, a function that writes, wild addresses and
    // counts.
    constexpr std::uint8_t kFunctions[] = {0x06, 0x10, 0x16, 0x17};
    if (trial % 2 == 0) {
      bytes[2] = bytes[3] = bytes[4] = 0;
      bytes[6] = 1;
      bytes[7] = kFunctions[(trial / 2) % 4];
      if (trial % 4 == 0) bytes[8] = bytes[10] = bytes[12] = bytes[14] = 0;
    }
    const auto size = static_cast<std::size_t>(random.uniform(1, 300));
    client.send_bytes({bytes.data(), size});
    const auto sequence = static_cast<std::uint16_t>(trial + 1);
    ASSERT_EQ(remote.exchange({.sequence = sequence}).sequence, sequence);
  }
}

// Function 17h: read `read_count` from `read_address`, write `written` words, the controlword first a
// shutdown.
std::vector<std::uint8_t> write_and_read(int read_address, int read_count, int write_address, int write_count,
                                         int told_bytes, int words) {
  const auto high = [](int x) { return static_cast<std::uint8_t>(x >> 8); };
  const auto low = [](int x) { return static_cast<std::uint8_t>(x & 0xff); };
  std::vector<std::uint8_t> pdu{0x17};
  for (const int word : {read_address, read_count, write_address, write_count}) {
    pdu.push_back(high(word));
    pdu.push_back(low(word));
  }
  pdu.push_back(low(told_bytes));
  for (int i = 0; i < words; ++i) {
    pdu.push_back(0);
    pdu.push_back(controlword::kShutdown);
  }
  return pdu;
}

TEST(ModbusDriveServer, ARequestThatIsNotWholeAndWithinTheMapCommandsNothing) {
  SimulatedDrive drive;
  ModbusDriveServer server(drive, patient(), [] { return std::int64_t{0}; });
  const RawClient client(server.port());
  server.serve(10000);  // takes the connection
  const auto state_after = [&](const std::vector<std::uint8_t>& pdu) {
    client.send_pdu(pdu);
    server.serve(10000);
    EXPECT_GT(client.receive(), 0);
    return drive.state();
  };
  EXPECT_EQ(state_after(write_and_read(100, 14, 0, 2, 4, 2)), DriveState::kSwitchOnDisabled);  // reads beyond
  EXPECT_EQ(state_after(write_and_read(100, 13, 0, 114, 228, 114)), DriveState::kSwitchOnDisabled);
  EXPECT_EQ(state_after(write_and_read(100, 13, 0, 3, 4, 2)), DriveState::kSwitchOnDisabled);
  EXPECT_EQ(state_after(write_and_read(100, 13, 0, 2, 4, 2)), DriveState::kReadyToSwitchOn);
}

TEST(ModbusDriveServer, ServesSoManyClientsAndNoMore) {
  SimulatedDrive drive;
  ModbusDriveServer server(drive, patient(), [] { return std::int64_t{0}; });
  std::vector<std::unique_ptr<RawClient>> clients;
  for (std::size_t i = 0; i < ModbusDriveServer::kMostClients + 1; ++i) {
    clients.push_back(std::make_unique<RawClient>(server.port()));
    server.serve(10000);
  }
  EXPECT_EQ(clients.back()->receive(), 0);
  clients.front()->send_pdu({0x03, 0, 100, 0, 13});
  server.serve(10000);
  EXPECT_GT(clients.front()->receive(), 0);
}

TEST(ModbusDriveServer, ASilentDriveAnswersNobody) {
  Bench bench;
  bench.rest();
  bench.drive.faults.silent = true;
  bench.begin();
  ModbusLinkSettings impatient = patient(bench.port());
  impatient.response_timeout_s = 0.1;
  const ModbusContext reader = make_modbus_context(impatient);
  ASSERT_EQ(modbus_connect(reader.get()), 0);
  registers::FeedbackWords words{};
  EXPECT_EQ(modbus_read_registers(reader.get(), registers::kFeedbackAddress, registers::kFeedbackCount,
                                  words.data()),
            -1);
}

TEST(ModbusDriveServer, IsReadAndCommandedByAnIndependentClient) {
  if (std::system("command -v mbpoll > /dev/null 2>&1") != 0) GTEST_SKIP() << "mbpoll is not installed";
  Bench bench;
  const auto mbpoll = [&](const std::string& arguments) {
    const std::string command =
        "mbpoll -0 -1 -q -o 10 -m tcp -a 1 -p " + std::to_string(bench.port()) + " " + arguments + " 2>&1";
    std::string output;
    std::FILE* pipe = popen(command.c_str(), "r");
    if (!pipe) return output;
    std::array<char, 256> line{};
    while (std::fgets(line.data(), static_cast<int>(line.size()), pipe)) output += line.data();
    pclose(pipe);
    return output;
  };
  // Switch on disabled, then ready to switch on after shutdown (6) was written to the controlword.
  EXPECT_NE(mbpoll("-t 4:hex -r 105 -c 1 127.0.0.1").find("0x0040"), std::string::npos);
  const std::string written = mbpoll("-t 4 -r 1 127.0.0.1 6");
  EXPECT_NE(written.find("Written 1 references"), std::string::npos) << written;
  const std::string after = mbpoll("-t 4:hex -r 105 -c 1 127.0.0.1");
  EXPECT_NE(after.find("0x0021"), std::string::npos) << after;
}

}  // namespace
}  // namespace waverig::motion
