#include "estimator/evaluation/flag_names.h"

#include <utility>

#include "lcmtypes/flags.h"

namespace waverig::evaluation {
namespace {

constexpr std::pair<std::int32_t, const char*> kNames[] = {
    {flag::kGap, "gap"},
    {flag::kSpike, "spike"},
    {flag::kRange, "range"},
    {flag::kFlatLine, "flat_line"},
    {flag::kSaturation, "saturation"},
    {flag::kTooFewWaves, "too_few_waves"},
    {flag::kBelowNoise, "below_noise"},
    {flag::kNoMagnetometer, "no_magnetometer"},
    {flag::kUncalibrated, "uncalibrated"},
    {flag::kSettling, "settling"},
    {flag::kIncomplete, "incomplete"},
};

}  // namespace

std::vector<std::string> flag_names(std::int32_t flags) {
  std::vector<std::string> names;
  for (const auto& [bit, name] : kNames)
    if ((flags & bit) != 0) names.emplace_back(name);
  return names;
}

}  // namespace waverig::evaluation
