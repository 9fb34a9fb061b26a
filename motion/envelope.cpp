#include "motion/envelope.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "motion/kinematics/frames.h"

namespace waverig::motion {

using std::numbers::pi;

std::string_view name_of(EnvelopeReason reason) {
  switch (reason) {
    case EnvelopeReason::kBeyondRig:
      return "beyond the rig";
    case EnvelopeReason::kBreaks:
      return "breaks";
    case EnvelopeReason::kClips:
      return "clips";
    case EnvelopeReason::kBelowNoise:
      break;
  }
  return "below noise";
}

double deep_water_length_m(double period_s) { return kStandardGravity * period_s * period_s / (2 * pi); }

double peak_acceleration_mps2(double period_s, double height_m) {
  const double w = 2 * pi / period_s;
  return 0.5 * w * w * height_m;
}

double height_sigma_bound_m(double period_s, double noise_mps2_sqrtHz) {
  const double w = 2 * pi / period_s;
  return 2 / (w * w) * noise_mps2_sqrtHz / std::sqrt(period_s);
}

std::vector<Judgement> judge(double period_s, double height_m, int ramp_periods, const EnvelopeSettings& s) {
  std::vector<Judgement> judgements;
  const auto say = [&](EnvelopeReason reason, Verdict verdict, const std::string& what) {
    judgements.push_back(
        {reason, verdict, fmt::format("{} s, {} m: {}: {}", period_s, height_m, name_of(reason), what)});
  };
  if (!(std::isfinite(period_s) && period_s > 0 && std::isfinite(height_m) && height_m > 0)) {
    say(EnvelopeReason::kBeyondRig, Verdict::kRefuse, "period and height must be positive");
    return judgements;
  }
  const double radius_m = 0.5 * height_m, peak_mps2 = peak_acceleration_mps2(period_s, height_m);

  if (radius_m < s.min_radius_m || radius_m > s.max_radius_m)
    say(EnvelopeReason::kBeyondRig, Verdict::kRefuse,
        fmt::format("the arm needs a radius of {:.4g} m and can be set from {:.4g} to {:.4g} m", radius_m,
                    s.min_radius_m, s.max_radius_m));
  const RotationProfile profile({.period_s = period_s, .steady_s = period_s, .ramp_periods = ramp_periods});
  if (const auto excess = exceeds(s.limits, profile))
    say(EnvelopeReason::kBeyondRig, Verdict::kRefuse, excess->sentence());
  if (s.max_centripetal_mps2 > 0 && peak_mps2 > s.max_centripetal_mps2)
    say(EnvelopeReason::kBeyondRig, Verdict::kRefuse,
        fmt::format("the gondola's acceleration of {:.4g} m/s^2 is more than the {:.4g} m/s^2 it bears",
                    peak_mps2, s.max_centripetal_mps2));

  const double length_m = deep_water_length_m(period_s);
  if (height_m > kBreakingSteepness * length_m)
    say(EnvelopeReason::kBreaks, s.breaking,
        fmt::format("H/L = {:.3f} is above 1/7 (deep water, L = {:.4g} m): no sea carries more than {:.4g} m",
                    height_m / length_m, length_m, kBreakingSteepness * length_m));

  if (s.sensor_range_mps2 > 0 && peak_mps2 + kStandardGravity > s.sensor_range_mps2)
    say(EnvelopeReason::kClips, Verdict::kRefuse,
        fmt::format("the sensor feels up to {:.3g} g and clips at {:.3g} g",
                    (peak_mps2 + kStandardGravity) / kStandardGravity,
                    s.sensor_range_mps2 / kStandardGravity));

  const double sigma_m = height_sigma_bound_m(period_s, s.noise_mps2_sqrtHz);
  if (sigma_m > s.noise_warn_fraction * height_m)
    say(EnvelopeReason::kBelowNoise,
        sigma_m > s.noise_refuse_fraction * height_m ? Verdict::kRefuse : Verdict::kWarn,
        fmt::format("sensor noise alone scatters a single wave's height by at least {:.2g} m, {:.0f} % of it",
                    sigma_m, 100 * sigma_m / height_m));
  if (peak_mps2 < s.drift_mps2)
    say(EnvelopeReason::kBelowNoise, Verdict::kWarn,
        fmt::format("the peak acceleration of {:.2g} mg is below the sensor's drift of {:.2g} mg",
                    1e3 * peak_mps2 / kStandardGravity, 1e3 * s.drift_mps2 / kStandardGravity));
  return judgements;
}

}  // namespace waverig::motion
