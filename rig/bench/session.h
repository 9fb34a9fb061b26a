// Session: lines to an instrument and lines back, whatever lies between: raw SCPI over TCP, VXI-11 (liblxi),
// GPIB behind a Prologix-protocol gateway, or a serial port that only listens.
//
// Addresses:  tcp://host:port     vxi11://host/device     gpib://GATEWAY/address     port://PORT
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "rig/bench/instrument_error.h"
#include "rig/bench/reactor.h"

namespace waverig::rig::bench {

class Session {
 public:
  virtual ~Session() = default;
  // Both throw InstrumentError. After a time-out nothing of a late answer reaches the next query.
  virtual void write(const std::string& command, double timeout_s) = 0;
  virtual std::string query(const std::string& command, double timeout_s) = 0;
};

// A TCP stream of lines; reconnects by itself on the next use after a failure.
class TcpLink {
 public:
  TcpLink(Reactor& reactor, std::string who, const std::string& host, int port);
  ~TcpLink() { close(); }
  TcpLink(const TcpLink&) = delete;
  TcpLink& operator=(const TcpLink&) = delete;

  bool connected() const { return descriptor_ >= 0; }
  void connect(double timeout_s);
  void send(std::string_view bytes, double timeout_s);
  std::string read_line(double timeout_s);  // without the line's end
  void close();

 private:
  [[noreturn]] void fail(FaultKind kind, const std::string& what);

  Reactor& reactor_;
  std::string who_, host_;
  int port_;
  int descriptor_ = -1;
  std::int64_t cable_ = 0;  // to VirtualTime
  std::string buffer_;
};

class ScpiTcpSession : public Session {
 public:
  ScpiTcpSession(Reactor& reactor, const std::string& who, const std::string& host, int port)
      : link_(reactor, who, host, port) {}
  void write(const std::string& command, double timeout_s) override;
  std::string query(const std::string& command, double timeout_s) override;

 private:
  TcpLink link_;
};

// One gateway for all its instruments: it remembers whom it speaks to.
class PrologixGateway {
 public:
  PrologixGateway(Reactor& reactor, const std::string& name, const std::string& host, int port)
      : link_(reactor, name, host, port) {}
  void write(int address, const std::string& command, double timeout_s);
  std::string query(int address, const std::string& command, double timeout_s);

 private:
  void address(int address, double timeout_s);

  TcpLink link_;
  int current_ = -1;
};

class GpibSession : public Session {
 public:
  GpibSession(std::shared_ptr<PrologixGateway> gateway, std::string who, int address)
      : gateway_(std::move(gateway)), who_(std::move(who)), address_(address) {}
  void write(const std::string& command, double timeout_s) override;
  std::string query(const std::string& command, double timeout_s) override;

 private:
  std::shared_ptr<PrologixGateway> gateway_;
  std::string who_;
  int address_;
};

class Vxi11Session : public Session {
 public:
  Vxi11Session(Reactor& reactor, std::string who, std::string host, std::string device)
      : reactor_(reactor), who_(std::move(who)), host_(std::move(host)), device_(std::move(device)) {}
  ~Vxi11Session() override { close(); }
  Vxi11Session(const Vxi11Session&) = delete;
  Vxi11Session& operator=(const Vxi11Session&) = delete;
  void write(const std::string& command, double timeout_s) override;
  std::string query(const std::string& command, double timeout_s) override;

 private:
  void connect(double timeout_s);
  void close();

  Reactor& reactor_;
  std::string who_, host_, device_;
  int device_number_ = -1;
};

}  // namespace waverig::rig::bench
