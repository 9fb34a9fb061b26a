// A program that a test starts, and that is gone with it: it dies with this object, and with the test itself.
#pragma once
#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tests/campaign/temporary_directory.h"

namespace waverig {

using Seconds = std::chrono::duration<double>;

// True as soon as condition() holds; false where it does not within the time.
template <class Condition>
bool eventually(Condition condition, Seconds patience) {
  const auto end = std::chrono::steady_clock::now() + patience;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

class Process {
 public:
  // stdout and stderr go to files of that name in the directory.
  Process(const TemporaryDirectory& directory, const std::string& name,
          const std::vector<std::string>& command)
      : out_(directory / (name + ".out")), err_(directory / (name + ".err")) {
    std::vector<char*> arguments;
    for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
    arguments.push_back(nullptr);
    const std::string out = out_.string(), err = err_.string();
    const pid_t parent = ::getpid();
    pid_ = ::fork();
    if (pid_ != 0) return;
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(127);
    for (const auto& [file, descriptor] : {std::pair{&out, 1}, {&err, 2}}) {
      const int opened = ::open(file->c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
      ::dup2(opened, descriptor);
    }
    ::execv(arguments[0], arguments.data());
    ::_exit(127);
  }
  ~Process() {
    if (status_) return;
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void signal(int number) const {
    if (!status_) ::kill(pid_, number);
  }
  bool running() { return !exit_status(); }
  // Of an ended process, 128 + signal where one ended it.
  std::optional<int> exit_status() {
    int status = 0;
    if (!status_ && ::waitpid(pid_, &status, WNOHANG) == pid_)
      status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return status_;
  }
  // -1 where it still runs after so long.
  int wait(Seconds patience) {
    return eventually([this] { return !running(); }, patience) ? *status_ : -1;
  }
  bool says(const std::string& text, Seconds patience) {
    return eventually([&] { return (out() + err()).find(text) != std::string::npos || !running(); },
                      patience) &&
           (out() + err()).find(text) != std::string::npos;
  }
  std::string out() const { return bytes_of(out_); }
  std::string err() const { return bytes_of(err_); }

 private:
  std::filesystem::path out_, err_;
  pid_t pid_ = -1;
  std::optional<int> status_;
};

}  // namespace waverig
