#include "rig/bench/simulation/scpi_device.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>

namespace waverig::rig::bench {
namespace {

constexpr std::size_t kQueueLength = 20;

std::string upper(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return result;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())) != 0) text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.remove_suffix(1);
  return text;
}

std::vector<std::string> split(std::string_view text, char at) {
  std::vector<std::string> parts;
  while (true) {
    const std::size_t end = text.find(at);
    parts.emplace_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

bool matches(const std::string& node, const std::string& word) {
  std::string brief;
  for (const char c : node)
    if (std::islower(static_cast<unsigned char>(c)) == 0) brief += c;
  return word == brief || word == upper(node);
}

}  // namespace

ScpiDevice::ScpiDevice(std::string identity) : identity_(std::move(identity)) {
  on_query("*IDN", [this](const std::string&) { return identity_; });
  on_query("*OPC", [](const std::string&) { return "1"; });
  on_query("*ESR", [this](const std::string&) { return errors_.empty() ? "0" : "32"; });
  on_query("*TST", [](const std::string&) { return "0"; });
  on_set("*CLS", [this](const std::string&) { errors_.clear(); });
  on_set("*RST", [this](const std::string&) {
    if (reset_) reset_();
  });
  on_set("*OPC", [](const std::string&) {});
  on_set("SYSTem:REMote", [](const std::string&) {});
  on_set("SYSTem:LOCal", [](const std::string&) {});
  const auto next_error = [this](const std::string&) {
    if (errors_.empty()) return std::string("+0,\"No error\"");
    std::string first = errors_.front();
    errors_.pop_front();
    return first;
  };
  on_query("SYSTem:ERRor", next_error);
  on_query("SYSTem:ERRor:NEXT", next_error);
}

ScpiDevice::Entry& ScpiDevice::entry(const std::string& pattern) {
  std::vector<std::string> nodes = split(pattern, ':');
  for (Entry& e : entries_)
    if (e.nodes == nodes) return e;
  return entries_.emplace_back(Entry{std::move(nodes), {}, {}});
}

void ScpiDevice::on_set(const std::string& pattern, Set action) { entry(pattern).set = std::move(action); }
void ScpiDevice::on_query(const std::string& pattern, Get answer) { entry(pattern).get = std::move(answer); }

const ScpiDevice::Entry* ScpiDevice::find(std::string_view header) const {
  if (header.starts_with(':')) header.remove_prefix(1);
  const std::vector<std::string> words = split(upper(header), ':');
  for (const Entry& e : entries_)
    if (std::ranges::equal(e.nodes, words, matches)) return &e;
  return nullptr;
}

void ScpiDevice::push_error(int code, const std::string& text) {
  if (errors_.size() + 1 == kQueueLength) errors_.push_back("-350,\"Queue overflow\"");
  if (errors_.size() < kQueueLength) errors_.push_back(fmt::format("{},\"{}\"", code, text));
}

std::optional<std::string> ScpiDevice::one(std::string_view command) {
  const std::size_t space = command.find(' ');
  std::string_view header = command.substr(0, space);
  const std::string argument(space == std::string_view::npos ? "" : trimmed(command.substr(space)));
  const bool asks = header.ends_with('?');
  if (asks) header.remove_suffix(1);
  const Entry* e = find(header);
  if (e == nullptr || (asks ? !e->get : !e->set)) {
    push_error(-113, "Undefined header;" + std::string(command));
    return std::nullopt;
  }
  try {
    if (asks) return e->get(argument);
    e->set(argument);
  } catch (const ScpiError& error) {
    push_error(error.code, error.text);
  }
  return std::nullopt;
}

std::optional<std::string> ScpiDevice::execute(std::string_view line) {
  std::optional<std::string> answers;
  for (const std::string& command : split(line, ';')) {
    const std::string_view text = trimmed(command);
    if (text.empty()) continue;
    if (const std::optional<std::string> answer = one(text))
      answers = answers ? *answers + ";" + *answer : *answer;
  }
  return answers;
}

double scpi_number(const std::string& argument, double low, double high) {
  double value = 0;
  const char* begin = argument.data() + (argument.starts_with('+') ? 1 : 0);
  const auto [end, error] = std::from_chars(begin, argument.data() + argument.size(), value);
  if (error != std::errc() || end != argument.data() + argument.size())
    throw ScpiError{-104, "Data type error;" + argument};
  if (!(value >= low && value <= high)) throw ScpiError{-222, "Data out of range;" + argument};
  return value;
}

bool scpi_boolean(const std::string& argument) {
  const std::string word = upper(argument);
  if (word == "ON" || word == "1") return true;
  if (word == "OFF" || word == "0") return false;
  throw ScpiError{-224, "Illegal parameter value;" + argument};
}

std::string scpi_text(double value) { return fmt::format("{:+.9E}", value); }

}  // namespace waverig::rig::bench
