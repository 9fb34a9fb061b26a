#include "rig/bench/simulation/vxi11_side.h"

#include <algorithm>

namespace waverig::rig::bench {
namespace {

constexpr std::size_t kRecordMax = 1 << 20;
constexpr std::uint32_t kCreateLink = 10, kDeviceWrite = 11, kDeviceRead = 12, kReadStatus = 13, kClear = 15,
                        kDestroyLink = 23;
constexpr std::uint32_t kNoError = 0, kNotAccessible = 3, kInvalidLink = 4, kNotSupported = 8, kTimeout = 15;
constexpr std::uint32_t kEndBit = 4, kRequestCountBit = 1, kEndFlag = 8;

// XDR, RFC 4506.
class XdrReader {
 public:
  explicit XdrReader(std::string_view bytes) : bytes_(bytes) {}
  std::uint32_t word() {
    if (bytes_.size() < 4) {
      good_ = false;
      return 0;
    }
    std::uint32_t value = 0;
    for (int i = 0; i < 4; ++i)
      value = (value << 8) | static_cast<std::uint8_t>(bytes_[static_cast<std::size_t>(i)]);
    bytes_.remove_prefix(4);
    return value;
  }
  std::string opaque() {
    const std::size_t size = word(), padded = (size + 3) / 4 * 4;
    if (!good_ || padded > bytes_.size()) {
      good_ = false;
      return {};
    }
    std::string value(bytes_.substr(0, size));
    bytes_.remove_prefix(padded);
    return value;
  }
  bool good() const { return good_; }

 private:
  std::string_view bytes_;
  bool good_ = true;
};

void put(std::string& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(value >> shift);
}

void put_opaque(std::string& out, const std::string& bytes) {
  put(out, static_cast<std::uint32_t>(bytes.size()));
  out += bytes;
  out.append((4 - bytes.size() % 4) % 4, '\0');
}

struct Call {
  std::uint32_t id = 0, program = 0, version = 0, procedure = 0;
};

// The head of a call, credentials skipped.
bool read_call(XdrReader& in, Call& call) {
  call.id = in.word();
  const bool is_call = in.word() == 0, rpc2 = in.word() == 2;
  call.program = in.word();
  call.version = in.word();
  call.procedure = in.word();
  for (int i = 0; i < 2; ++i) {
    in.word();
    in.opaque();
  }
  return in.good() && is_call && rpc2;
}

// status: 0 success, 1 program unavailable, 2 version mismatch, 3 procedure unavailable.
std::string reply_head(const Call& call, std::uint32_t status) {
  std::string out;
  put(out, call.id);
  put(out, 1);  // a reply
  put(out, 0);  // accepted
  put(out, 0);  // no verifier
  put(out, 0);
  put(out, status);
  if (status == 2) {  // the versions that there are
    put(out, call.program == kPortMapperProgram ? 2 : 1);
    put(out, call.program == kPortMapperProgram ? 2 : 1);
  }
  return out;
}

}  // namespace

std::string marked(const std::string& message) {
  std::string out;
  put(out, 0x80000000U | static_cast<std::uint32_t>(message.size()));
  return out + message;
}

std::string port_mapper_reply(std::string_view bytes, int vxi11_port) {
  XdrReader in(bytes);
  Call call;
  if (!read_call(in, call)) return {};
  if (call.program != kPortMapperProgram) return reply_head(call, 1);
  if (call.version != 2) return reply_head(call, 2);
  std::string out = reply_head(call, call.procedure == 0 || call.procedure == 3 ? 0 : 3);
  if (call.procedure == 3) {  // GETPORT: program, version, protocol (6: TCP), 0
    const std::uint32_t program = in.word();
    in.word();
    const std::uint32_t protocol = in.word();
    put(out, program == kVxi11CoreProgram && protocol == 6 ? static_cast<std::uint32_t>(vxi11_port) : 0);
  }
  return out;
}

bool Vxi11Side::receive(std::string_view bytes, std::int64_t now_utime, std::vector<Answer>& out) {
  stream_ += bytes;
  while (stream_.size() >= 4) {
    const std::uint32_t mark = XdrReader(stream_).word();
    const std::size_t size = mark & 0x7FFFFFFFU;
    if (size > kRecordMax || record_.size() + size > kRecordMax) return false;
    if (stream_.size() < 4 + size) return true;
    record_ += stream_.substr(4, size);
    stream_.erase(0, 4 + size);
    if ((mark & 0x80000000U) == 0) continue;
    Answer answer = reply(record_, now_utime);
    record_.clear();
    if (answer.text.empty()) return false;
    answer.text = marked(answer.text);
    out.push_back(std::move(answer));
  }
  return true;
}

Answer Vxi11Side::reply(std::string_view bytes, std::int64_t now_utime) {
  XdrReader in(bytes);
  Call call;
  if (!read_call(in, call)) return {};
  if (call.program != kVxi11CoreProgram) return {reply_head(call, 1), now_utime};
  if (call.version != 1) return {reply_head(call, 2), now_utime};
  std::string out = reply_head(call, 0);
  if (call.procedure == 0) return {out, now_utime};

  if (call.procedure == kCreateLink) {
    in.word();  // client's id
    in.word();  // lock
    in.word();  // lock time-out
    const auto index = rack_.vxi11(in.opaque());
    const bool there = in.good() && index && rack_.present(*index);
    if (there) links_[next_link_].device = *index;
    put(out, there ? kNoError : kNotAccessible);
    put(out, there ? next_link_++ : 0);
    put(out, 0);                                           // no abort channel
    put(out, static_cast<std::uint32_t>(kRecordMax / 2));  // largest write
    return {out, now_utime};
  }

  const auto link = links_.find(in.word());
  const bool known = in.good() && link != links_.end();
  if (call.procedure == kDestroyLink) {
    if (known) links_.erase(link);
    put(out, known ? kNoError : kInvalidLink);
    return {out, now_utime};
  }
  if (call.procedure == kDeviceWrite) {
    in.word();  // I/O time-out
    in.word();  // lock time-out
    const std::uint32_t flags = in.word();
    const std::string data = in.opaque();
    if (!known || !in.good()) {
      put(out, kInvalidLink);
      put(out, 0);
      return {out, now_utime};
    }
    Link& l = link->second;
    l.input += data;
    if ((flags & kEndFlag) != 0 || data.ends_with('\n')) {
      while (!l.input.empty() && (l.input.back() == '\n' || l.input.back() == '\r')) l.input.pop_back();
      if (std::optional<Answer> answer = rack_.tell(l.device, l.input, now_utime))
        l.answers.push_back(std::move(*answer));
      l.input.clear();
    }
    put(out, kNoError);
    put(out, static_cast<std::uint32_t>(data.size()));
    return {out, now_utime};
  }
  if (call.procedure == kDeviceRead) {
    const std::uint32_t request_size = in.word();
    const std::int64_t deadline = now_utime + std::int64_t{1000} * in.word();
    const auto answer_with = [&](std::uint32_t error, std::uint32_t reason, const std::string& data,
                                 std::int64_t due) {
      put(out, error);
      put(out, reason);
      put_opaque(out, data);
      if (time_ != nullptr && due > time_->now()) time_->advance_while_client_blocks(due);
      return Answer{out, due};
    };
    if (!known) return answer_with(kInvalidLink, 0, "", now_utime);
    std::vector<Answer>& answers = link->second.answers;
    if (answers.empty() || answers.front().due_utime > deadline)
      return answer_with(kTimeout, 0, "", deadline);
    Answer& first = answers.front();
    if (!first.text.ends_with('\n')) first.text += '\n';
    const std::int64_t due = std::max(now_utime, first.due_utime);
    if (first.text.size() <= request_size) {
      const std::string whole = first.text;
      answers.erase(answers.begin());
      return answer_with(kNoError, kEndBit, whole, due);
    }
    const std::string part = first.text.substr(0, request_size);
    first.text.erase(0, request_size);
    return answer_with(kNoError, kRequestCountBit, part, due);
  }
  if (call.procedure == kReadStatus || call.procedure == kClear) {
    if (known && call.procedure == kClear) link->second.answers.clear();
    put(out, known ? kNoError : kInvalidLink);
    if (call.procedure == kReadStatus) put(out, known && !link->second.answers.empty() ? 16 : 0);
    return {out, now_utime};
  }
  put(out, kNotSupported);
  return {out, now_utime};
}

}  // namespace waverig::rig::bench
