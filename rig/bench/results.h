// What a bench leaves beside its store for people and for other programs: the calibration file, a row a
// channel (CSV), a row a step (CSV), and the limits as JUnit XML.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "rig/bench/analysis.h"

namespace waverig::rig::bench {

// A channel's result held against the unit's specification (laboratory file: scale_limit, bias_limit); scale
// factors a tenth or more off those of the laboratory file too.
struct Verdict {
  std::string channel, quantity;  // "scale factor", "bias", "off its design"
  double value = 0, limit = 0;  // the largest expanded uncertainty (k = 2) over the calibrated temperatures,
                                // or the largest deviation from the design
  std::string base;             // SI unit of both
  bool passed() const { return value <= limit; }
};
std::string shown(double value, const std::string& base);  // relative ("1") in ppm, currents ("A") in nA
std::vector<Verdict> hold_against_limits(const Sequence& sequence, const Analysis& analysis);
std::string table_of(const std::vector<Verdict>& verdicts);  // as the terminal shows it

// Largest over the temperatures that were calibrated, k = 2.
double scale_expanded(const estimator::FrontEndChannel& channel);    // relative, of the worse reset current
double scale_off_design(const estimator::FrontEndChannel& channel);  // largest too, of both reset currents
double bias_expanded_A(const estimator::FrontEndChannel& channel);

std::string channels_csv(const Analysis& analysis);
std::string steps_csv(const Store& store);
// One test case a channel's limit, one a step that was held against limits or failed.
std::string junit_xml(const Sequence& sequence, const Store& store, const std::vector<Verdict>& verdicts);

}  // namespace waverig::rig::bench
