#include "rig/bench/simulation/laboratory_server.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>

#include "lcmtypes/error.h"

namespace waverig::rig::bench {
namespace {

constexpr int kFramesAtOnce = 300;             // made before the line is written to
constexpr std::size_t kLineBacklog = 1 << 16;  // in real time an unread line loses what is beyond
constexpr std::size_t kInputMax = 1 << 20;

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error(what + ": " + std::strerror(errno));
}

sockaddr_in address_of(const std::string& host, int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  ::inet_pton(AF_INET, host.c_str(), &address.sin_addr);
  return address;
}

std::int64_t steady_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace

Descriptor::~Descriptor() {
  if (number_ >= 0) ::close(number_);
}

LaboratoryServer::LaboratoryServer(const SimulationSettings& settings, const Laboratory& laboratory,
                                   VirtualTime* time, std::int64_t start_utime)
    : faults_(settings.faults),
      gateway_name_(laboratory.gateways.empty() ? "" : laboratory.gateways.front().name),
      counts_port_(laboratory.unit.counts_port),
      monitor_port_(laboratory.unit.monitor_port),
      time_(time),
      real_offset_us_(start_utime - steady_us()),
      world_(settings.world, start_utime, laboratory.port(counts_port_)->layout,
             laboratory.port(monitor_port_)->layout),
      rack_(laboratory, world_, faults_) {
  listeners_.push_back(listen_on(Listener::Kind::kGateway, 0, "127.0.0.1", 0));
  for (std::size_t i = 0; i < rack_.size(); ++i)
    listeners_.push_back(listen_on(Listener::Kind::kScpi, i, "127.0.0.1", 0));
  open_vxi11();
  lines_.push_back(open_line(counts_port_));
  lines_.push_back(open_line(monitor_port_));
}

LaboratoryServer::Listener LaboratoryServer::listen_on(Listener::Kind kind, std::size_t device,
                                                       const std::string& host, int port) {
  Descriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const int on = 1;
  ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  sockaddr_in address = address_of(host, port);
  socklen_t size = sizeof address;
  if (!socket || ::bind(socket.get(), reinterpret_cast<sockaddr*>(&address), size) < 0 ||
      ::listen(socket.get(), 16) < 0 ||
      ::getsockname(socket.get(), reinterpret_cast<sockaddr*>(&address), &size) < 0)
    fail(fmt::format("simulated laboratory: {}:{}", host, port));
  return {kind, device, std::move(socket), ntohs(address.sin_port)};
}

// Each simulated laboratory has a loopback address of its own, so that several can have the fixed port.
void LaboratoryServer::open_vxi11() {
  const auto seed = static_cast<unsigned>(::getpid());
  for (unsigned attempt = 0; attempt < 64; ++attempt) {
    const unsigned n = seed * 64 + attempt;
    const std::string host = fmt::format("127.{}.{}.{}", 64 + (n >> 16) % 64, (n >> 8) % 256, 1 + n % 254);
    Descriptor udp(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    sockaddr_in address = address_of(host, 111);
    if (!udp || ::bind(udp.get(), reinterpret_cast<sockaddr*>(&address), sizeof address) < 0) {
      if (errno == EACCES) return;  // no right to the port: no VXI-11
      continue;
    }
    try {
      Listener mapper = listen_on(Listener::Kind::kPortMapper, 0, host, 111);
      Listener core = listen_on(Listener::Kind::kVxi11, 0, host, 0);
      vxi11_port_ = core.port;
      listeners_.push_back(std::move(mapper));
      listeners_.push_back(std::move(core));
      port_mapper_udp_ = std::move(udp);
      vxi11_host_ = host;
      return;
    } catch (const std::runtime_error&) {
      continue;  // taken by somebody else: the next address
    }
  }
}

LaboratoryServer::SerialLine LaboratoryServer::open_line(const std::string& name) const {
  SerialLine line;
  line.name = name;
  line.master = Descriptor(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  std::array<char, 128> path{};
  if (!line.master || ::grantpt(line.master.get()) < 0 || ::unlockpt(line.master.get()) < 0 ||
      ::ptsname_r(line.master.get(), path.data(), path.size()) != 0)
    fail("simulated laboratory: pseudo-terminal");
  line.path = path.data();
  line.cable = VirtualTime::serial_cable(line.path);
  line.held = Descriptor(::open(path.data(), O_RDWR | O_NOCTTY | O_CLOEXEC));
  termios mode{};
  ::tcgetattr(line.master.get(), &mode);
  ::cfmakeraw(&mode);
  ::tcsetattr(line.master.get(), TCSANOW, &mode);  // nothing is echoed before the bench opens its side
  return line;
}

std::int64_t LaboratoryServer::now() const {
  return time_ != nullptr ? time_->now() : steady_us() + real_offset_us_;
}

void LaboratoryServer::run(const std::atomic<bool>& stop, int stop_descriptor) {
  bool caught_up = true;
  while (!stop.load()) {
    std::vector<pollfd> waiting;
    waiting.push_back({stop_descriptor, POLLIN, 0});
    if (time_ != nullptr) waiting.push_back({time_->wake_descriptor(), POLLIN, 0});
    if (port_mapper_udp_) waiting.push_back({port_mapper_udp_.get(), POLLIN, 0});
    for (const Listener& l : listeners_) waiting.push_back({l.socket.get(), POLLIN, 0});
    for (const Connection& c : connections_) waiting.push_back({c.socket.get(), POLLIN, 0});
    for (const SerialLine& l : lines_)
      waiting.push_back(
          {l.master.get(), static_cast<short>(l.pending.empty() ? POLLIN : POLLIN | POLLOUT), 0});
    int timeout_ms = caught_up ? -1 : 50;
    if (time_ == nullptr) {
      const std::int64_t due_ms = (next_due() - now()) / 1000;
      timeout_ms = static_cast<int>(std::clamp<std::int64_t>(due_ms, 0, 10));
    }
    ::poll(waiting.data(), waiting.size(), timeout_ms);
    if (time_ != nullptr) {
      time_->busy();
      time_->clear_wake();
    }
    const std::lock_guard lock(mutex_);
    serve(waiting);
    caught_up = move_world();
    for (Connection& c : connections_) send_due(c);
    connections_.remove_if([](const Connection& c) { return c.gone; });
    if (time_ != nullptr && caught_up) time_->idle(next_due());
  }
}

void LaboratoryServer::serve(const std::vector<pollfd>& ready) {
  // First the world as it is now: a command acts from now on.
  move_world();
  for (const pollfd& w : ready) {
    if (w.revents == 0 || w.fd < 0) continue;
    if (w.fd == port_mapper_udp_.get()) answer_port_mapper();
    for (const Listener& l : listeners_)
      if (w.fd == l.socket.get()) accept_from(l);
    for (Connection& c : connections_)
      if (!c.gone && w.fd == c.socket.get()) receive(c);
    for (SerialLine& l : lines_)
      if (w.fd == l.master.get() && (w.revents & POLLIN) != 0) take_commands(l);
  }
  for (Connection& c : connections_)
    if (!c.gone && cut(c)) close(c);
}

void LaboratoryServer::accept_from(const Listener& listener) {
  Connection c;
  sockaddr_in peer{};
  socklen_t size = sizeof peer;
  c.socket = Descriptor(::accept4(listener.socket.get(), reinterpret_cast<sockaddr*>(&peer), &size,
                                  SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (!c.socket) return;
  const int on = 1;
  ::setsockopt(c.socket.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  c.kind = listener.kind;
  c.device = listener.device;
  if (time_ != nullptr && (c.kind == Listener::Kind::kScpi || c.kind == Listener::Kind::kGateway))
    c.cable = ntohs(peer.sin_port);
  if (c.kind == Listener::Kind::kGateway) c.prologix = std::make_unique<PrologixSide>(rack_);
  if (c.kind == Listener::Kind::kVxi11) c.vxi11 = std::make_unique<Vxi11Side>(rack_, time_);
  connections_.push_back(std::move(c));
}

void LaboratoryServer::answer_port_mapper() {
  std::array<char, 1024> call;
  sockaddr_in from{};
  socklen_t size = sizeof from;
  const ssize_t got = ::recvfrom(port_mapper_udp_.get(), call.data(), call.size(), 0,
                                 reinterpret_cast<sockaddr*>(&from), &size);
  if (got <= 0) return;
  const std::string reply = port_mapper_reply({call.data(), static_cast<std::size_t>(got)}, vxi11_port_);
  if (!reply.empty())
    ::sendto(port_mapper_udp_.get(), reply.data(), reply.size(), 0, reinterpret_cast<sockaddr*>(&from), size);
}

void LaboratoryServer::close(Connection& connection) {
  if (connection.cable != 0) time_->closed(connection.cable);
  connection.gone = true;
  connection.socket = Descriptor();
}

bool LaboratoryServer::cut(const Connection& c) const {
  const double time_s = world_.state().time_s;
  if (c.kind == Listener::Kind::kGateway)
    return active(faults_, gateway_name_, FaultType::kDisappear, time_s) != nullptr;
  return c.kind == Listener::Kind::kScpi && !rack_.present(c.device);
}

void LaboratoryServer::receive(Connection& connection) {
  std::array<char, 16384> bytes;
  while (!connection.gone) {
    const ssize_t got = ::recv(connection.socket.get(), bytes.data(), bytes.size(), 0);
    if (got < 0 && (errno == EAGAIN || errno == EINTR)) return;
    if (got <= 0) {
      close(connection);
      return;
    }
    if (connection.cable != 0) time_->received(connection.cable, got);
    handle(connection, {bytes.data(), static_cast<std::size_t>(got)});
  }
}

void LaboratoryServer::handle(Connection& c, std::string_view bytes) {
  if (c.prologix) {
    c.prologix->receive(bytes, now(), c.answers);
  } else if (c.vxi11) {
    if (!c.vxi11->receive(bytes, now(), c.answers)) close(c);
  } else if (c.kind == Listener::Kind::kPortMapper) {
    c.input += bytes;
    while (c.input.size() >= 4) {
      std::size_t size = 0;
      for (std::size_t i = 0; i < 4; ++i) size = (size << 8) | static_cast<std::uint8_t>(c.input[i]);
      size &= 0x7FFFFFFF;
      if (size > 4096) return close(c);
      if (c.input.size() < 4 + size) return;
      const std::string reply = port_mapper_reply(std::string_view(c.input).substr(4, size), vxi11_port_);
      c.input.erase(0, 4 + size);
      if (reply.empty()) return close(c);
      c.answers.push_back({marked(reply), now()});
    }
  } else {
    c.input += bytes;
    for (std::size_t end; (end = c.input.find('\n')) != std::string::npos; c.input.erase(0, end + 1)) {
      std::string line = c.input.substr(0, end);
      if (line.ends_with('\r')) line.pop_back();
      if (std::optional<Answer> answer = rack_.tell(c.device, line, now())) {
        answer->text += "\n";
        c.answers.push_back(std::move(*answer));
      }
    }
    if (c.input.size() > kInputMax) close(c);
  }
}

void LaboratoryServer::send_due(Connection& c) {
  for (auto answer = c.answers.begin(); !c.gone && answer != c.answers.end();) {
    if (answer->due_utime > now()) {
      ++answer;
      continue;
    }
    if (c.cable != 0) time_->sent(c.cable, static_cast<std::int64_t>(answer->text.size()));
    const ssize_t put = ::send(c.socket.get(), answer->text.data(), answer->text.size(), MSG_NOSIGNAL);
    const auto size = static_cast<ssize_t>(answer->text.size());
    if (put != size) {  // answers are short: a client that does not take one is not listening
      close(c);
      return;
    }
    answer = c.answers.erase(answer);
  }
}

void LaboratoryServer::take_commands(SerialLine& line) {
  std::array<char, 1024> bytes;
  const ssize_t got = ::read(line.master.get(), bytes.data(), bytes.size());
  if (got <= 0) return;
  if (time_ != nullptr) time_->received(line.cable, got);
  line.commands.append(bytes.data(), static_cast<std::size_t>(got));
  for (std::size_t end; (end = line.commands.find('\n')) != std::string::npos;
       line.commands.erase(0, end + 1))
    unit_command(world_, std::string_view(line.commands).substr(0, end));
  if (line.commands.size() > kInputMax) line.commands.clear();
}

void LaboratoryServer::apply_faults() {
  const double time_s = world_.state().time_s;
  const auto value = [&](std::string_view device, FaultType type) {
    const Fault* fault = active(faults_, device, type, time_s);
    return fault != nullptr ? fault->value : 0.0;
  };
  world_.controls.frame_corruption = value(counts_port_, FaultType::kCorrupt);
  world_.controls.chamber.hunting_degC = value("chamber", FaultType::kHunt);
}

bool LaboratoryServer::move_world() {
  bool reached = false;
  bool written = true;
  while (written && !reached) {
    apply_faults();
    reached = world_.advance_to(now(), kFramesAtOnce);
    written = flush(lines_[0], world_.counts_line) && flush(lines_[1], world_.monitor_line);
  }
  return reached && written;
}

// True: all of it is on the line.
bool LaboratoryServer::flush(SerialLine& line, std::vector<std::uint8_t>& bytes) {
  if (active(faults_, line.name, FaultType::kSilent, world_.state().time_s) != nullptr) bytes.clear();
  if (line.pending.empty()) {
    line.pending.swap(bytes);
    if (time_ != nullptr) time_->sent(line.cable, static_cast<std::int64_t>(line.pending.size()));
  } else if (!bytes.empty() && (time_ != nullptr || line.pending.size() < kLineBacklog)) {
    if (time_ != nullptr) time_->sent(line.cable, static_cast<std::int64_t>(bytes.size()));
    line.pending.insert(line.pending.end(), bytes.begin(), bytes.end());
  }
  bytes.clear();
  while (line.written < line.pending.size()) {
    const ssize_t put =
        ::write(line.master.get(), line.pending.data() + line.written, line.pending.size() - line.written);
    if (put <= 0) return false;
    line.written += static_cast<std::size_t>(put);
  }
  line.pending.clear();
  line.written = 0;
  return true;
}

std::int64_t LaboratoryServer::next_due() const {
  std::int64_t due = VirtualTime::kNever;
  for (const Connection& c : connections_)
    for (const Answer& answer : c.answers) due = std::min(due, answer.due_utime);
  return due;
}

}  // namespace waverig::rig::bench
