// World: the simulated laboratory as physics. Instruments write the controls and read the world; time is
// passed in.
//
// Everything moves on the unit's master ticks (10 ms), ten at a time while it does not stream at 100 Hz, so
// that the result does not depend on how the caller cuts the time. What is remembered is one trivially
// copyable state: kept with each step of a run, it lets a run that was killed go on to the same bit. Controls
// are not part of it: an instrument that was switched off has forgotten what it was told, and must be told
// again.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "rig/bench/simulation/chamber.h"
#include "rig/bench/simulation/converter_unit.h"
#include "rig/bench/simulation/sources.h"
#include "rig/frontend/frame_codec.h"

namespace waverig::rig::bench {

// What has happened to the unit since it was drawn; standard deviations of the channels.
struct UnitDrift {
  std::uint64_t seed = 1;
  double scale = 0;  // of each reset current, relative
  double bias_A = 0;
};

struct WorldSettings {
  std::uint64_t seed = 1;        // of the unit and the instruments
  std::uint64_t noise_seed = 1;  // of what differs from run to run
  UnitDrift drift;
  // Instead of those drawn: accel_1 and so on, their converter's clock among them, and the unit's master
  // clock.
  std::vector<ConverterChannelSettings> converter;
  double master_clock_error = 0;
  UnitSpread unit;
  ChamberTruth chamber;
};

struct CalibratorControls {
  bool on = false;
  double level_A = 0;
  double range_A = 220e-6;
};
struct RouteControls {
  int channel = -1;  // -1: open
  int polarity = 1;
  bool operator==(const RouteControls&) const = default;
};
struct GeneratorControls {
  bool on = false;
  double frequency_Hz = 1e6;
};
struct UnitControls {
  int counts_period_ticks = 0;   // frames of the first port; 0: silent
  int monitor_period_ticks = 0;  // of the second
};
struct Controls {
  CalibratorControls calibrator;
  RouteControls route;
  bool dmm_in_path = false;  // the DMM in place of the unit
  ChamberControls chamber;
  GeneratorControls generator;
  bool unit_powered = false;
  UnitControls unit;
  double frame_corruption = 0;  // part of the unit's frames that a broken bit hits on the line
};

struct WorldState {
  std::int64_t start_utime = 0;
  double time_s = 0;  // since the start, true
  UnitState unit;
  ChamberState chamber;
  double source_A = 0;                      // the calibrator's output as it settles
  double drift_A = 0;                       // of the present setting
  double set_level_A = 0, set_range_A = 0;  // the setting that drift belongs to
  std::uint64_t settings = 0;               // how many there were
  std::uint32_t counts_frames = 0, monitor_frames = 0;
  RandomStream line{0, "unset"};
};
static_assert(std::is_trivially_copyable_v<WorldState>);

class World {
 public:
  World(const WorldSettings& settings, std::int64_t start_utime, const FrameLayout& counts,
        const FrameLayout& monitor);

  // Moves on to the last tick that is not after utime. Frames go to the two lines below.
  void advance_to(std::int64_t utime);
  // At most that many frames are made in one call of advance_to before it returns early; true: utime was
  // reached.
  bool advance_to(std::int64_t utime, int frames_max);

  Controls controls;
  std::vector<std::uint8_t> counts_line, monitor_line;  // bytes on their way; the owner takes them

  // What instruments read. Noise is drawn by the tick, so that asking does not change the world.
  double chamber_reading_degC() const;
  double dmm_reading_A(double range_A) const;
  double source_A() const { return state_.source_A; }

  const UnitTruth& unit_truth() const { return unit_; }
  const WorldState& state() const { return state_; }
  std::string snapshot() const;
  void restore(std::string_view snapshot);  // throws UserError where it is not one of this program

 private:
  int step_ticks() const;
  void apply_setting();
  void step(int ticks);
  void emit_counts();
  void emit_monitor();
  void corrupt(std::vector<std::uint8_t>& line, std::size_t from);

  WorldSettings settings_;
  UnitTruth unit_;
  CalibratorTruth calibrator_;
  SwitchTruth switch_;
  DmmTruth dmm_;
  GeneratorTruth generator_;
  FrameEncoder counts_encoder_, monitor_encoder_;
  std::vector<std::int64_t> counts_raw_, monitor_raw_;
  WorldState state_;
};

}  // namespace waverig::rig::bench
