#include "rig/bench/port_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "estimator/calibration/front_end.h"
#include "rig/bench/frame_data.h"
#include "rig/bench/instrument_error.h"

namespace waverig::rig::bench {
namespace {

constexpr std::size_t kReadAtOnce = 65536;

int baud_of(const Port& port) {
  const Address address = parse_address(port.address, port.name);
  const auto baud = address.options.find("baud");
  return baud == address.options.end() ? 921600 : std::atoi(baud->second.c_str());
}

std::string path_of(const Port& port) {
  return fmt::format("/{}", parse_address(port.address, port.name).path);
}

std::optional<std::size_t> optional_field(const FrameLayout& layout, const std::string& name) {
  for (std::size_t i = 0; i < layout.fields.size(); ++i)
    if (layout.fields[i].name == name) return i;
  return std::nullopt;
}

}  // namespace

std::int64_t total_step(const FrameLayout& layout, const std::vector<std::int64_t>& from,
                        const std::vector<std::int64_t>& to, std::size_t field) {
  const int bits = layout.fields[field].bits;
  const std::uint64_t mask = bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
  return static_cast<std::int64_t>(
      (static_cast<std::uint64_t>(to[field]) - static_cast<std::uint64_t>(from[field])) & mask);
}

PortReader::PortReader(Reactor& reactor, const Port& port, const UnitDescription& unit)
    : reactor_(reactor),
      port_(port),
      unit_(unit),
      serial_(path_of(port), baud_of(port)),
      cable_(VirtualTime::serial_cable(path_of(port))),
      decoder_(port.layout),
      ticks_(port.layout.index_of("ticks")),
      temperature_(port.layout.index_of("temperature")),
      counter_(port.layout.index_of(port.layout.counter)),
      clock_(optional_field(port.layout, "clock")),
      reference_(optional_field(port.layout, "reference")),
      buffer_(kReadAtOnce) {
  reactor_.serve(serial_.descriptor(), [this] { read(); });
}

PortReader::~PortReader() {
  reactor_.forget(serial_.descriptor());
  if (reactor_.virtual_time() != nullptr) reactor_.virtual_time()->closed(cable_);
}

void PortReader::write(const std::string& line) {
  const std::string text = line + "\n";
  if (reactor_.virtual_time() != nullptr)
    reactor_.virtual_time()->sent(cable_, static_cast<std::int64_t>(text.size()));
  try {
    serial_.write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, 1000);
  } catch (const std::runtime_error& error) {
    throw InstrumentError(FaultKind::kDisconnected, port_.name, error.what());
  }
}

void PortReader::read() {
  const std::span<const std::uint8_t> got = serial_.read(buffer_, 0);
  if (reactor_.virtual_time() != nullptr)
    reactor_.virtual_time()->received(cable_, static_cast<std::int64_t>(got.size()));
  decoder_.add(got);
  while (const Frame* frame = decoder_.next()) {
    if (recording_ && !recording_->complete) add(frame->raw);
    last_ = frame->raw;
    if (on_frame) on_frame(last_);
  }
}

double PortReader::temperature(const std::vector<std::int64_t>& raw) const {
  return port_.layout.fields[temperature_].value(raw[temperature_]);
}

void PortReader::begin(const std::vector<std::string>& channels, double duration_s, bool join, bool keep) {
  Recording& r = recording_.emplace();
  for (const std::string& channel : channels) {
    const auto N = optional_field(port_.layout, channel + "_N"),
               P = optional_field(port_.layout, channel + "_P");
    if (!N || !P) continue;  // not a channel of this port
    r.channels.push_back(channel);
    r.fields.push_back(*N);
    r.fields.push_back(*P);
  }
  r.duration_ticks = std::llround(duration_s / unit_.tick_s);
  r.keep = keep;
  r.start_utime = reactor_.now();
  r.broken_before = decoder_.statistics().broken;
  r.second_A.resize(r.channels.size());
  if (keep) r.kept.resize(1 + r.fields.size());
  if (join && !last_.empty()) start(last_);
}

void PortReader::start(const std::vector<std::int64_t>& raw) {
  Recording& r = *recording_;
  r.first = r.last = r.second = raw;
  r.frames = 1;
  r.temperature_sum = r.temperature_low = r.temperature_high = temperature(raw);
}

void PortReader::add(const std::vector<std::int64_t>& raw) {
  Recording& r = *recording_;
  // A joined recording whose first frame is from before a long gap begins anew.
  if (r.first.empty() || (r.frames == 1 && step(r.first, raw, ticks_) > r.duration_ticks * 3 / 2)) {
    start(raw);
    return;
  }
  if (r.keep) {
    r.kept[0].push_back(static_cast<std::int32_t>(step(r.last, raw, ticks_)));
    for (std::size_t i = 0; i < r.fields.size(); ++i)
      r.kept[i + 1].push_back(static_cast<std::int32_t>(step(r.last, raw, r.fields[i])));
  }
  ++r.frames;
  const double T = temperature(raw);
  r.temperature_sum += T;
  r.temperature_low = std::min(r.temperature_low, T);
  r.temperature_high = std::max(r.temperature_high, T);
  if (step(r.second, raw, ticks_) >= std::llround(1 / unit_.tick_s)) end_second(raw);
  r.last = raw;
  r.complete = step(r.first, raw, ticks_) >= r.duration_ticks;
}

void PortReader::end_second(const std::vector<std::int64_t>& raw) {
  Recording& r = *recording_;
  const double seconds = static_cast<double>(step(r.second, raw, ticks_)) * unit_.tick_s;
  for (std::size_t i = 0; i < r.channels.size(); ++i) {
    const UnitDescription::Channel& c = *unit_.channel(r.channels[i]);
    r.second_A[i].push_back((c.K_N0_C * static_cast<double>(step(r.second, raw, r.fields[2 * i])) -
                             c.K_P0_C * static_cast<double>(step(r.second, raw, r.fields[2 * i + 1]))) /
                            seconds);
  }
  r.second = raw;
}

RecordingRow PortReader::finish() {
  const Recording& r = *recording_;
  RecordingRow row;
  row.port = port_.name;
  row.start_utime = r.start_utime;
  row.frames = r.frames;
  row.broken = decoder_.statistics().broken - r.broken_before;
  if (!r.first.empty()) {
    row.ticks = step(r.first, r.last, ticks_);
    row.lost = step(r.first, r.last, counter_) + 1 - r.frames;
    if (clock_) row.clock = step(r.first, r.last, *clock_);
    if (reference_) row.reference = step(r.first, r.last, *reference_);
    row.temperature = r.temperature_sum / static_cast<double>(r.frames);
    row.temperature_span = r.temperature_high - r.temperature_low;
    for (std::size_t i = 0; i < r.channels.size(); ++i) {
      ChannelCounts c{r.channels[i], step(r.first, r.last, r.fields[2 * i]),
                      step(r.first, r.last, r.fields[2 * i + 1]), 0};
      const std::vector<double>& seconds = r.second_A[i];
      if (seconds.size() >= 10) {  // from differences of neighbours, so that drift does not count
        double sum = 0;
        for (std::size_t k = 1; k < seconds.size(); ++k)
          sum += (seconds[k] - seconds[k - 1]) * (seconds[k] - seconds[k - 1]);
        c.noise_A_sqrt_s = std::sqrt(sum / (2.0 * static_cast<double>(seconds.size() - 1)));
      }
      row.channels.push_back(std::move(c));
    }
    if (r.keep) row.data = pack_columns(r.kept);
  }
  recording_.reset();
  return row;
}

}  // namespace waverig::rig::bench
