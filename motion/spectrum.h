// Wave spectra: variance density of the sea surface over frequency, and what their moments say.
#pragma once
#include <optional>
#include <string>

namespace waverig::motion {

enum class SpectrumShape { kJonswap, kPiersonMoskowitz };

// One-sided variance density in m^2/Hz.
class WaveSpectrum {
 public:
  // Hasselmann et al. 1973 (JONSWAP; gamma is not used for Pierson-Moskowitz), scaled so that 4 sqrt(m0) =
  // hm0_m. Throws UserError where hm0_m or tp_s is not positive or gamma is below 1.
  WaveSpectrum(SpectrumShape shape, double hm0_m, double tp_s, double gamma);

  double density(double f_Hz) const { return scale_ * shape(f_Hz); }
  double variance_between(double f0_Hz, double f1_Hz) const;  // integral of the density, m^2
  double peak_Hz() const { return fp_Hz_; }

 private:
  double shape(double f_Hz) const;
  double fp_Hz_, gamma_, scale_ = 1;
};

// Moments m_n = integral of f^n S(f) df, in m^2 Hz^n, and the usual parameters.
struct SeaMoments {
  double m_minus1 = 0, m0 = 0, m1 = 0, m2 = 0, m4 = 0;
  double mean_direction_from_rad = 0;  // true, in [0, 2 pi); energy-weighted
  double spread_rad = 0;               // circular standard deviation sqrt(2 (1 - r1)), Kuik et al. 1988

  double hm0_m() const;
  double tm01_s() const;   // m0 / m1
  double tm02_s() const;   // sqrt(m0 / m2)
  double tm_10_s() const;  // m-1 / m0
};

// DNV-RP-C205, section 3.5.4: the steepest seas have 2 pi Hs / (g Tp^2) = 1/15 up to Tp = 8 s, falling
// linearly to 1/25 at 15 s and beyond.
double significant_steepness(double tp_s, double hm0_m);
double largest_hm0_m(double tp_s);
// Nothing where the sea can be; else a sentence with the numbers.
std::optional<std::string> too_steep(double tp_s, double hm0_m);

}  // namespace waverig::motion
