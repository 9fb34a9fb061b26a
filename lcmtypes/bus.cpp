#include "lcmtypes/bus.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "lcmtypes/error.h"

namespace waverig {

struct Bus::Subscription {
  Bus* bus;
  RawHandler handler;
};

std::string escaped_channel(std::string_view channel) {
  std::string escaped;
  for (const char c : channel) {
    if (std::string_view("\\^$.|?*+()[]{}").find(c) != std::string_view::npos) escaped += '\\';
    escaped += c;
  }
  return escaped;
}

Bus::Bus(const std::string& url) : lcm_(url), in_process_(url.starts_with("memq:")) {
  // A failed subscribe() of LCM 1.3.1 returns garbage: ask for the file descriptor first.
  if (!lcm_.good() || lcm_.getFileno() < 0)
    throw UserError(
        fmt::format("--bus: cannot open \"{}\": expected memq://, file://LOG or udpm://GROUP:PORT?ttl=0 on a "
                    "network with a "
                    "multicast route",
                    url));
}

Bus::~Bus() = default;

void Bus::publish_raw(std::string_view channel, const void* data, std::size_t size) {
  channel_buffer_.assign(channel);
  if (lcm_.publish(channel_buffer_, data, static_cast<unsigned int>(size)) < 0)
    throw std::runtime_error(fmt::format("LCM refused to publish {} bytes on {}", size, channel));
  if (in_process_ && surely_heard(channel)) ++waiting_;
}

bool Bus::surely_heard(std::string_view channel) const {
  return hears_all_ ||
         std::find(plain_channels_.begin(), plain_channels_.end(), channel) != plain_channels_.end();
}

void Bus::subscribe_raw(const std::string& pattern, RawHandler handler) {
  (pattern == ".*" ? hears_all_ : hears_patterns_) = true;
  add_subscription(pattern, std::move(handler));
}

void Bus::add_subscription(const std::string& pattern, RawHandler handler) {
  subscriptions_.push_back(std::make_unique<Subscription>(Subscription{this, std::move(handler)}));
  lcm_t* lcm = lcm_.getUnderlyingLCM();
  lcm_subscription_t* subscription =
      lcm_subscribe(lcm, pattern.c_str(), &Bus::dispatch, subscriptions_.back().get());
  if (subscription == nullptr)
    throw std::runtime_error(fmt::format("LCM refused to subscribe to {}", pattern));
  lcm_subscription_set_queue_capacity(subscription, 0);
}

void Bus::dispatch(const lcm_recv_buf_t* buffer, const char* channel, void* user) {
  auto* subscription = static_cast<Subscription*>(user);
  if (subscription->bus->pending_) return;  // the first failure is the one to report
  try {
    subscription->handler(channel, buffer->data, buffer->data_size);
  } catch (...) {
    subscription->bus->pending_ = std::current_exception();
  }
}

bool Bus::handle(int timeout_ms) {
  int handled = 0;
  if (waiting_ > 0) {
    --waiting_;
    handled = lcm_.handle() == 0 ? 1 : -1;
  } else if (!in_process_ || hears_patterns_) {
    handled = lcm_.handleTimeout(timeout_ms);
  }
  if (pending_) std::rethrow_exception(std::exchange(pending_, nullptr));
  if (handled < 0) throw std::runtime_error("LCM failed while waiting for a message");
  return handled > 0;
}

int Bus::drain() {
  int handled = 0;
  while (handle(0)) ++handled;
  return handled;
}

void Bus::fail_encode(std::string_view channel) {
  throw std::logic_error(fmt::format("a message for {} did not encode to its own size", channel));
}

}  // namespace waverig
