#include "lcmtypes/event_log.h"

#include <fmt/format.h>

#include <bit>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "lcmtypes/disk.h"
#include "lcmtypes/error.h"

namespace waverig {
namespace {

// Layout of an event, big-endian: sync, event number, microseconds, channel length, data length, channel,
// data.
constexpr std::uint32_t kSync = 0xEDA1DA01;
constexpr std::size_t kHeaderSize = 4 + 8 + 8 + 4 + 4;
constexpr std::size_t kMaxChannel = 255;      // LCM_MAX_CHANNEL_NAME_LENGTH is 63; foreign logs may hold more
constexpr std::size_t kMaxPayload = 1 << 24;  // far above any message of ours, far below what exhausts memory
constexpr std::size_t kFileBuffer = 1 << 18;

template <class T>
void put(std::uint8_t*& at, T value) {
  for (std::size_t i = sizeof(T); i-- > 0;)
    *at++ = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i));
}

template <class T>
T get(const std::uint8_t*& at) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) value = value << 8 | *at++;
  return static_cast<T>(value);
}

}  // namespace

EventLogWriter::EventLogWriter(const std::filesystem::path& path)
    : path_(path), buffer_(kFileBuffer), file_(std::fopen(path.c_str(), "wb")) {
  const std::error_code error(file_ ? 0 : errno, std::generic_category());
  if (error) refuse_place(error, fmt::format("{}: cannot be written: {}", path.string(), error.message()));
  std::setvbuf(file_.get(), buffer_.data(), _IOFBF, buffer_.size());
}

void EventLogWriter::write(std::int64_t utime, std::string_view channel, const void* data, std::size_t size) {
  std::uint8_t header[kHeaderSize];
  std::uint8_t* at = header;
  put(at, kSync);
  put(at, events_++);
  put(at, utime);
  put(at, static_cast<std::uint32_t>(channel.size()));
  put(at, static_cast<std::uint32_t>(size));
  std::fwrite(header, 1, sizeof header, file_.get());
  std::fwrite(channel.data(), 1, channel.size(), file_.get());
  std::fwrite(data, 1, size, file_.get());
}

void EventLogWriter::close() {
  std::FILE* file = file_.release();
  const bool failed = std::ferror(file) != 0;
  if (std::fclose(file) != 0 || failed)
    throw std::runtime_error(
        fmt::format("{}: not everything could be written: {}", path_.string(), std::strerror(errno)));
}

EventLogReader::EventLogReader(const std::filesystem::path& path)
    : path_(path), file_(std::fopen(path.c_str(), "rb")) {
  if (!file_) throw UserError(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno)));
  std::error_code error;
  size_ = static_cast<std::int64_t>(std::filesystem::file_size(path, error));
  if (error) throw UserError(fmt::format("{}: cannot be read: {}", path.string(), error.message()));
}

bool EventLogReader::next(LogEvent& event) {
  if (offset_ == size_) return false;
  std::uint8_t header[kHeaderSize];
  const auto broken = [&](const char* what) {
    return UserError(fmt::format("{}: byte {}: {}; expected a whole LCM event log of {} bytes",
                                 path_.string(), offset_, what, size_));
  };
  if (std::fread(header, 1, sizeof header, file_.get()) != sizeof header)
    throw broken("truncated inside an event's header");
  const std::uint8_t* at = header;
  if (get<std::uint32_t>(at) != kSync) throw broken("no event begins here (sync word missing)");
  at += 8;  // the event number carries nothing that the order does not
  event.utime = get<std::int64_t>(at);
  const auto channel_size = static_cast<std::size_t>(get<std::uint32_t>(at));
  const auto data_size = static_cast<std::size_t>(get<std::uint32_t>(at));
  if (channel_size > kMaxChannel || data_size > kMaxPayload)
    throw broken("an event's length is not plausible");
  event.channel.resize(channel_size);
  event.data.resize(data_size);
  if (std::fread(event.channel.data(), 1, channel_size, file_.get()) != channel_size ||
      std::fread(event.data.data(), 1, data_size, file_.get()) != data_size)
    throw broken("truncated inside an event");
  offset_ += static_cast<std::int64_t>(kHeaderSize + channel_size + data_size);
  return true;
}

}  // namespace waverig
