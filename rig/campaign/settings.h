// A campaign: what shall be set, on which rig, with which sensor, told by which methods. SI here; in the TOML
// file every key that has a unit carries it in its name.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "estimator/method.h"
#include "motion/axis_controller.h"
#include "motion/envelope.h"
#include "motion/kinematics/earth.h"
#include "motion/profile.h"
#include "motion/sea_state.h"
#include "motion/simulated_drive.h"
#include "rig/acquisition/calibration_run.h"
#include "rig/acquisition/compass_run.h"
#include "rig/mechanism/rotating_arm.h"
#include "rig/settings/toml_reader.h"

namespace waverig::rig {

struct Setting {
  double period_s = 0;
  double height_m = 0;
};

enum class Mover { kArm, kSea };  // the rotating arm, or a buoy on an irregular sea

enum class OutsideEnvelope { kRefuse, kSkip };  // what happens to settings that cannot be made or measured

struct SweepSettings {
  Mover mover = Mover::kArm;
  std::vector<Setting> settings;  // by period, then height; on a sea peak period and Hm0
  std::string settings_place;     // FILE:LINE of the heights, for complaints
  int repeats = 1;
  double turn_per_repeat_rad = 0;   // of the pedestal between repeats
  motion::ProfileSettings profile;  // of every run on the arm; the period is the setting's
  int min_waves = 0;                // of a steady part: longer than the profile's where that holds fewer
  motion::SeaSettings sea;          // of every run on a sea; Tp, Hm0 and seed are the run's
  motion::FloatSettings buoy;
  OutsideEnvelope outside = OutsideEnvelope::kRefuse;

  // Of a run of that setting; steady_s is a sea's whole record.
  motion::ProfileSettings profile_of(const Setting& setting) const;
};

struct SensorChoice {
  std::string accelerometer = "MMA7331LC";
  std::string gyroscope = "FXAS21000";
  double gyroscope_range_degps = 200;
  std::string magnetometer = "none";
  std::optional<double> board_iron_uT;  // hard iron per axis, standard deviation; else the part's own
  bool aged = false;                    // since its calibration: HARDWARE drift added after it
};

// What a compass on the rig has to do with. Read where there is a magnetometer, and nowhere else.
struct MagneticSettings {
  EarthFieldSettings field;                         // where the rig stands; declination included
  double motor_distance_m = 0.3;                    // from the arm's plane, along the axis
  Vector3d stator_moment_P_Am2 = Vector3d::Zero();  // P: pedestal, x along the azimuth, z down
  Vector3d rotor_moment_Am2 = Vector3d::Zero();     // turns with the arm, as MotorFieldSettings has it
};

enum class CompassMethod { kNone, kMaxMin, kEllipsoid };

struct CampaignSettings {
  std::string name;
  std::uint64_t seed = 1;
  std::vector<std::string> methods;
  SweepSettings sweep;
  Place place;      // as the laboratory has it: calibration and methods
  Place rig_place;  // where the simulated rig stands, other where the laboratory errs
  MagneticSettings magnetic;
  RotatingArmSettings arm;
  motion::EnvelopeSettings envelope;  // of the rig; the sensor's part is filled in from the sensor
  SensorChoice sensor;
  bool calibrate = true;                         // six positions at the start
  CalibrationRunSettings calibration;            // with the front end's own, where the campaign names one
  CompassMethod compass = CompassMethod::kNone;  // which of the two calibrations is applied
  CompassRunSettings compass_run;
  motion::AxisSettings axis;
  motion::SimulatedDriveSettings drive;
  estimator::MethodSettings estimator;
  std::int64_t start_utime = 0;  // of the first run, virtual time
};

// Where a results directory keeps the front end's calibration, beside the resolved settings, which name it
// there.
inline constexpr const char* kFrontEndFile = "front_end.json";

struct Campaign {
  CampaignSettings settings;
  std::string resolved;  // TOML with every value, defaults included
};

// Reads and checks a campaign. seed_override replaces the file's seed. Throws UserError.
// An empty path: the default campaign, which the program carries in itself.
Campaign read_campaign(const std::filesystem::path& file, const std::uint64_t* seed_override = nullptr);
Campaign read_campaign(TomlFile file, const std::uint64_t* seed_override = nullptr);

}  // namespace waverig::rig
