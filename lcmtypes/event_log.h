// Reading and writing LCM event logs (the files of lcm-logger, lcm-logplayer and lcm-spy).
//
// The reader checks every length before it trusts it and tells a whole log from a truncated one, which
// liblcm's own reader does not.
#pragma once
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace waverig {

struct LogEvent {
  std::int64_t utime = 0;  // event time in microseconds
  std::string channel;
  std::vector<std::uint8_t> data;

  // False where the bytes are not exactly one Message.
  template <class Message>
  bool decode(Message& message) const {
    const int size = static_cast<int>(data.size());
    return size == message.getEncodedSize() && message.decode(data.data(), 0, size) == size;
  }
};

class EventLogWriter {
 public:
  // Throws UserError where the file cannot be made.
  explicit EventLogWriter(const std::filesystem::path& path);
  void write(std::int64_t utime, std::string_view channel, const void* data, std::size_t size);
  // Flushes and closes; throws std::runtime_error where the disk did not take everything.
  void close();
  std::int64_t events() const { return events_; }

 private:
  struct Closer {
    void operator()(std::FILE* f) const { std::fclose(f); }
  };
  std::filesystem::path path_;
  std::vector<char> buffer_;  // the file's, which it outlives
  std::unique_ptr<std::FILE, Closer> file_;
  std::int64_t events_ = 0;
};

class EventLogReader {
 public:
  // Throws UserError where the file is missing or no LCM log.
  explicit EventLogReader(const std::filesystem::path& path);
  // False at the end of a whole log. Throws UserError, naming file and byte offset, where the log is
  // truncated or corrupt.
  bool next(LogEvent& event);

 private:
  struct Closer {
    void operator()(std::FILE* f) const { std::fclose(f); }
  };
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Closer> file_;
  std::int64_t offset_ = 0;
  std::int64_t size_ = 0;
};

}  // namespace waverig
