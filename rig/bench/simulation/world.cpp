#include "rig/bench/simulation/world.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "lcmtypes/error.h"

namespace waverig::rig::bench {
namespace {

constexpr int kSlowStep = 10;      // ticks: while the unit does not stream
constexpr int kThermalStep = 100;  // ticks: thermal models move by the second
constexpr char kMagic[] = "waverig bench world 1";

UnitTruth drawn_and_drifted(const WorldSettings& settings) {
  UnitTruth unit = draw_unit(settings.unit, settings.seed);
  for (std::size_t i = 0; i < settings.converter.size(); ++i) {
    const ConverterChannelSettings& given = settings.converter[i];
    ChannelTruth& channel = unit.channels.at(kGyroChannels + i);
    channel = {.K_N0_C = given.negative_quantum_C,
               .K_P0_C = given.positive_quantum_C,
               .dsf_N = {given.negative_scale_error},
               .dsf_P = {given.positive_scale_error},
               .bias_A = {given.bias_A},
               .noise_A_sqrt_s = channel.noise_A_sqrt_s};
    unit.converter_clock_error = {given.reset_clock_error};
    unit.master_error = {settings.master_clock_error};
  }
  RandomStream random(settings.drift.seed, "drift of the unit");
  for (ChannelTruth& channel : unit.channels) {
    channel.dsf_N[0] += random.gaussian(settings.drift.scale);
    channel.dsf_P[0] += random.gaussian(settings.drift.scale);
    channel.bias_A[0] += random.gaussian(settings.drift.bias_A);
  }
  return unit;
}

std::size_t expect_fields(const FrameLayout& layout, std::size_t count) {
  if (layout.fields.size() != count)
    throw UserError(fmt::format("frame layout {}: {} fields: expected {} of the simulated unit", layout.name,
                                layout.fields.size(), count));
  return count;
}

}  // namespace

World::World(const WorldSettings& settings, std::int64_t start_utime, const FrameLayout& counts,
             const FrameLayout& monitor)
    : settings_(settings),
      unit_(drawn_and_drifted(settings)),
      calibrator_(draw_calibrator(settings.seed)),
      switch_(draw_switch(settings.seed)),
      dmm_(draw_dmm(settings.seed)),
      generator_(draw_generator(settings.seed)),
      counts_encoder_(counts),
      monitor_encoder_(monitor),
      counts_raw_(expect_fields(counts, 2 * kChannels + 5)),
      monitor_raw_(expect_fields(monitor, 5)) {
  state_.start_utime = start_utime;
  state_.unit =
      settled_unit(unit_, settings.chamber.ambient_degC, derived_seed(settings.noise_seed, "bench noise"));
  state_.chamber.air_degC = state_.chamber.setpoint_degC = settings.chamber.ambient_degC;
  state_.line = RandomStream(settings.noise_seed, "serial line");
  controls.chamber.target_degC = settings.chamber.ambient_degC;
}

int World::step_ticks() const {
  const bool streams = controls.unit_powered && controls.unit.counts_period_ticks > 0 &&
                       controls.unit.counts_period_ticks < kSlowStep;
  return streams || state_.unit.ticks % kSlowStep != 0 ? 1 : kSlowStep;
}

void World::advance_to(std::int64_t utime) { advance_to(utime, 1 << 30); }

bool World::advance_to(std::int64_t utime, int frames_max) {
  const double target_s = static_cast<double>(utime - state_.start_utime) * 1e-6;
  for (int frames = 0; frames < frames_max;) {
    const int ticks = step_ticks();
    if (state_.time_s + true_s(state_.unit, ticks) > target_s) return true;
    step(ticks);
    const auto due = [&](int period) {
      return controls.unit_powered && period > 0 &&
             state_.unit.ticks % static_cast<std::uint64_t>(period) == 0;
    };
    if (due(controls.unit.counts_period_ticks)) {
      emit_counts();
      ++frames;
    }
    if (due(controls.unit.monitor_period_ticks)) {
      emit_monitor();
      ++frames;
    }
  }
  return false;
}

// A new setting moves the calibrator's offset; the same setting told again does not.
void World::apply_setting() {
  const double level_A = controls.calibrator.on ? controls.calibrator.level_A : 0;
  if (level_A == state_.set_level_A && controls.calibrator.range_A == state_.set_range_A) return;
  state_.set_level_A = level_A;
  state_.set_range_A = controls.calibrator.range_A;
  RandomStream random(derived_seed(settings_.noise_seed, "calibrator setting", ++state_.settings), "drift");
  const double floor_A = estimator::kCalibratorTable2[range_index(state_.set_range_A)].floor_A;
  state_.drift_A = random.gaussian(calibrator_.floor_drift * floor_A);
}

void World::step(int ticks) {
  const double dt_s = true_s(state_.unit, ticks);
  apply_setting();
  const double target_A = controls.calibrator.on
                              ? calibrator_A(calibrator_, controls.calibrator.level_A,
                                             range_index(controls.calibrator.range_A), state_.drift_A)
                              : 0;
  state_.source_A += (target_A - state_.source_A) * -std::expm1(-dt_s / calibrator_.settling_s);

  std::array<double, kChannels> current_A{};
  for (double& i : current_A) i = switch_.open_leakage_A;
  if (const int c = controls.route.channel; c >= 0 && !controls.dmm_in_path) {
    const auto channel = static_cast<std::size_t>(c);
    current_A[channel] = controls.route.polarity * state_.source_A +
                         switch_.leakage_A[channel][controls.route.polarity > 0 ? 1 : 0];
  }
  const double reference_Hz =
      controls.generator.on ? controls.generator.frequency_Hz * (1 + generator_.error) : 0;
  count(unit_, state_.unit, current_A, reference_Hz, ticks);
  state_.time_s += dt_s;
  if (state_.unit.ticks % kThermalStep == 0) {
    advance(settings_.chamber, controls.chamber, state_.chamber, kThermalStep * kTick_s);
    follow_temperature(unit_, state_.unit, state_.chamber.air_degC, kThermalStep * kTick_s);
  }
}

void World::emit_counts() {
  const UnitState& u = state_.unit;
  std::size_t i = 0;
  counts_raw_[i++] = state_.counts_frames++;
  counts_raw_[i++] = static_cast<std::int64_t>(u.ticks);
  counts_raw_[i++] = static_cast<std::int64_t>(u.clock);
  for (const ChannelState& c : u.channels) {
    counts_raw_[i++] = static_cast<std::int64_t>(c.N);
    counts_raw_[i++] = static_cast<std::int64_t>(c.P);
  }
  counts_raw_[i++] = std::lround(thermometer_degC(unit_, u) * 1000);
  counts_raw_[i++] = controls.unit.counts_period_ticks;
  const std::size_t from = counts_line.size();
  counts_encoder_.append(counts_raw_, counts_line);
  corrupt(counts_line, from);
}

void World::emit_monitor() {
  const UnitState& u = state_.unit;
  monitor_raw_ = {state_.monitor_frames++, static_cast<std::int64_t>(u.ticks),
                  static_cast<std::int64_t>(u.reference), static_cast<std::int64_t>(u.clock),
                  std::lround(thermometer_degC(unit_, u) * 1000)};
  const std::size_t from = monitor_line.size();
  monitor_encoder_.append(monitor_raw_, monitor_line);
  corrupt(monitor_line, from);
}

void World::corrupt(std::vector<std::uint8_t>& line, std::size_t from) {
  if (controls.frame_corruption <= 0 || state_.line.uniform() >= controls.frame_corruption) return;
  const auto bit =
      static_cast<std::size_t>(state_.line.uniform() * 8 * static_cast<double>(line.size() - from));
  line[from + bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
}

double World::chamber_reading_degC() const {
  RandomStream random(derived_seed(settings_.noise_seed, "chamber thermometer", state_.unit.ticks),
                      "reading");
  return state_.chamber.air_degC + random.gaussian(0.01);
}

double World::dmm_reading_A(double range_A) const {
  const std::size_t range = range_index(range_A);
  RandomStream random(derived_seed(settings_.noise_seed, "dmm", state_.unit.ticks), "reading");
  RandomStream drift(derived_seed(settings_.noise_seed, "dmm offset", state_.settings), "drift");
  const double input_A = controls.dmm_in_path ? controls.route.polarity * state_.source_A : 0;
  return input_A * (1 + dmm_.gain[range]) + dmm_.offset_A[range] + drift.gaussian(dmm_.offset_drift_A) +
         random.gaussian(std::hypot(dmm_.noise_relative * input_A, dmm_.noise_A));
}

std::string World::snapshot() const {
  std::string bytes(sizeof kMagic + sizeof state_, '\0');
  std::memcpy(bytes.data(), kMagic, sizeof kMagic);
  std::memcpy(bytes.data() + sizeof kMagic, &state_, sizeof state_);
  return bytes;
}

void World::restore(std::string_view snapshot) {
  if (snapshot.size() != sizeof kMagic + sizeof state_ ||
      std::memcmp(snapshot.data(), kMagic, sizeof kMagic) != 0)
    throw UserError(
        "the stored state of the simulated laboratory is of another program version: begin a new run");
  std::memcpy(&state_, snapshot.data() + sizeof kMagic, sizeof state_);
}

}  // namespace waverig::rig::bench
