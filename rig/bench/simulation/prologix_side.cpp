#include "rig/bench/simulation/prologix_side.h"

#include <charconv>

namespace waverig::rig::bench {
namespace {

constexpr std::size_t kLineMax = 65536;

int number_in(std::string_view text, int low, int high, int fallback) {
  int value = fallback;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && value >= low && value <= high ? value : fallback;
}

}  // namespace

void PrologixSide::receive(std::string_view bytes, std::int64_t now_utime, std::vector<Answer>& out) {
  for (const char c : bytes) {
    if (escape_) {
      buffer_ += c;
      line_escaped_ = line_escaped_ || buffer_.size() == 1;
      escape_ = false;
    } else if (c == '\x1b') {
      escape_ = true;
    } else if (c == '\n' || c == '\r') {
      if (!buffer_.empty()) line(buffer_, line_escaped_, now_utime, out);
      buffer_.clear();
      line_escaped_ = false;
    } else if (buffer_.size() < kLineMax) {
      buffer_ += c;
    }
  }
}

void PrologixSide::line(const std::string& text, bool escaped, std::int64_t now_utime,
                        std::vector<Answer>& out) {
  if (!escaped && text.starts_with("++")) {
    command(text.substr(2), now_utime, out);
    return;
  }
  const auto index = rack_.at_gpib(address_);
  if (!index) return;
  if (std::optional<Answer> answer = rack_.tell(*index, text, now_utime))
    waiting_[address_] = std::move(*answer);
  if (auto_) read(now_utime, out);
}

void PrologixSide::read(std::int64_t now_utime, std::vector<Answer>& out) {
  const auto found = waiting_.find(address_);
  if (found == waiting_.end()) return;
  if (found->second.due_utime - now_utime > std::int64_t{1000} * read_timeout_ms_)
    return;  // it gave up before
  found->second.text += "\n";
  out.push_back(std::move(found->second));
  waiting_.erase(found);
}

void PrologixSide::command(const std::string& text, std::int64_t now_utime, std::vector<Answer>& out) {
  const std::size_t space = text.find(' ');
  const std::string word = text.substr(0, space),
                    argument = space == std::string::npos ? "" : text.substr(space + 1);
  const auto say = [&](const std::string& answer) { out.push_back({answer + "\r\n", now_utime}); };
  if (word == "addr") {
    if (argument.empty())
      say(std::to_string(address_));
    else
      address_ = number_in(argument, 0, 30, address_);
  } else if (word == "auto") {
    if (argument.empty())
      say(auto_ ? "1" : "0");
    else
      auto_ = argument == "1";
  } else if (word == "read_tmo_ms") {
    if (argument.empty())
      say(std::to_string(read_timeout_ms_));
    else
      read_timeout_ms_ = number_in(argument, 1, 3000, read_timeout_ms_);
  } else if (word == "read") {
    read(now_utime, out);
  } else if (word == "clr") {
    waiting_.erase(address_);
  } else if (word == "ver") {
    say("waverig simulated GPIB gateway, Prologix protocol");
  } else if (word != "mode" && word != "eoi" && word != "eos" && word != "ifc" && word != "savecfg" &&
             word != "loc" && word != "eot_enable" && word != "eot_char") {
    say("Unrecognized command");
  }
}

}  // namespace waverig::rig::bench
