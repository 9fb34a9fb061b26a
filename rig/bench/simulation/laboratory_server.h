// LaboratoryServer: the loop behind SimulatedLaboratory.
#pragma once
#include <poll.h>

#include <atomic>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "rig/bench/simulation/prologix_side.h"
#include "rig/bench/simulation/rack.h"
#include "rig/bench/simulation/vxi11_side.h"

namespace waverig::rig::bench {

// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor();
  int get() const { return number_; }
  explicit operator bool() const { return number_ >= 0; }

 private:
  int number_;
};

class LaboratoryServer {
 public:
  LaboratoryServer(const SimulationSettings& settings, const Laboratory& laboratory, VirtualTime* time,
                   std::int64_t start_utime);
  // Serves until stop; stop_descriptor wakes it.
  void run(const std::atomic<bool>& stop, int stop_descriptor);

  struct Listener {
    enum class Kind { kScpi, kGateway, kVxi11, kPortMapper } kind;
    std::size_t device = 0;  // of a raw SCPI port
    Descriptor socket;
    int port = 0;
  };
  struct SerialLine {
    std::string name, path;  // of the side that the bench opens
    Descriptor master;
    Descriptor held;  // its other side, held open: a pseudo-terminal without one reports a hang-up for ever
    std::int64_t cable = 0;  // to VirtualTime
    std::string commands;
    std::vector<std::uint8_t> pending;
    std::size_t written = 0;
  };

  const std::vector<Listener>& listeners() const { return listeners_; }
  const std::vector<SerialLine>& lines() const { return lines_; }
  const std::string& vxi11_host() const { return vxi11_host_; }  // empty: none
  const Rack& rack() const { return rack_; }

  std::mutex& mutex() { return mutex_; }
  World& world() { return world_; }

 private:
  struct Connection {
    Listener::Kind kind;
    std::size_t device = 0;
    Descriptor socket;
    std::string input;
    std::vector<Answer> answers;  // each to be sent at its time
    std::unique_ptr<PrologixSide> prologix;
    std::unique_ptr<Vxi11Side> vxi11;
    std::int64_t cable = 0;  // to VirtualTime; 0: it does not count these bytes
    bool gone = false;
  };

  Listener listen_on(Listener::Kind kind, std::size_t device, const std::string& host, int port);
  void open_vxi11();
  SerialLine open_line(const std::string& name) const;

  std::int64_t now() const;
  void serve(const std::vector<pollfd>& ready);
  void accept_from(const Listener& listener);
  void answer_port_mapper();
  void receive(Connection& connection);
  void handle(Connection& connection, std::string_view bytes);
  void send_due(Connection& connection);
  void close(Connection& connection);
  bool cut(const Connection& connection) const;
  void take_commands(SerialLine& line);
  void apply_faults();
  bool move_world();  // true: it has caught up and nothing is left to write
  bool flush(SerialLine& line, std::vector<std::uint8_t>& bytes);
  std::int64_t next_due() const;

  std::vector<Fault> faults_;
  std::string gateway_name_, counts_port_, monitor_port_;
  VirtualTime* time_;
  std::int64_t real_offset_us_ = 0;
  World world_;
  Rack rack_;
  std::vector<Listener> listeners_;
  Descriptor port_mapper_udp_;
  std::string vxi11_host_;
  int vxi11_port_ = 0;
  std::list<Connection> connections_;
  std::vector<SerialLine> lines_;  // counts, monitor
  mutable std::mutex mutex_;
};

}  // namespace waverig::rig::bench
