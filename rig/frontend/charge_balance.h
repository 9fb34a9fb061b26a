// ChargeBalanceConverter: one channel of the current-to-frequency converter, Kim eqs. (1), (2).
//
// An integrator takes the sensor's current; each tick that finds it beyond a quantum takes one quantum of
// charge out, by the negative reset current where it is positive and by the positive one where it is
// negative:
//   i_SEN = K_N C_N - K_P C_P + i_AFbias,  C = (N / t_INT0) (1 + df_MSTR) / (1 + df_AF).
// The remainder stays on the integrator, less than one quantum of either sign: no charge is lost between
// samples.
#pragma once
#include <cmath>
#include <cstdint>

namespace waverig::rig {

struct ConverterChannelSettings {
  double positive_quantum_C = 0;    // K_PPP0, nominal
  double negative_quantum_C = 0;    // K_NPP0
  double positive_scale_error = 0;  // DSF_PPP, relative
  double negative_scale_error = 0;  // DSF_NPP
  double bias_A = 0;                // i_AFbias
  double reset_clock_error = 0;     // df_AF, relative: a faster clock makes smaller quanta
  double largest_rate_Hz = 0;       // of either counter; 0: no limit
};

struct ConverterCounts {
  std::int32_t positive = 0, negative = 0;
  bool overloaded = false;  // the reset current could not keep up
};

class ChargeBalanceConverter {
 public:
  explicit ChargeBalanceConverter(const ConverterChannelSettings& s)
      : positive_C_(s.positive_quantum_C * (1 + s.positive_scale_error) / (1 + s.reset_clock_error)),
        negative_C_(s.negative_quantum_C * (1 + s.negative_scale_error) / (1 + s.reset_clock_error)),
        bias_A_(s.bias_A),
        largest_rate_Hz_(s.largest_rate_Hz) {}

  // charge_C: of the sensor's current over dt_s.
  void integrate(double charge_C, double dt_s) {
    charge_C_ += charge_C - bias_A_ * dt_s;
    open_s_ += dt_s;
  }

  // The counts since the last call.
  ConverterCounts take() {
    ConverterCounts counts;
    const double limit = largest_rate_Hz_ > 0 ? largest_rate_Hz_ * open_s_ : 2.0e9;
    double n = charge_C_ >= 0 ? std::floor(charge_C_ / negative_C_) : std::ceil(charge_C_ / positive_C_);
    counts.overloaded = std::abs(n) > limit;
    if (counts.overloaded) n = std::copysign(std::floor(limit), n);
    charge_C_ -= n * (n > 0 ? negative_C_ : positive_C_);
    if (counts.overloaded)
      charge_C_ = std::fmod(charge_C_, n > 0 ? negative_C_ : positive_C_);  // it stands at its rail
    (n > 0 ? counts.negative : counts.positive) = static_cast<std::int32_t>(std::abs(n));
    open_s_ = 0;
    return counts;
  }

  double remainder_C() const { return charge_C_; }

 private:
  double positive_C_, negative_C_, bias_A_, largest_rate_Hz_;
  double charge_C_ = 0, open_s_ = 0;
};

}  // namespace waverig::rig
