#include "rig/campaign/reestimate.h"

namespace waverig::rig {
namespace {

class Collector : public estimator::Output {
 public:
  explicit Collector(Reestimated& into) : into_(into) {}
  void heave(const estimator::HeaveSample& sample) override { into_.heave.push_back(sample); }
  void wave(const estimator::Wave& wave) override { into_.waves.push_back(wave); }

 private:
  Reestimated& into_;
};

UnitCounts counts_of(const evaluation::RawSample& raw) {
  return {raw.utime, raw.seq, raw.accel_positive, raw.accel_negative,
          raw.gyro,  raw.mag, raw.temperature,    raw.flags};
}

}  // namespace

Reestimated estimate_uncalibrated(const evaluation::RunRecord& run, const CampaignUnit& unit,
                                  const std::string& method) {
  Reestimated result;
  Collector collector(result);
  Acquisition acquisition(unit.sensitivities);
  const auto estimate = estimator::make_method(method, unit.methods);
  for (const evaluation::RawSample& raw : run.raw) {
    if (raw.utime < run.start_utime) continue;  // before the record
    result.imu.push_back(acquisition.sample_of(counts_of(raw)));
    estimate->add(result.imu.back(), collector);
  }
  estimate->finish(collector);
  return result;
}

}  // namespace waverig::rig
