// Bus: RAII over one LCM object, with checked publish and decode.
//
// One thread owns a Bus. What LCM leaves open is closed here: unlimited queues (the default drops after 31),
// escaped channel patterns, an exact size and fingerprint check before a handler sees a message, and
// exceptions that leave a handler are carried past liblcm and rethrown from handle().
#pragma once
#include <cstdint>
#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace waverig {

// A channel name with its regular-expression characters escaped.
std::string escaped_channel(std::string_view channel);

class Bus {
 public:
  using RawHandler = std::function<void(std::string_view channel, const void* data, std::size_t size)>;

  // url: "memq://", "udpm://239.255.76.67:7667?ttl=0", "file://…"; throws UserError where LCM cannot open it.
  explicit Bus(const std::string& url = "memq://");
  ~Bus();
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  // Throws std::runtime_error where LCM refuses.
  template <class Message>
  void publish(std::string_view channel, const Message& message) {
    const int size = message.getEncodedSize();
    encode_buffer_.resize(static_cast<std::size_t>(size));
    if (message.encode(encode_buffer_.data(), 0, size) != size) fail_encode(channel);
    publish_raw(channel, encode_buffer_.data(), encode_buffer_.size());
  }
  void publish_raw(std::string_view channel, const void* data, std::size_t size);

  // handler(const Message&) for each well-formed message; malformed ones are counted, never delivered.
  template <class Message, class Handler>
  void subscribe(std::string_view channel, Handler handler) {
    plain_channels_.emplace_back(channel);
    add_subscription(escaped_channel(channel),
                  [this, handler = std::move(handler), message = Message{}](
                      std::string_view, const void* data, std::size_t size) mutable {
                    if (static_cast<int>(size) != message.getEncodedSize() ||
                        message.decode(data, 0, static_cast<int>(size)) != static_cast<int>(size)) {
                      ++malformed_;
                      return;
                    }
                    handler(static_cast<const Message&>(message));
                  });
  }
  // pattern is an LCM channel pattern (a regular expression).
  void subscribe_raw(const std::string& pattern, RawHandler handler);

  // Delivers one message; false when none came within the time. Rethrows what a handler threw.
  bool handle(int timeout_ms = 0);
  // Delivers all that waits now; returns how many (embedded mode: runs the bus dry).
  int drain();

  std::int64_t malformed() const { return malformed_; }
  bool in_process() const { return in_process_; }

 private:
  struct Subscription;
  void add_subscription(const std::string& pattern, RawHandler handler);
  bool surely_heard(std::string_view channel) const;
  static void dispatch(const lcm_recv_buf_t* buffer, const char* channel, void* user);
  [[noreturn]] static void fail_encode(std::string_view channel);

  lcm::LCM lcm_;
  bool in_process_;
  std::vector<std::unique_ptr<Subscription>> subscriptions_;
  std::vector<std::uint8_t> encode_buffer_;
  std::string channel_buffer_;
  std::exception_ptr pending_;
  std::int64_t malformed_ = 0;

  // Embedded mode: how many messages surely wait. Handling those needs no look whether there is one, which costs a
  // third of the time. "Surely": on a channel that was subscribed to by its plain name, or by all.
  std::int64_t waiting_ = 0;
  std::vector<std::string> plain_channels_;
  bool hears_all_ = false, hears_patterns_ = false;
};

}  // namespace waverig
