#include "estimator/evaluation/run_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <waverig/counts_t.hpp>
#include <waverig/run_t.hpp>
#include <waverig/truth_t.hpp>

#include "estimator/messages.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/error.h"
#include "lcmtypes/event_log.h"
#include "lcmtypes/phase.h"

namespace waverig::evaluation {
namespace {

RawSample raw_of(const counts_t& m) {
  RawSample raw;
  raw.utime = m.utime;
  raw.seq = m.seq;
  for (int axis = 0; axis < 3; ++axis) {
    raw.accel_positive[axis] = m.accel_positive_counts[axis];
    raw.accel_negative[axis] = m.accel_negative_counts[axis];
    raw.gyro[axis] = m.gyro_counts[axis];
    raw.mag[axis] = m.mag_counts[axis];
  }
  raw.temperature = m.temperature_counts;
  raw.flags = m.flags;
  return raw;
}

// sea_t as logs hold it from before it told hm0_systematic_sigma_m: that part is unknown in them, all else
// the same.
LogEvent with_systematic_part(LogEvent event) {
  constexpr std::array<std::uint8_t, 8> kFingerprint = {0xdc, 0x3a, 0x2a, 0xfa, 0xde, 0xe2, 0xb9, 0x6f};
  constexpr std::array<std::uint8_t, 8> kNaN = {0x7f, 0xf8};
  constexpr std::size_t kSize = 140, kBefore = 48;  // fingerprint, two integers, three numbers
  if (event.data.size() != kSize || !std::equal(kFingerprint.begin(), kFingerprint.end(), event.data.begin()))
    return event;
  const auto now = static_cast<std::uint64_t>(sea_t::getHash());
  for (std::size_t i = 0; i < 8; ++i) event.data[i] = static_cast<std::uint8_t>(now >> (56 - 8 * i));
  event.data.insert(event.data.begin() + kBefore, kNaN.begin(), kNaN.end());
  return event;
}

// Sorts the events of one log into the record.
class Loader {
 public:
  Loader(const std::filesystem::path& log, RunRecord& record) : log_(log), record_(record) {}

  void take(const LogEvent& event) {
    const std::string_view channel = event.channel;
    if (record_.start_utime == 0) record_.start_utime = event.utime;
    if (channel == channel::kRun) {
      phase(decoded<run_t>(event));
    } else if (channel == channel::kTruth) {
      const auto m = decoded<truth_t>(event);
      record_.truth.push_back({m.utime, m.heave_m, m.heave_rate_mps, m.north_m, m.east_m, m.arm_angle_rad,
                               estimator::quaternion(m.quat_NB)});
    } else if (channel == channel::kImu) {
      record_.imu.push_back(estimator::sample_of(decoded<imu_t>(event)));
    } else if (channel == channel::kCounts) {
      record_.raw.push_back(raw_of(decoded<counts_t>(event)));
    } else if (channel.starts_with(channel::kHeavePrefix)) {
      record_.heave[method(channel, channel::kHeavePrefix)].push_back(
          estimator::heave_of(decoded<heave_t>(event)));
    } else if (channel.starts_with(channel::kWavePrefix)) {
      record_.waves[method(channel, channel::kWavePrefix)].push_back(
          estimator::wave_of(decoded<wave_t>(event)));
    } else if (channel.starts_with(channel::kSeaPrefix)) {
      record_.seas[method(channel, channel::kSeaPrefix)].push_back(
          estimator::sea_of(decoded<sea_t>(with_systematic_part(event))));
    }
  }

  void finish() {
    if (begun_ && !ended_ && !record_.truth.empty()) record_.steady_end_utime = record_.truth.back().utime;
  }

 private:
  template <class Message>
  Message decoded(const LogEvent& event) const {
    Message message{};
    if (!event.decode(message))
      throw UserError(fmt::format("{}: channel {}, time {}: {} bytes of another type; expected {}",
                                  log_.string(), event.channel, event.utime, event.data.size(),
                                  Message::getTypeName()));
    return message;
  }

  static std::string method(std::string_view channel, std::string_view prefix) {
    return std::string(channel.substr(prefix.size()));
  }

  void phase(const run_t& m) {
    record_.period_s = m.period_s;
    record_.height_m = m.height_m;
    record_.repeat = m.repeat;
    if (m.phase == static_cast<std::int32_t>(Phase::kSteady)) {
      if (!begun_) record_.steady_begin_utime = record_.steady_end_utime = m.utime;
      begun_ = true;
    } else if (begun_ && !ended_) {
      record_.steady_end_utime = m.utime;
      ended_ = true;
    }
  }

  const std::filesystem::path& log_;
  RunRecord& record_;
  bool begun_ = false, ended_ = false;
};

}  // namespace

RunRecord load_run(const std::filesystem::path& log) {
  RunRecord record;
  record.run = log.stem().string();
  EventLogReader reader(log);
  Loader loader(log, record);
  bool any = false;
  for (LogEvent event; reader.next(event); any = true) loader.take(event);
  if (!any) throw UserError(fmt::format("{}: holds no event; expected the log of a run", log.string()));
  loader.finish();
  return record;
}

}  // namespace waverig::evaluation
