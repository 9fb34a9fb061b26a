#include "rig/campaign/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "lcmtypes/error.h"
#include "motion/kinematics/frames.h"
#include "rig/campaign/default_campaign_text.h"

namespace waverig::rig {
namespace {

// 2026-01-01T00:00:00Z: virtual time begins somewhere; a laboratory's campaign has the time of its frames.
constexpr std::int64_t kVirtualStart_utime = 1767225600LL * 1000000LL;

void read_sea(TomlTable sea, SweepSettings& s) {
  s.sea.gamma = sea.number("gamma", s.sea.gamma, {1, 10});
  s.sea.direction_from_rad = sea.number("direction_from_deg", 0, {-360, 360}) * kDegree;
  s.sea.spreading_s = sea.number("spreading_s", s.sea.spreading_s, {0, 1000});
  s.sea.components = static_cast<int>(sea.integer("components", s.sea.components, {1, 5000}));
  s.sea.random_amplitudes = sea.boolean("random_amplitudes", s.sea.random_amplitudes);
  s.buoy.slope_following = sea.number("slope_following", s.buoy.slope_following, {0, 2});
  s.buoy.heading_rad = sea.number("heading_deg", 0, {-360, 360}) * kDegree;
  s.buoy.tilt_rad = sea.number("tilt_deg", 0, {0, 45}) * kDegree;
  s.buoy.tilt_period_s = sea.number("tilt_period_s", s.buoy.tilt_period_s, {0, 3600});
}

// Runs are named by these values: of one that came twice the waves would be counted twice, or two runs would
// write one log.
void refuse_alike(const TomlTable& sweep, std::string_view key, const std::vector<double>& values,
                  int decimals) {
  std::set<std::string> names;
  for (const double value : values)
    if (!names.insert(fmt::format("{:.{}f}", value, decimals)).second)
      sweep.refuse(key, fmt::format("each value once, {:g} apart at least", std::pow(10, -decimals)));
}

SweepSettings read_sweep(TomlTable sweep) {
  SweepSettings s;
  const std::string motion = sweep.choice("motion", "arm", {"arm", "jonswap", "pierson-moskowitz"});
  s.mover = motion == "arm" ? Mover::kArm : Mover::kSea;
  s.sea.shape = motion == "pierson-moskowitz" ? motion::SpectrumShape::kPiersonMoskowitz
                                              : motion::SpectrumShape::kJonswap;
  const auto periods = sweep.numbers("periods_s", std::nullopt, {0.5, 60});
  const auto heights = sweep.numbers("heights_cm", std::nullopt, {0.1, 2000});
  refuse_alike(sweep, "periods_s", periods, 2);
  refuse_alike(sweep, "heights_cm", heights, 1);
  for (const double period : periods)
    for (const double height : heights) s.settings.push_back({period, height * kCentimetre});
  s.settings_place = sweep.place_of("heights_cm");
  s.repeats = static_cast<int>(sweep.integer("repeats", 3, {1, 10000}));
  if (s.mover == Mover::kArm && sweep.has("turn_per_repeat_deg"))
    s.turn_per_repeat_rad = sweep.number("turn_per_repeat_deg", std::nullopt, {-360, 360}) * kDegree;
  s.profile.steady_s = sweep.number("duration_s", 300, {1, 864000});
  s.min_waves = static_cast<int>(sweep.integer("min_waves", s.min_waves, {0, 10000}));
  s.profile.ramp_periods = static_cast<int>(sweep.integer("ramp_periods", 2, {1, 100}));
  s.profile.rest_before_s = sweep.number("rest_before_s", 20, {0, 3600});
  s.profile.rest_after_s = sweep.number("rest_after_s", 2, {0, 3600});
  s.profile.rate_modulation = sweep.number("rate_modulation", 0, {0, 0.5});
  s.profile.modulation_cycles = static_cast<int>(sweep.integer("modulation_cycles", 0, {0, 1000}));
  s.profile.rate_drift = sweep.number("rate_drift", 0, {-0.5, 0.5});
  s.outside = sweep.choice("outside_envelope", "refuse", {"refuse", "skip"}) == "skip"
                  ? OutsideEnvelope::kSkip
                  : OutsideEnvelope::kRefuse;
  return s;
}

Place read_place(TomlTable& place, const Place& fallback) {
  return {
      .latitude_rad = place.number("latitude_deg", fallback.latitude_rad / kDegree, {-89.9, 89.9}) * kDegree,
      .longitude_rad = place.number("longitude_deg", fallback.longitude_rad / kDegree, {-180, 360}) * kDegree,
      .height_m = place.number("height_m", fallback.height_m, {-500, 9000})};
}

Vector3d read_vector(TomlTable& table, std::string_view key, const Vector3d& fallback, Range range) {
  const auto v = table.numbers(key, std::vector<double>(fallback.begin(), fallback.end()), range);
  if (v.size() != 3) table.refuse(key, "a list of 3 numbers");
  return {v[0], v[1], v[2]};
}

// declination_rad: what the laboratory takes it to be.
MagneticSettings read_magnetic(TomlTable rig, double declination_rad) {
  MagneticSettings s;
  TomlTable field = rig.table("field");
  s.field.total_uT = field.number("total_uT", s.field.total_uT, {1, 100});
  s.field.dip_rad = field.number("dip_deg", s.field.dip_rad / kDegree, {-85, 85}) * kDegree;
  s.field.declination_rad = field.number("declination_deg", declination_rad / kDegree, {-180, 180}) * kDegree;
  TomlTable motor = rig.table("motor");
  s.motor_distance_m = motor.number("distance_m", s.motor_distance_m, {0.05, 10});
  s.stator_moment_P_Am2 = read_vector(motor, "stator_moment_Am2", s.stator_moment_P_Am2, {-1000, 1000});
  s.rotor_moment_Am2 = read_vector(motor, "rotor_moment_Am2", s.rotor_moment_Am2, {-1000, 1000});
  return s;
}

CompassMethod read_compass(TomlTable calibration, CompassRunSettings& run) {
  const std::string method = calibration.choice("compass", "ellipsoid", {"none", "max-min", "ellipsoid"});
  run.steps = static_cast<int>(calibration.integer("compass_steps", run.steps, {8, 3600}));
  run.record_s = calibration.number("compass_seconds_per_step", run.record_s, {0.05, 600});
  return method == "none"      ? CompassMethod::kNone
         : method == "max-min" ? CompassMethod::kMaxMin
                               : CompassMethod::kEllipsoid;
}

RotatingArmSettings read_arm(TomlTable rig, double gravity_mps2) {
  RotatingArmSettings s;
  s.gravity_mps2 = gravity_mps2;
  s.azimuth_rad = rig.number("arm_azimuth_deg", 0, {-360, 360}) * kDegree;
  s.arm_sag_rad = rig.number("arm_sag_deg", 0, {0, 10}) * kDegree;
  TomlTable gondola = rig.table("gondola");
  s.pendulum_length_m = gondola.number("pendulum_length_m", s.pendulum_length_m, {0, 10});
  s.pendulum_damping = gondola.number("pendulum_damping", s.pendulum_damping, {0, 10});
  s.bearing_damping = gondola.number("bearing_damping", s.bearing_damping, {0, 10});
  s.forced_tilt_rad = gondola.number("forced_tilt_deg", 0, {0, 45}) * kDegree;
  s.forced_tilt_phase_rad = gondola.number("forced_tilt_phase_deg", 0, {-360, 360}) * kDegree;
  s.lever_arm_G_m = read_vector(gondola, "sensor_from_pivot_m", s.lever_arm_G_m, {-5, 5});
  return s;
}

motion::EnvelopeSettings read_envelope(TomlTable rig) {
  motion::EnvelopeSettings s;
  s.min_radius_m = rig.number("min_radius_m", s.min_radius_m, {0.001, 100});
  s.max_radius_m = rig.number("max_radius_m", s.max_radius_m, {s.min_radius_m, 100});
  s.max_centripetal_mps2 = rig.number("max_centripetal_mps2", s.max_centripetal_mps2, {0, 1000});
  s.breaking = rig.choice("breaking_waves", "warn", {"warn", "refuse"}) == "warn" ? motion::Verdict::kWarn
                                                                                  : motion::Verdict::kRefuse;
  TomlTable axis = rig.table("axis");
  s.limits.rate_radps = axis.number("max_rate_radps", s.limits.rate_radps, {0.01, 1000});
  s.limits.accel_radps2 = axis.number("max_accel_radps2", s.limits.accel_radps2, {0.01, 10000});
  s.limits.jerk_radps3 = axis.number("max_jerk_radps3", s.limits.jerk_radps3, {0.01, 100000});
  return s;
}

SensorChoice read_sensor(TomlTable sensor) {
  SensorChoice s;
  s.accelerometer = sensor.choice("accelerometer", s.accelerometer, {"MMA7331LC"});
  s.gyroscope = sensor.choice("gyroscope", s.gyroscope, {"FXAS21000"});
  s.gyroscope_range_degps = sensor.number("gyroscope_range_degps", s.gyroscope_range_degps, {200, 1600});
  s.magnetometer = sensor.choice("magnetometer", s.magnetometer, {"none", "MAG3110", "HMC5883L"});
  if (sensor.has("board_iron_uT")) s.board_iron_uT = sensor.number("board_iron_uT", std::nullopt, {0, 1000});
  s.aged = sensor.boolean("aged", s.aged);
  return s;
}

// A calibration file of waverig bench: beside the campaign, or where the program was started.
std::optional<FrontEndChoice> read_front_end(TomlTable& calibration) {
  if (!calibration.has("front_end")) return std::nullopt;
  const std::string file = calibration.text("front_end", {}), place = calibration.place_of("front_end");
  const std::filesystem::path beside =
      std::filesystem::path(place.substr(0, place.rfind(':'))).parent_path() / file;
  FrontEndChoice choice;
  choice.calibration = estimator::load_front_end_calibration(
      std::filesystem::exists(beside) ? beside : std::filesystem::path(file));
  const std::vector<std::string> channels = calibration.texts(
      "front_end_channels", std::vector<std::string>(choice.channels.begin(), choice.channels.end()));
  if (channels.size() != choice.channels.size())
    calibration.refuse("front_end_channels", "three channels, of x, y and z");
  std::string known;
  for (const estimator::FrontEndChannel& c : choice.calibration.channels)
    known += (known.empty() ? "" : ", ") + c.name;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    if (std::ranges::find(choice.calibration.channels, channels[i], &estimator::FrontEndChannel::name) ==
        choice.calibration.channels.end())
      calibration.refuse("front_end_channels", "channels among " + known);
    choice.channels[i] = channels[i];
  }
  calibration.say("front_end", kFrontEndFile);
  return choice;
}

CalibrationRunSettings read_calibration(TomlTable& calibration, bool& enabled) {
  CalibrationRunSettings s;
  enabled = calibration.boolean("enabled", true);
  s.settle_s = calibration.number("settle_s", s.settle_s, {0, 600});
  s.record_s = calibration.number("seconds_per_position", s.record_s, {2 * s.batch_s, 3600});
  s.fixture_sigma_rad =
      calibration.number("fixture_sigma_deg", s.fixture_sigma_rad / kDegree, {0, 5}) * kDegree;
  s.front_end = read_front_end(calibration);
  return s;
}

}  // namespace

motion::ProfileSettings SweepSettings::profile_of(const Setting& setting) const {
  motion::ProfileSettings p = profile;
  p.period_s = setting.period_s;
  p.steady_s = std::max(p.steady_s, min_waves * setting.period_s);
  return p;
}

Campaign read_campaign(const std::filesystem::path& file, const std::uint64_t* seed_override) {
  if (file.empty()) return read_campaign(TomlFile(kDefaultCampaignText, "default campaign"), seed_override);
  return read_campaign(TomlFile(file), seed_override);
}

Campaign read_campaign(TomlFile file, const std::uint64_t* seed_override) {
  if (seed_override != nullptr) file.set("seed", static_cast<std::int64_t>(*seed_override));
  CampaignSettings s;
  TomlTable& root = file.root();
  s.name = root.text("name", std::nullopt);
  s.seed = static_cast<std::uint64_t>(root.integer("seed", 1, {0, 9.2e18}));
  s.methods = root.texts("methods", std::vector<std::string>{"lee2014", "harmonic"});
  for (const std::string& method : s.methods) {
    const auto known = estimator::method_names();
    if (std::find(known.begin(), known.end(), method) == known.end())
      root.refuse("methods", fmt::format("names among \"{}\"", fmt::join(known, "\", \"")));
  }
  if (std::set(s.methods.begin(), s.methods.end()).size() < s.methods.size())
    root.refuse("methods", "each name once");
  s.sweep = read_sweep(root.table("sweep"));
  if (s.sweep.mover == Mover::kSea) read_sea(root.table("sea"), s.sweep);
  TomlTable place = root.table("place");
  s.place = read_place(place, {36.37 * kDegree, 127.36 * kDegree, 70});
  TomlTable rig = root.table("rig");
  s.rig_place = s.place;
  if (rig.has("place")) {
    TomlTable really = rig.table("place");
    s.rig_place = read_place(really, s.place);
  }
  s.arm = read_arm(rig, gravity_mps2(s.rig_place));
  s.envelope = read_envelope(rig);
  s.sensor = read_sensor(root.table("sensor"));
  TomlTable calibration = root.table("calibration");
  s.calibration = read_calibration(calibration, s.calibrate);
  if (s.sensor.magnetometer != "none" || place.has("declination_deg") || rig.has("field") ||
      rig.has("motor") || calibration.has("compass")) {
    s.estimator.compass.declination_rad = place.number("declination_deg", 0, {-180, 180}) * kDegree;
    s.magnetic = read_magnetic(rig, s.estimator.compass.declination_rad);
    s.compass = read_compass(calibration, s.compass_run);
    s.compass_run.fixture_sigma_rad = s.calibration.fixture_sigma_rad;
  }
  s.axis.limits = s.envelope.limits;
  s.start_utime = root.integer("start_utime", kVirtualStart_utime, {0, 9e15});
  root.refuse_unknown_keys();
  s.estimator.sensor.gravity_mps2 = gravity_mps2(s.place);
  return {s, file.resolved()};
}

}  // namespace waverig::rig
