#include "rig/bench/history.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <tuple>

#include "lcmtypes/error.h"

namespace waverig::rig::bench {
namespace {

using estimator::FrontEndCalibration;
using estimator::FrontEndChannel;
using estimator::TemperatureLaw;

constexpr double kStep_degC = 2.5;
constexpr std::array kOfAChannel = {Coefficient::kScaleN, Coefficient::kScaleP, Coefficient::kBias};

const TemperatureLaw& law_of(const FrontEndCalibration& calibration, const FrontEndChannel& channel,
                             Coefficient quantity) {
  switch (quantity) {
    case Coefficient::kScaleN:
      return channel.dsf_N;
    case Coefficient::kScaleP:
      return channel.dsf_P;
    case Coefficient::kBias:
      return channel.bias_A;
    case Coefficient::kOscillator:
      break;
  }
  return calibration.oscillator;
}

// Of the reference itself, as the budgets name it.
double reference_sigma(const FrontEndCalibration& calibration, const FrontEndChannel& channel,
                       Coefficient quantity) {
  const std::vector<estimator::BudgetTerm>* budget = nullptr;
  if (quantity == Coefficient::kScaleN) budget = &channel.dsf_N_budget;
  if (quantity == Coefficient::kScaleP) budget = &channel.dsf_P_budget;
  if (quantity == Coefficient::kOscillator) budget = &calibration.oscillator_budget;
  if (budget == nullptr) return 0;
  for (const estimator::BudgetTerm& t : *budget)
    if (t.name == "calibrator" || t.name == "DMM" || t.name == "reference frequency") return t.sigma;
  return 0;
}

// Throws nothing; false where the two share no temperature.
bool largest_drift(const FrontEndCalibration& a, const FrontEndChannel& a_channel,
                   const FrontEndCalibration& b, const FrontEndChannel& b_channel, Coefficient quantity,
                   bool reference_common, Drift& worst) {
  const TemperatureLaw &a_law = law_of(a, a_channel, quantity), &b_law = law_of(b, b_channel, quantity);
  const double from = std::max(a_law.from_degC, b_law.from_degC), to = std::min(a_law.to_degC, b_law.to_degC);
  if (from > to) return false;
  const int steps = std::max(1, static_cast<int>((to - from) / kStep_degC));
  for (int i = 0; i <= steps; ++i) {
    const double T = std::lerp(from, to, static_cast<double>(i) / steps);
    const Told before = told(a, a_channel, quantity, T, reference_common),
               after = told(b, b_channel, quantity, T, reference_common);
    const Drift here{quantity == Coefficient::kOscillator ? "" : a_channel.name, quantity, T,
                     after.value - before.value, std::hypot(before.expanded, after.expanded)};
    if (i == 0 || std::abs(here.score()) > std::abs(worst.score())) worst = here;
  }
  return true;
}

}  // namespace

const char* name_of(Coefficient quantity) {
  switch (quantity) {
    case Coefficient::kScaleN:
      return "scale factor N";
    case Coefficient::kScaleP:
      return "scale factor P";
    case Coefficient::kBias:
      return "bias";
    case Coefficient::kOscillator:
      return "master oscillator";
  }
  return "";
}

const char* base_of(Coefficient quantity) { return quantity == Coefficient::kBias ? "A" : "1"; }

bool measured(const FrontEndCalibration& calibration, const FrontEndChannel& channel, Coefficient quantity) {
  return law_of(calibration, channel, quantity).covariance(0, 0) > 0;
}

Told told(const FrontEndCalibration& calibration, const FrontEndChannel& channel, Coefficient quantity,
          double temperature_degC, bool reference_common) {
  const TemperatureLaw& law = law_of(calibration, channel, quantity);
  if (quantity == Coefficient::kBias)
    return {law.at(temperature_degC), channel.bias_expanded_A(temperature_degC)};
  double variance = std::pow(law.sigma_at(temperature_degC), 2);
  if (reference_common) {
    // What is left is at least a tenth: a difference of large numbers is not believed further.
    const double reference = reference_sigma(calibration, channel, quantity);
    variance = std::max(0.01 * variance, variance - reference * reference);
  }
  return {law.at(temperature_degC), 2 * std::sqrt(variance)};
}

std::vector<Drift> compare(const FrontEndCalibration& earlier, const FrontEndCalibration& later,
                           bool reference_common) {
  if (earlier.unit != later.unit)
    throw UserError(fmt::format("{} is of {}, {} of {}: expected calibrations of one unit", earlier.id,
                                earlier.unit, later.id, later.unit));
  std::vector<Drift> drifts;
  Drift drift;
  for (const FrontEndChannel& a : earlier.channels) {
    const auto b = std::ranges::find(later.channels, a.name, &FrontEndChannel::name);
    if (b == later.channels.end()) continue;
    if (a.K_N0_C != b->K_N0_C || a.K_P0_C != b->K_P0_C)
      throw UserError(fmt::format("{} and {}: {}: expected the same scale factors by design", earlier.id,
                                  later.id, a.name));
    for (const Coefficient q : kOfAChannel)
      if (measured(earlier, a, q) && measured(later, *b, q) &&
          largest_drift(earlier, a, later, *b, q, reference_common, drift))
        drifts.push_back(drift);
  }
  const FrontEndChannel none;
  if (measured(earlier, none, Coefficient::kOscillator) && measured(later, none, Coefficient::kOscillator) &&
      largest_drift(earlier, none, later, none, Coefficient::kOscillator, reference_common, drift))
    drifts.push_back(drift);
  if (drifts.empty())
    throw UserError(fmt::format(
        "{} ({}) and {} ({}): expected something that both measured, at temperatures that both cover",
        earlier.id, earlier.procedure, later.id, later.procedure));
  return drifts;
}

std::filesystem::path History::file_of(const std::string& id) const {
  std::string name = id;
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-' && c != '_' && c != '+') c = '_';
  return directory_ / (name + ".json");
}

std::string History::keep(FrontEndCalibration calibration) const {
  std::error_code error;
  std::filesystem::create_directories(directory_, error);
  if (error)
    throw UserError(
        fmt::format("{}: {}: expected a directory for the history", directory_.string(), error.message()));
  const std::string id = calibration.id;
  for (int number = 2; std::filesystem::exists(file_of(calibration.id)); ++number) {
    if (to_json(estimator::load_front_end_calibration(file_of(calibration.id))) == to_json(calibration))
      return calibration.id;
    calibration.id = fmt::format("{}-{}", id, number);
  }
  save(calibration, file_of(calibration.id));
  return calibration.id;
}

std::vector<FrontEndCalibration> History::all() const {
  std::vector<FrontEndCalibration> list;
  if (!std::filesystem::is_directory(directory_))
    throw UserError(directory_.string() + ": no such directory: expected a history of calibrations");
  for (const auto& entry : std::filesystem::directory_iterator(directory_))
    if (entry.path().extension() == ".json")
      list.push_back(estimator::load_front_end_calibration(entry.path()));
  std::ranges::sort(list, {}, [](const FrontEndCalibration& c) { return std::tuple(c.measured, c.id); });
  return list;
}

FrontEndCalibration History::find(const std::string& id_or_file) const {
  if (std::filesystem::is_regular_file(file_of(id_or_file)))
    return estimator::load_front_end_calibration(file_of(id_or_file));
  if (std::filesystem::is_regular_file(id_or_file)) return estimator::load_front_end_calibration(id_or_file);
  std::string known;
  for (const FrontEndCalibration& c : all()) known += (known.empty() ? "" : ", ") + c.id;
  throw UserError(fmt::format("{}: expected a calibration file, or one of {}", id_or_file,
                              known.empty() ? "a history that is not empty" : known));
}

}  // namespace waverig::rig::bench
