// Two serial devices joined by a null-modem cable, made of two pseudo-terminals and a relay that a test can
// slow.
#pragma once
#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <string>
#include <thread>
#include <vector>

namespace waverig::motion {

class PtyPair {
 public:
  PtyPair() {
    for (std::size_t i = 0; i < 2; ++i) {
      master_[i] = posix_openpt(O_RDWR | O_NOCTTY);
      grantpt(master_[i]);
      unlockpt(master_[i]);
      name_[i] = ptsname(master_[i]);
      keeper_[i] = open(name_[i].c_str(), O_RDWR | O_NOCTTY);  // so that the master never sees a hang-up
    }
    relay_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }
  ~PtyPair() {
    relay_.request_stop();
    relay_.join();
    for (std::size_t i = 0; i < 2; ++i) {
      close(keeper_[i]);
      close(master_[i]);
    }
  }
  PtyPair(const PtyPair&) = delete;
  PtyPair& operator=(const PtyPair&) = delete;

  const std::string& end(std::size_t i) const { return name_[i]; }
  // Keeps what comes from end 1 until end 0 has sent again, once: a late reply.
  void hold_next_reply() { hold_ = true; }

 private:
  void run(const std::stop_token& stop) {
    std::vector<char> held;
    bool holding = false;
    while (!stop.stop_requested()) {
      std::array<pollfd, 2> waiting{{{master_[0], POLLIN, 0}, {master_[1], POLLIN, 0}}};
      if (poll(waiting.data(), 2, 5) <= 0) continue;
      for (std::size_t i = 0; i < 2; ++i) {
        if ((waiting[i].revents & POLLIN) == 0) continue;
        std::array<char, 512> bytes{};
        const ssize_t n = read(master_[i], bytes.data(), bytes.size());
        if (n <= 0) continue;
        if (i == 1 && (hold_.exchange(false) || holding)) {
          holding = true;
          held.insert(held.end(), bytes.begin(), bytes.begin() + n);
          continue;
        }
        if (i == 0 && holding) {
          holding = false;
          put(0, held.data(), held.size());
          held.clear();
        }
        put(1 - i, bytes.data(), static_cast<std::size_t>(n));
      }
    }
  }
  void put(std::size_t to, const char* bytes, std::size_t size) {
    for (std::size_t done = 0; done < size;) {
      const ssize_t n = write(master_[to], bytes + done, size - done);
      if (n <= 0) return;
      done += static_cast<std::size_t>(n);
    }
  }

  std::array<int, 2> master_{}, keeper_{};
  std::array<std::string, 2> name_;
  std::atomic<bool> hold_ = false;
  std::jthread relay_;
};

}  // namespace waverig::motion
