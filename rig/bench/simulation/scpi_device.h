// ScpiDevice: the command side of a simulated instrument: headers in short or long form, several commands a
// line, the error queue and the common commands.
#pragma once
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace waverig::rig::bench {

// A handler's complaint; it goes to the error queue. SCPI-99 numbers.
struct ScpiError {
  int code = -200;
  std::string text;
};

class ScpiDevice {
 public:
  using Set = std::function<void(const std::string& argument)>;
  using Get = std::function<std::string(const std::string& argument)>;

  explicit ScpiDevice(std::string identity);

  // pattern: "SOURce:CURRent:RANGe", capitals are the short form.
  void on_set(const std::string& pattern, Set action);
  void on_query(const std::string& pattern, Get answer);
  void on_reset(std::function<void()> action) { reset_ = std::move(action); }

  // One line; the answers of its queries, joined by ';', or nothing.
  std::optional<std::string> execute(std::string_view line);
  void push_error(int code, const std::string& text);
  const std::string& identity() const { return identity_; }

 private:
  struct Entry {
    std::vector<std::string> nodes;  // as in the pattern
    Set set;
    Get get;
  };
  Entry& entry(const std::string& pattern);
  const Entry* find(std::string_view header) const;
  std::optional<std::string> one(std::string_view command);

  std::string identity_;
  std::vector<Entry> entries_;
  std::deque<std::string> errors_;
  std::function<void()> reset_;
};

// Arguments of handlers; throw ScpiError.
double scpi_number(const std::string& argument, double low, double high);
bool scpi_boolean(const std::string& argument);
std::string scpi_text(double value);

}  // namespace waverig::rig::bench
