// Runs a method of the installed library over a unit at rest.
#include <cstdio>

#include "estimator/evaluation/zero_crossing.h"
#include "estimator/method.h"

using namespace waverig;

struct Last : estimator::Output {
  void heave(const estimator::HeaveSample& sample) override { heave_m = sample.heave_m; }
  double heave_m = 1;
};

int main() {
  const auto method = estimator::make_method("realtime", {});
  Last last;
  for (int i = 0; i < 6000; ++i) {
    estimator::ImuSample sample;
    sample.utime = i * 10'000;
    sample.seq = i;
    sample.f_B = {0, 1e-3 * (i % 2), -kStandardGravity};
    method->add(sample, last);
  }
  std::printf("%.3f\n", last.heave_m);
  return last.heave_m > -0.1 && last.heave_m < 0.1 ? 0 : 1;
}
