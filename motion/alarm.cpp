#include "motion/alarm.h"

namespace waverig::motion {

std::string_view text_of(Alarm alarm) {
  switch (alarm) {
    case Alarm::kNone:
      return "no alarm";
    case Alarm::kFollowingError:
      return "following error";
    case Alarm::kRateLimit:
      return "rate limit";
    case Alarm::kAccelLimit:
      return "acceleration limit";
    case Alarm::kJerkLimit:
      return "jerk limit";
    case Alarm::kDriveFault:
      return "drive fault";
    case Alarm::kDriveSilent:
      return "drive does not answer";
    case Alarm::kWrongEcho:
      return "late or foreign answer";
    case Alarm::kStaleFeedback:
      return "drive hangs";
    case Alarm::kDriveLeftOperation:
      return "drive left operation";
    case Alarm::kEnableTimeout:
      return "drive does not enable";
    case Alarm::kHomingFailed:
      return "homing failed";
    case Alarm::kDeadlineMissed:
      return "deadline missed";
    case Alarm::kEmergencyStop:
      break;
  }
  return "emergency stop";
}

}  // namespace waverig::motion
